"""Random arms, each with one random fault that the call does not know, and clean ones.

python benchmarks/robot_faults.py [--faulty 100] [--clean 50] [--only FAULT] [--write]
"""

from __future__ import annotations

import argparse
import tempfile
import time
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from arms.log_faults import FAULTS, FaultyLog, faulty_log
from measured import Part, publish

import jointid as jid

PART = Part(
    title="Robot logs with one fault",
    asked="Does `identify` refuse or doubt a faulty log of an arm, and does a finding name the fault? Random serial "
    "arms of three to seven joints, 20 s. The call has the true URDF and no options.",
    header=(
        "fault",
        "arms",
        "usable, wrong values",
        "refused or not usable",
        "usable with care",
        "usable, right values",
        "fault named",
        "CPU time, median [s]",
    ),
    reading="Values are *wrong* if the friction of a joint has an error above 5 % and its 95 % interval does not "
    "contain the truth. Usable logs with wrong values, and clean logs without the verdict *usable*: {bad}.",
)
_WRONG = 0.05  # of a value, outside its interval
_SHOWN = 14  # number of cases that are listed one by one
_NAMED = {  # codes of findings that name the fault
    "signs": {
        *("reversed_torques", "reversed_positions"),
        *("wrong_sign", "wrong_torque_sign", "wrong_motion_sign"),
    },
    "factors": {
        *("scaled_torques", "different_factors", "wrong_torque_scale"),
        *("implausible_unit", "unsigned_torque"),
    },
    "order": {"swapped_joints", "swapped_torques", "joint_order"},
    "lag": {"delay_removed", "signal_lag", "lag"},
    "load": {"load_friction"},
    "smooth": {"rise", "smooth_friction"},
}


@dataclass(frozen=True, kw_only=True)
class Outcome:
    """Output of a call, and whether it is right."""

    fault: str
    detail: str
    seed: int
    level: str  # of the verdict; "refused" for an error
    worst: float  # largest error of Coulomb or viscous friction outside its interval
    codes: tuple[str, ...]  # of all findings, the most severe first
    seconds: float  # of the processor

    @property
    def kind(self) -> str:
        """Kind of the outcome."""
        if self.level in ("refused", "not usable"):
            return "refused"
        if self.level == "usable with care":
            return "doubted"
        return "wrong" if self.worst > _WRONG else "right"

    @property
    def is_named(self) -> bool:
        """Return whether a finding names the fault."""
        return bool(_NAMED.get(self.fault, set()) & set(self.codes))


def outcome(log: FaultyLog, seed: int) -> Outcome:
    """Identify the log by the plain call."""
    began = time.process_time()
    codes: tuple[str, ...]
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "arm.urdf"
        path.write_text(log.arm.urdf, encoding="utf-8")
        try:
            found = jid.identify(log.recording, jid.Robot.from_urdf(path))
        except jid.InputError as error:
            level, worst, codes = "refused", 0.0, (f"error: {error.reason}",)
        else:
            level, worst = found.verdict.level, _worst(log, found)
            codes = tuple(each.code for each in found.findings)
    return Outcome(
        fault=log.fault,
        detail=log.detail,
        seed=seed,
        level=level,
        worst=worst,
        codes=codes,
        seconds=time.process_time() - began,
    )


def _worst(log: FaultyLog, found: jid.RobotEstimate) -> float:
    worst = 0.0
    for place, joint in enumerate(found.joints.values()):
        for name, true in (("coulomb", log.arm.coulomb), ("viscous", log.arm.viscous)):
            p = joint.parameters[name]
            low, high = p.interval or (p.value, p.value)
            if not low <= true[place] <= high:
                worst = max(worst, abs(p.value / float(true[place]) - 1.0))
    return worst


def cases(faulty: int, clean: int, only: str) -> Iterator[tuple[int, str]]:
    """Return seed and fault of each log: the faults in turn."""
    every = [(seed, FAULTS[seed % len(FAULTS)]) for seed in range(faulty)]
    every += [(10_000 + seed, "clean") for seed in range(clean)]
    yield from (each for each in every if only in each[1])


def table(found: Sequence[Outcome]) -> Iterator[list[object]]:
    """Yield one row per fault."""
    kinds = ("wrong", "refused", "doubted", "right")
    for fault in dict.fromkeys(each.fault for each in found):
        mine = [each for each in found if each.fault == fault]
        counts = [sum(each.kind == kind for each in mine) for kind in kinds]
        seconds = float(np.median([each.seconds for each in mine]))
        named = sum(each.is_named for each in mine) if fault in _NAMED else "–"
        yield [fault, len(mine), *counts, named, f"{seconds:.1f}"]


def bad(found: Sequence[Outcome]) -> str:
    """Return the cases with a bad outcome, as a list."""
    shown = [
        each
        for each in found
        if each.kind == "wrong" or (each.fault == "clean" and each.level != "usable")
    ]
    return "; ".join(map(line, shown[:_SHOWN])) or "none"


def line(each: Outcome) -> str:
    """Return the line of one case."""
    codes = ", ".join(dict.fromkeys(each.codes)) or "none"
    detail = f" ({each.detail})" if each.detail else ""
    return (
        f"{each.fault} {each.seed}{detail}: {each.level} (largest error with the truth outside the interval "
        f"{100.0 * each.worst:.1f} %, findings: {codes})"
    )


def main() -> None:
    """Run the study and publish its table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--faulty", type=int, default=100, help="number of arms with a fault")
    parser.add_argument("--clean", type=int, default=50, help="number of arms without a fault")
    parser.add_argument("--only", default="", help="only faults with this in their name")
    parser.add_argument("--write", action="store_true", help="write it into the page, too")
    given = parser.parse_args()
    found = []
    for seed, fault in cases(given.faulty, given.clean, given.only):
        found.append(outcome(faulty_log(seed, fault), seed))
        print(f"{found[-1].kind:8} {found[-1].seconds:5.1f} s  {line(found[-1])}", flush=True)
    publish(PART, table(found), write=given.write, bad=bad(found))


if __name__ == "__main__":
    main()
