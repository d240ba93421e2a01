"""`make study`: recordings with a late signal, and recordings without.

In a recording, one signal is late by 1 to 3 ms, or none. Half of the recordings have a sample period of 1 ms, half of
2 ms. Some recordings have a model error that looks like a delay.
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

NEAR = 3e-4  # [s] largest distance from the true delay
CLOSE = 0.015  # largest relative error of a parameter after the delay is removed
LATE = Part(
    title="Delays",
    asked="Does `identify` find a torque, velocity or sensor reading that is 1 to 3 ms late? Random joints, four "
    "motions, 12 s, sensor noise 0.2 N·m.",
    header=(
        "late signal, sampling rate",
        "runs",
        "delay found, error below 0.3 ms",
        "delay found, larger error",
        "median error of the found delay [ms]",
        "95 % intervals that contain the true delay",
        "runs with a false delay of another signal",
        "runs with all parameters within 1.5 %: signal late; signal on time",
    ),
    reading="The last column compares two identifications: of the recording with the late signal, and of this "
    "recording before the program delays its signal. `identify` removes a found delay.",
)
PROMPT = Part(
    title="Delays: nothing is late",
    asked="Does `identify` report a delay although no signal is late?",
    header=("recording", "runs", "runs with a false delay: signal"),
)
SILENT = Part(
    title="Delays: a reading that is not fed back",
    asked="How accurate is the found delay of a sensor reading that the controller does not use? Its error is "
    "compared with the least possible standard error, the Cramér-Rao bound of each run (`benchmarks/delay_limit.py`).",
    header=(
        "sampling rate",
        "runs",
        "least standard error [ms]: median, 90 % quantile",
        "runs that determine the delay to 0.3 ms",
        "of these runs: delay found to 0.3 ms",
        "of the other runs: delay found to 0.3 ms",
        "error / least standard error, median",
        "95 % intervals that contain the true delay",
    ),
    reading="If the standard error equals the least standard error, the median of error / least standard error is "
    "0.67.",
)
_ROUNDED = 1e-5  # [s] uncertainty of a delay from rounding alone
_MOTIONS = ("thesis", "sines", "trapezoids", "chirp")
_MISMATCHES: Mapping[str, Mapping[str, Any]] = {
    "viscous friction drifts by -30 %": {"plant": {"viscous_drift": -0.3}},
    "presliding": {"plant": LUGRE},
    "friction asymmetry 20 %": {"plant": {"asymmetry": 0.2}},
    "Stribeck exponent 1 instead of 2": {"plant": {"exponent": 1.0}},
    "inertia varies": {"plant": POSE},
    "torque 0.3 N·m · sin 3q": {"plant": {"harmonic_torque": 0.3}},
    "load friction, coefficient 0.03": {"plant": {"load_friction": 0.03}},
    "torque constant wrong by 10 %": {"plant": {"torque_scale": 1.1}},
}


@dataclass(frozen=True, kw_only=True)
class Case:
    """Recordings with one signal late, or with none.

    Attributes
    ----------
    title : str
    signal : str
        Name of the late signal; empty if no signal is late.
    condition : Condition
    """

    title: str
    signal: str
    condition: Condition

    @property
    def silent(self) -> bool:
        """Whether only the motion shows the delay of the sensor."""
        return self.signal == "sensor" and self.condition.law.get("feedback") == 0.0


def cases() -> list[Case]:
    """Return every kind of recording, in the order of the tables."""
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
                    title = f"sensor, {rate}, not used by the controller"
                    found.append(Case(title=title, signal=signal, condition=silent))
            found.append(Case(title=f"clean, {rate}", signal="", condition=Condition(**common)))
            for name, fields in _MISMATCHES.items():
                found.append(Case(title=name, signal="", condition=Condition(**common, **fields)))
    return found


def late(recording: jid.Recording, signal: str, delay: float) -> jid.Recording:
    """Return the recording with a late signal, interpolated between samples."""
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
    """Result for one recording.

    Attributes
    ----------
    error : float
        Error of the certain delay [s]; infinite if no delay is certain.
    stated : float
        Standard error of the certain delay [s].
    false : frozenset of str
        Other signals with a reported delay.
    worst : float
        Largest relative error of a parameter; for the offset, relative to the Coulomb friction.
    before : float
        Largest relative error of a parameter before the signal is delayed.
    limit : Limit or None
        Cramér-Rao bound of the delay; None if the controller uses the reading.
    apart : float
        Error of the measured delay, certain or not, over its standard error; NaN if no delay is measured.
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
    """Identify a recording after its signal is delayed; `quiet` is the recording without noise of the sensor."""
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
    """Return the outcomes of all recordings, by the title of their case."""
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
    """Return the recordings without sensor noise; the controller does not use the sensor, so the motion is the same."""
    log = replace(bench.log, sensor_noise=0.0)
    return list(simulate(replace(bench, log=log), duration=DURATION, seed=seed))


def late_rows(found: Found) -> Iterator[list[object]]:
    """Yield one line per late signal."""
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
    """Yield one line per kind of recording without a late signal."""
    for title, (case, runs) in found.items():
        if not case.signal:
            false = [name for each in runs for name in sorted(each.false)]
            said = ", ".join(f"{name} {false.count(name)}" for name in sorted(set(false))) or "none"
            yield [title, len(runs), said]


def silent_rows(found: Found) -> Iterator[list[object]]:
    """Yield one line per rate: errors of delays compared with their Cramér-Rao bounds."""
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
    parser.add_argument("--runs", type=int, default=13, help="number of joints per motion and rate")
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--only", default="", help="only cases with this text in their titles")
    parser.add_argument("--write", action="store_true", help="also write the tables into the page")
    given = parser.parse_args()
    began = time.process_time()
    found = outcomes(given.runs, given.seed, given.only)
    for part, rows in ((LATE, late_rows), (PROMPT, prompt_rows), (SILENT, silent_rows)):
        publish(part, rows(found), write=given.write)
    total = sum(len(runs) for _, runs in found.values())
    print(f"{total} runs in {time.process_time() - began:.0f} s of CPU", file=sys.stderr)


if __name__ == "__main__":
    main()
