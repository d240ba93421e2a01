"""Whole arms: TX40 beside the classical way, and a simulated arm of seven joints. Writes docs/robot_accuracy.md.

python benchmarks/robot_study.py [--runs 20] [--log FOLDER OF tx40.csv.gz] [--output FILE] [--only SECTION]
"""

from __future__ import annotations

import argparse
import time
from collections.abc import Callable, Iterator
from pathlib import Path

from arms import mismatches, naming_tables, seven_tables, speed_tables, tx40_tables

_LOG = Path(__file__).resolve().parents[1] / "tests" / "data" / "tx40"


def sections(
    runs: int, hour: bool, log: Path
) -> dict[str, tuple[str, Callable[[], Iterator[str]]]]:
    """Title and lines of each section."""
    tables: dict[str, tuple[str, Callable[[], Iterator[str]]]] = {
        "runs": (f"Simulated arms: {runs}", lambda: seven_tables.accuracy(range(runs))),
        "noise": (
            f"Noise that drowns accelerations, arms: {min(runs, 3)}",
            lambda: seven_tables.noise(range(min(runs, 3))),
        ),
        "heavier": (
            "A link that weighs 20 % more than the URDF says",
            lambda: seven_tables.heavier(range(min(runs, 3))),
        ),
        "facts": ("Facts that are wrong", lambda: seven_tables.wrong_facts(0)),
        "wrong": (
            f"What else may be wrong, arms: {min(runs, 2)}",
            lambda: mismatches.table(range(min(runs, 2))),
        ),
        "delays": (f"A late torque, arms: {runs}", lambda: naming_tables.delays(range(runs))),
        "causes": (
            f"Causes that are named, arms: {min(runs, 10)}",
            lambda: naming_tables.causes(range(min(runs, 10))),
        ),
        "speed": ("Time and memory", lambda: speed_tables.tables(0, 5, hour)),
    }
    if not (log / "tx40.csv.gz").is_file():
        print(f"{log} holds no tx40.csv.gz: without the measured arm")
        return tables
    read = tx40_tables.Log.read(log)
    measured: dict[str, tuple[str, Callable[[], Iterator[str]]]] = {
        "friction": ("TX40: friction", lambda: tx40_tables.parameters(read)),
        "blocks": ("TX40: blocks that were not used", lambda: tx40_tables.held_out(read)),
    }
    return measured | tables


def main() -> None:
    """Run the sections and write the page."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--runs", type=int, default=20, help="simulated arms")
    parser.add_argument("--hour", action="store_true", help="time an hour's recording, too")
    parser.add_argument(
        "--log", type=Path, default=_LOG, help="folder of tx40.csv.gz and tx40.urdf"
    )
    parser.add_argument("--only", default="", help="sections whose name contains this")
    parser.add_argument("--output", type=Path, help="a file to write instead of printing")
    given = parser.parse_args()
    began = time.perf_counter()
    lines = [_TEXT]
    for name, (title, table) in sections(given.runs, given.hour, given.log).items():
        if given.only in name:
            lines += ["", f"## {title}", "", _BESIDE[name], "", *table()]
    text = "\n".join(lines) + "\n"
    if given.output is None:
        print(text)
    else:
        given.output.write_text(text, encoding="utf-8")
    print(f"{time.perf_counter() - began:.0f} s")


_TEXT = """# Accuracy of whole arms

Written by `benchmarks/robot_study.py` (`make study`); do not edit. The classical way stands beside ours:
positions through a Butterworth filter of 4th order forward and backward, central differences, torques filtered
and decimated, least squares weighted by joint, base parameters by QR (`benchmarks/arms/classical.py`; nothing
of the package is in it). The arms of the simulated runs are `tests/simulated_arm`: pinocchio's dynamics,
friction that may hold any torque at standstill, a controller along sums of sines; nothing of the package's core
is in it."""

_BESIDE = {
    "friction": """The raw log at the motors, 5 kHz, 9 s; the call gets the URDF, gear ratios, the zeros of
joints 2 and 3, and that motor 6 turns with joints 5 and 6. Model: Coulomb and viscous, as
published (Janot, Vandanjon, Gautier). The published viscous friction of joints 5 and 6 holds
motor 6's. Filtered least squares at 20 Hz; its standstill and slow rows are left out by the
authors' limits, ours by the package.""",
    "blocks": """Five blocks of 1.5 s, each predicted from what the other four gave. Norm of the windows'
residual torque integrals over the norm of the measured ones, windows side by side, reversals
included; the measured torque is not filtered. Ours predicts by the
motion of the filter of 40 Hz, so that only what was identified differs, or by its own velocity.
The last column counts the joints where ours is not above the filtered least squares that is best
in all joints together.""",
    "runs": """Random friction (Coulomb, viscous, a Stribeck rise of 20 to 60 %), rotors and motion; 20 s at 1
kHz; stamps late by 50 µs in the mean, exponential; 2¹⁹ counts a turn; velocities 5 ms late;
torque noise .5 % of the largest torque. Coverage: of the 95 % intervals of Coulomb and viscous
friction; the next column is the root mean square of errors over half an interval, .51 where
intervals are as wide as they should be. The filtered least squares knows Coulomb and viscous
friction; rows below .2 rad/s, where most of the rise is, are left out: with 40 Hz that is the best
of 32 settings that were tried on four of these arms.""",
    "noise": """As above with noise on every position and no velocities. Worst error of Coulomb or viscous
friction. The ratio is that of the standard deviations of a second difference of the true
positions and of its error, of the best joint.""",
    "heavier": """Scales of the links, and what a call says that takes the URDF's inertias for true.""",
    "facts": """One arm; the call gets something wrong, and has to say what.""",
    "wrong": """The call is not informed of it; the largest over the arms, and how often each warning came.""",
    "delays": """Every torque as it was so much before; the call does not know it. Errors are the largest over the
arms.""",
    "causes": """One fact is wrong, and the call does not know it. Counted are the runs in which the cause is named,
and those in which something else is named as a cause, too or instead. Explained: of the squared
residual, in stretches of motion from which the cause's size was not taken. Free inertias follow what
is wrong with links: then there is nothing to name.""",
    "speed": """Each in a program of its own, on two cores that may have other work: so the processor's seconds
stand beside those of the clock. The loop is plain Python over 20 s: pinocchio's four regressors a
sample, and nothing else; the ratio is of processor seconds. Memory before is that of the program
with the recording.""",
}


if __name__ == "__main__":
    main()
