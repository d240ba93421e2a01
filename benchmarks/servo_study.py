"""How well a servo without a torque signal is identified: simulated benches with known truth, and the XL330's logs.

    python benchmarks/servo_study.py
    python benchmarks/servo_study.py --only logs

writes docs/servo_accuracy.md, or one section of it anew. The benches are `tests/simulated_servo.py`: their truth is
drawn anew for each. The logs are Rhoban BAM's (Apache-2.0), in tests/data. The peer is CMA-ES on rollouts of the same
model, on the same training runs, with the rollouts of the core and pycma (dependency group `bench`).
"""

from __future__ import annotations

import argparse
import re
import sys
from collections.abc import Callable, Iterator
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(ROOT / "tests"))
sys.path.insert(0, str(ROOT / "benchmarks"))

from servo_benches import FIRST_SEED, bench_table, broken_table  # noqa: E402
from servo_logs import LOGS, log_tables  # noqa: E402

HEAD = """# Accuracy of a servo without a torque signal

Written by `benchmarks/servo_study.py`; do not edit. [Servos](servos.md) says how to use it.
"""


def benches_section(arguments: argparse.Namespace) -> Iterator[str]:
    """Simulated benches as they should be."""
    yield f"## Simulated benches: {arguments.benches}, each with a servo of its own"
    yield ""
    yield (
        "16 runs of 6 s, four gains and four motions; torque constant, resistance, inertia and friction are drawn "
        "within 30 % of the nominal ones. Position in 4,096 counts; the duty is read 2.5 ms after it; the supply sags "
        "by .15 Ω and is logged with noise; the logged velocity lags by 20 ms. Nothing was chosen on these seeds."
    )
    yield ""
    yield from bench_table(range(FIRST_SEED, FIRST_SEED + arguments.benches))


def broken_section(arguments: argparse.Namespace) -> Iterator[str]:
    """Simulated benches where something is not as assumed."""
    yield "## Where an assumption does not hold"
    yield ""
    yield (
        f"The same benches, {arguments.broken} of each, with something that the model or the joint file lacks: mean "
        f"errors, how many of these parameters' intervals hold the truth, what the model leaves of the load's torque, "
        "and what is said."
    )
    yield ""
    first = FIRST_SEED + arguments.benches
    yield from broken_table(range(first, first + arguments.broken))


def logs_section(arguments: argparse.Namespace) -> Iterator[str]:
    """The XL330's logs."""
    yield "## XL330: logs of Rhoban BAM"
    yield ""
    yield (
        "16 runs of a pendulum. Mean absolute error of the position in closed loop, simulated from the logged "
        "initial state, on runs that the fit did not see: median and worst of 16. CMA-ES has the same rollouts of the "
        "same model on the same training runs; it seeks the smallest mean error by two searches of 12 individuals, "
        "each until its errors are flat to 1e-6 rad, and the best counts. Evaluations are sets of rollouts of all "
        "training runs; seconds are of the processor, for one fit."
    )
    yield ""
    yield from log_tables(arguments.logs, peer=not arguments.no_peer)


SECTIONS: dict[str, Callable[[argparse.Namespace], Iterator[str]]] = {
    "benches": benches_section,
    "broken": broken_section,
    "logs": logs_section,
}


def main() -> None:
    """Run the study."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument(
        "--only", choices=SECTIONS, help="write this section anew, and keep the others"
    )
    parser.add_argument("--benches", type=int, default=100)
    parser.add_argument("--broken", type=int, default=20)
    parser.add_argument("--logs", type=Path, default=LOGS)
    parser.add_argument("--no-peer", action="store_true")
    parser.add_argument("--output", type=Path, default=ROOT / "docs" / "servo_accuracy.md")
    arguments = parser.parse_args()
    kept = dict.fromkeys(SECTIONS, "")
    if arguments.only is not None and arguments.output.exists():
        written = re.split(r"^(?=## )", arguments.output.read_text(encoding="utf-8"), flags=re.M)[
            1:
        ]
        kept = dict(zip(SECTIONS, written, strict=True))
    for name, section in SECTIONS.items():
        if arguments.only in (None, name):
            kept[name] = "\n".join(section(arguments)) + "\n"
    text = "\n".join([HEAD, *(each.rstrip() + "\n" for each in kept.values())])
    arguments.output.write_text(text, encoding="utf-8")


if __name__ == "__main__":
    main()
