"""`make study`: signals that are late, and signals that are not; writes docs/delays.md.

Each recording has one signal late by 1 to 3 ms, or none; half of them are taken every millisecond, half every
second one. Others have a model error that could pass for a delay.
"""

from __future__ import annotations

import argparse
import sys
import time
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
from conditions import DURATION, LUGRE, POSE, Condition
from delay_limit import NORMAL, Limit, limit
from delay_limit import late as late_signal
from plants import Bench, simulate

import jointid as jid

NEAR = 3e-4  # [s] from the true delay
CLOSE = 0.015  # of the true value, with the delay taken away
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


def outcomes(runs: int, seed: int, only: str = "") -> dict[str, tuple[Case, list[Outcome]]]:
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


def tables(found: Mapping[str, tuple[Case, Sequence[Outcome]]]) -> list[str]:
    """Both tables, line by line."""
    lines = [
        f"| late signal | runs | named within {NEAR * 1e3:g} ms | determinable, and of these named so |"
        " named, but further off | further off than its 95 % interval says | median error |"
        " in its 95 % interval | the same of all measured delays | error over the bound, rms |"
        " named, interval beyond ± 0.3 ms | other signals called late |"
        + f" all parameters within {CLOSE:.1%} | the same runs, nothing late |".replace("%", " %"),
        f"|---|{13 * '--:|'}",
    ]
    for title, (case, runs) in found.items():
        if case.signal:
            named = [each for each in runs if np.isfinite(each.error)]
            errors = np.array([each.error for each in named])
            inside = [each.error < NORMAL * each.stated + 2e-5 for each in named]
            measured = [abs(each.apart) < NORMAL for each in runs if np.isfinite(each.apart)]
            can = [each for each in runs if each.limit and each.limit.determinable(NEAR)]
            near = np.count_nonzero([each.error < NEAR for each in can])
            unsaid = [e >= NEAR and not said for e, said in zip(errors, inside, strict=True)]
            wide = [NORMAL * each.stated > NEAR for each in named]
            lines.append(
                f"| {title} | {len(runs)} | {np.count_nonzero(errors < NEAR)} |"
                f" {f'{len(can)}, {near}' if case.silent else ''} |"
                f" {np.count_nonzero(errors >= NEAR)} | {sum(unsaid)} |"
                f" {1e3 * np.median(errors) if len(errors) else np.nan:.2f} ms |"
                f" {sum(inside)} of {len(named)} | {sum(measured)} of {len(measured)} |"
                f" {_over_limit(named) if case.silent else ''} | {sum(wide)} |"
                f" {sum(bool(each.false) for each in runs)} |"
                f" {sum(each.worst <= CLOSE for each in runs)} |"
                f" {sum(each.before <= CLOSE for each in runs)} |"
            )
    close = f"{CLOSE:.1%}".replace("%", " %")
    head = f"| nothing is late | runs | a signal is called late | all parameters within {close} |"
    lines += ["", head, "|---|--:|---|--:|"]
    for title, (case, runs) in found.items():
        if not case.signal:
            false = [name for each in runs for name in sorted(each.false)]
            said = ", ".join(f"{name} {false.count(name)}" for name in sorted(set(false))) or "none"
            lines.append(
                f"| {title} | {len(runs)} | {said} | {sum(each.worst <= CLOSE for each in runs)} |"
            )
    return lines


def _over_limit(named: Sequence[Outcome]) -> str:
    """How large the errors are beside the least possible standard errors."""
    ratios = [each.error / each.limit.error for each in named if each.limit is not None]
    return f"{np.sqrt(np.mean(np.square(ratios))):.2f}" if ratios else ""


_TEXT = """# Delays between signals

Written by `benchmarks/delays_study.py` (`make study`); do not edit. Recordings of 12 s of random joints, simulated by
`tests/plants`, which shares no code with the package, with four motions each. Torque, velocity or the sensor's reading
(noise 0.2 N·m) is then made late by 1 to 3 ms, interpolated between samples. A delay is named if the estimate is
certain of it. It is then taken away, as `identify` does by itself; the last two columns compare the values with those
of the same recordings before the signal was made late.

A controller that feeds the reading back repeats its noise in the torque, and this tells the reading's delay. Without
such a controller the motion has to tell it. Smooth motion leaves a standard error of 0.1 to 0.6 ms at this noise
(the Cramér-Rao bound: the noise over the root of the summed squares of the load's rate). Jumps of the acceleration
at reversals tell it to 0.02 to 0.1 ms, except where a held torque's jump falls on a whole sample: the reading of an
instant and an interpolated one then look alike. *Determinable* are the recordings whose bound, with the true motion
and reading of each, allows a 95 % interval within ± 0.3 ms (`benchmarks/delay_limit.py`); of no other one can
any estimate promise it. Where the 95 % interval is wider than ± 0.3 ms, the finding states it. *All measured delays*
are those that `estimate.delays` has, certain or not; *error over the bound* of an estimate that is as good as any
would be 1.
"""


def main() -> None:
    """Run the cases and write the tables."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--runs", type=int, default=13, help="joints of each motion and rate")
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--only", default="", help="cases whose title contains this")
    parser.add_argument("--output", type=Path, help="a file to write instead of printing")
    given = parser.parse_args()
    began = time.process_time()
    found = outcomes(given.runs, given.seed, given.only)
    text = "\n".join([_TEXT, *tables(found)]) + "\n"
    if given.output is None:
        print(text)
    else:
        given.output.write_text(text, encoding="utf-8")
    total = sum(len(runs) for _, runs in found.values())
    print(f"{total} runs in {time.process_time() - began:.0f} s of CPU", file=sys.stderr)


if __name__ == "__main__":
    main()
