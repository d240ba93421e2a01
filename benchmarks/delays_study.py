"""`make study`: signals that are late, and signals that are not.

Each recording has one signal late by 1 to 3 ms, or none; half of them are taken every millisecond, half every
second one. Others have a model error that could pass for a delay.
"""

from __future__ import annotations

import argparse
import sys
import time
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from conditions import DURATION, LUGRE, POSE, Condition
from delay_limit import NORMAL, Limit, limit
from delay_limit import late as late_signal
from measured import Part, publish
from plants import Bench, simulate

import jointid as jid

NEAR = 3e-4  # [s] from the true delay
CLOSE = 0.015  # of the true value, with the delay taken away
LATE = Part(
    title="Delays",
    asked="Is a torque, velocity or sensor reading that is 1 to 3 ms late found? Random joints, four motions, 12 s, "
    "sensor noise 0.2 N·m.",
    header=(
        "late signal",
        "runs",
        "named within 0.3 ms",
        "named, further off",
        "median error [ms]",
        "in its 95 % interval",
        "others called late",
        "all parameters within 1.5 %; nothing late",
    ),
    reading="The last column compares the values with the delay removed to those before the signal was made late.",
)
PROMPT = Part(
    title="Delays: nothing is late",
    asked="Is a signal called late that is not?",
    header=("recording", "runs", "called late"),
)
SILENT = Part(
    title="Delays: a reading that is not fed back",
    asked="How near does the estimate come to what the recording can tell, where no controller feeds the sensor's "
    "noise back? The least standard error is the Cramér-Rao bound of each run (`benchmarks/delay_limit.py`).",
    header=(
        "rate",
        "runs",
        "least standard error [ms]: median, 90 %",
        "determinable to 0.3 ms",
        "named within",
        "of the others",
        "error / least error, median",
        "in its 95 % interval",
    ),
    reading="An efficient estimate has a median ratio of 0.67.",
)
_ROUNDED = 1e-5  # [s]; of a delay that nothing but rounding makes uncertain
_MOTIONS = ("thesis", "sines", "trapezoids", "chirp")
_MISMATCHES: Mapping[str, Mapping[str, Any]] = {
    "viscous drift -30 %": {"plant": {"viscous_drift": -0.3}},
    "presliding": {"plant": LUGRE},
    "asymmetry 20 %": {"plant": {"asymmetry": 0.2}},
    "Stribeck exponent 1": {"plant": {"exponent": 1.0}},
    "inertia varies": {"plant": POSE},
    "0.3 N·m of sin 3q": {"plant": {"harmonic_torque": 0.3}},
    "load friction 0.03": {"plant": {"load_friction": 0.03}},
    "torque constant 10 % off": {"plant": {"torque_scale": 1.1}},
}


@dataclass(frozen=True, kw_only=True)
class Case:
    """Recordings with one signal late, or with none.

    Attributes
    ----------
    title : str
    signal : str
        That is late; empty: none.
    condition : Condition
    """

    title: str
    signal: str
    condition: Condition

    @property
    def silent(self) -> bool:
        """Whether the motion alone tells the sensor's delay."""
        return self.signal == "sensor" and self.condition.law.get("feedback") == 0.0


def cases() -> list[Case]:
    """Every kind of recording, in the order of the tables."""
    found = []
    for every in (1, 2):
        for motion in _MOTIONS:
            common: dict[str, Any] = {"every": every, "motion": motion, "name": motion}
            rate = f"{1000 // every} Hz"
            for signal in ("torque", "velocity", "sensor"):
                found.append(
                    Case(title=f"{signal}, {rate}", signal=signal, condition=Condition(**common))
                )
                if signal == "sensor":
                    silent = Condition(law={"feedback": 0.0}, **common)
                    title = f"sensor, {rate}, its reading is not fed back"
                    found.append(Case(title=title, signal=signal, condition=silent))
            found.append(Case(title=f"clean, {rate}", signal="", condition=Condition(**common)))
            for name, fields in _MISMATCHES.items():
                found.append(Case(title=name, signal="", condition=Condition(**common, **fields)))
    return found


def late(recording: jid.Recording, signal: str, delay: float) -> jid.Recording:
    """The recording with a signal that is late; between samples it is interpolated."""
    signals = {name: getattr(recording, name) for name in recording.signals}
    signals[signal] = late_signal(recording, signal, delay)
    return jid.Recording(
        **signals,
        torque_hold=recording.torque_hold,
        metadata=recording.metadata,
        truth=recording.truth,
    )


@dataclass(frozen=True, kw_only=True)
class Outcome:
    """What became of one recording.

    Attributes
    ----------
    error : float
        Of the delay that is certain [s]; infinite where none is.
    stated : float
        Its standard error [s].
    false : frozenset of str
        Other signals that are called late.
    worst : float
        Largest relative error of a parameter, the offset's relative to the Coulomb friction.
    before : float
        The same of the recording before its signal was made late.
    limit : Limit or None
        How well the recording can tell the delay at all; known where the reading is not fed back.
    apart : float
        Error over its standard error of a delay that was measured, certain or not; NaN of one that was not.
    """

    error: float
    stated: float
    false: frozenset[str]
    worst: float
    before: float = 0.0
    limit: Limit | None = None
    apart: float = np.nan


def outcome(
    case: Case, recording: jid.Recording, delay: float, quiet: jid.Recording | None = None
) -> Outcome:
    """Identify one recording with its signal late; `quiet` is the same without noise of the sensor."""
    before = 0.0
    if case.signal:
        nothing_late = Case(title=case.title, signal="", condition=case.condition)
        before = outcome(nothing_late, recording, 0.0).worst
        recording = late(recording, case.signal, delay)
    estimate = jid.identify(recording, case.condition.joint(recording), search="separable")
    certain = {name: each for name, each in estimate.delays.items() if each.certain}
    found = certain.pop(case.signal, None)
    measured = estimate.delays.get(case.signal)
    truth = dict(recording.truth or {})
    worst = 0.0
    for name, parameter in estimate.parameters.items():
        if name in truth and parameter.vary:
            scale = truth["coulomb"] if name == "sensor_offset" else truth[name]
            worst = max(worst, abs(parameter.value - truth[name]) / max(abs(scale), 1e-300))
    return Outcome(
        error=np.inf if found is None else abs(found.value - delay),
        stated=0.0 if found is None else found.stderr,
        false=frozenset(certain),
        worst=worst,
        before=before,
        limit=None
        if quiet is None
        else limit(quiet, recording.metadata["log"]["sensor_noise"], delay),
        apart=np.nan
        if measured is None
        else (measured.value - delay) / np.hypot(measured.stderr, _ROUNDED),
    )


Found = Mapping[str, tuple[Case, Sequence[Outcome]]]


def outcomes(runs: int, seed: int, only: str = "") -> Found:
    """Of all recordings, by the title of their case."""
    drawn = np.random.default_rng([seed, 1])
    each: list[tuple[Case, Bench]] = []
    for case in cases():
        if only not in case.title:
            continue
        mismatch = case.title in _MISMATCHES
        count = max(1, runs // 4) if mismatch else runs
        each.append((case, case.condition.bench(count, drawn)))
    found: dict[str, tuple[Case, list[Outcome]]] = {}
    while each:
        together = [each.pop(0)]
        while each and sum(bench.runs for _, bench in [*together, each[0]]) <= 240:
            together.append(each.pop(0))
        number = seed * 1000 + len(each)
        recordings = iter(
            simulate(Bench.stack([b for _, b in together]), duration=DURATION, seed=number)
        )
        for case, bench in together:
            noiseless = _quiet(bench, number) if case.silent else [None] * bench.runs
            for quiet in noiseless:
                delay = float(drawn.uniform(1e-3, 3e-3))
                one = outcome(case, next(recordings), delay, quiet)
                found.setdefault(case.title, (case, []))[1].append(one)
    return found


def _quiet(bench: Bench, seed: int) -> list[jid.Recording | None]:
    """What the sensors would read without noise: nothing feeds it back, so the motion is the same."""
    log = replace(bench.log, sensor_noise=0.0)
    return list(simulate(replace(bench, log=log), duration=DURATION, seed=seed))


def late_rows(found: Found) -> Iterator[list[object]]:
    """A line a late signal."""
    for title, (case, runs) in found.items():
        if case.signal:
            named = [each for each in runs if np.isfinite(each.error)]
            errors = np.array([each.error for each in named])
            inside = sum(each.error < NORMAL * each.stated + 2e-5 for each in named)
            yield [
                title,
                len(runs),
                np.count_nonzero(errors < NEAR),
                np.count_nonzero(errors >= NEAR),
                f"{1e3 * np.median(errors) if len(errors) else np.nan:.2f}",
                f"{inside}/{len(named)}",
                sum(bool(each.false) for each in runs),
                f"{sum(each.worst <= CLOSE for each in runs)}; "
                f"{sum(each.before <= CLOSE for each in runs)}",
            ]


def prompt_rows(found: Found) -> Iterator[list[object]]:
    """A line a recording in which nothing is late."""
    for title, (case, runs) in found.items():
        if not case.signal:
            false = [name for each in runs for name in sorted(each.false)]
            said = ", ".join(f"{name} {false.count(name)}" for name in sorted(set(false))) or "none"
            yield [title, len(runs), said]


def silent_rows(found: Found) -> Iterator[list[object]]:
    """How near the delays of readings that are not fed back come to what the recordings can tell."""
    for title, (case, runs) in found.items():
        if not case.silent:
            continue
        least = np.array([each.limit.error for each in runs if each.limit])
        can = [bool(each.limit and each.limit.determinable(NEAR)) for each in runs]
        near = [each.error < NEAR for each in runs]
        both = sum(one and other for one, other in zip(can, near, strict=True))
        measured = [abs(each.apart) < NORMAL for each in runs if np.isfinite(each.apart)]
        ratios = [e.error / e.limit.error for e in runs if np.isfinite(e.error) and e.limit]
        low, high = 1e3 * np.quantile(least, [0.5, 0.9])
        yield [
            title.split(", ")[1],
            len(runs),
            f"{low:.2f}, {high:.2f}",
            sum(can),
            both,
            f"{sum(near) - both}/{len(runs) - sum(can)}",
            f"{np.median(ratios):.2f}",
            f"{sum(measured)}/{len(measured)}",
        ]


def main() -> None:
    """Run the cases and publish the tables."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--runs", type=int, default=13, help="joints of each motion and rate")
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--only", default="", help="cases whose title contains this")
    parser.add_argument("--write", action="store_true", help="write them into the page, too")
    given = parser.parse_args()
    began = time.process_time()
    found = outcomes(given.runs, given.seed, given.only)
    for part, rows in ((LATE, late_rows), (PROMPT, prompt_rows), (SILENT, silent_rows)):
        publish(part, rows(found), write=given.write)
    total = sum(len(runs) for _, runs in found.values())
    print(f"{total} runs in {time.process_time() - began:.0f} s of CPU", file=sys.stderr)


if __name__ == "__main__":
    main()
