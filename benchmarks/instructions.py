"""Instructions of warm calls, counted by callgrind: what does not depend on what else the machine does. Markdown.

Counting begins after a first call, so that imports and what is made once drop out. Needs valgrind, which emulates
AVX2. With one thread of BLAS, since threads that wait count, too.
"""

import argparse
import os
import re
import shutil
import subprocess
import sys
import tempfile
from dataclasses import dataclass
from pathlib import Path

from recordings import WELL_EXCITED

_PROGRAM = """
import os, subprocess, sys
import jointid as jid
recording, joint = jid.load(sys.argv[1]), jid.thesis_joint()
estimate = jid.identify(recording, joint)
calls = {
    "identify": lambda: jid.identify(recording, joint),
    "auto": lambda: jid.identify(recording, joint, model="auto"),
    "bootstrap": lambda: estimate.bootstrap(1000),
    "json": estimate.to_json,
    "compare two": lambda: jid.compare_models(recording, joint, models=["coulomb_viscous", "stribeck"]),
    "compare five": lambda: jid.compare_models(
        recording,
        joint,
        models=["coulomb_viscous", "stribeck", "stribeck_general", "stribeck:ripple=1", "coulomb_viscous:ripple=1"],
    ),
}
def count(state):
    subprocess.run(["callgrind_control", "-i", state, str(os.getpid())], stdout=subprocess.DEVNULL, check=True)

calls[sys.argv[2]]()
count("on")
calls[sys.argv[2]]()
count("off")
"""
_OLDEST = 67.8  # millions: a default identify() of version 0.1.0
_OLDEST_TIME = 7.1  # [ms] of CPU on the machine to which required times refer


@dataclass(frozen=True, slots=True, kw_only=True)
class Row:
    """A call, and what is required of it: millions of instructions, or milliseconds of that machine."""

    name: str
    what: str
    instructions: float | None = None
    time: float | None = None

    @property
    def limit(self) -> float:
        """Millions of instructions that are allowed."""
        if self.instructions is not None:
            return self.instructions
        return (self.time or 0.0) * _OLDEST / _OLDEST_TIME


ROWS = (
    Row(name="identify", what="default `identify()`", instructions=45.0),
    Row(name="auto", what='`identify(model="auto")`', time=25.0),
    Row(name="bootstrap", what="`bootstrap(1000)`", time=150.0),
    Row(name="json", what="`to_json`", time=3.0),
    Row(name="compare two", what="`compare_models` of two models", time=35.0),
    Row(name="compare five", what="the same of five, one general", time=250.0),
)


def counted(row: Row, path: Path) -> float:
    """Millions of instructions of one call."""
    with tempfile.TemporaryDirectory() as folder:
        found = Path(folder) / "found"
        environment = os.environ | {"OPENBLAS_NUM_THREADS": "1", "PYTHONHASHSEED": "0"}
        subprocess.run(
            [
                *(
                    "valgrind",
                    "--tool=callgrind",
                    "--instr-atstart=no",
                    f"--callgrind-out-file={found}",
                ),
                *(sys.executable, "-c", _PROGRAM, str(path), row.name),
            ],
            env=environment,
            check=True,
            stderr=subprocess.DEVNULL,
        )
        text = found.read_text(encoding="utf-8")
    return int(re.findall(r"^(?:summary|totals): (\d+)", text, re.MULTILINE)[-1]) / 1e6


def table(names: list[str] | None = None) -> str:
    """The rows as Markdown, all of them by default; without valgrind a sentence."""
    if shutil.which("valgrind") is None:
        return "Instructions were not counted: valgrind is not installed.\n"
    lines = [
        "| warm call | instructions [10⁶] | required | holds |",
        "|---|---|---|---|",
    ]
    for row in ROWS:
        if names is not None and row.name not in names:
            continue
        found = counted(row, WELL_EXCITED)
        holds = "yes" if found <= row.limit else "**no**"
        lines.append(f"| {row.what} | {found:.1f} | ≤ {row.limit:.0f} | {holds} |")
    return "\n".join([*lines, ""])


if __name__ == "__main__":
    arguments = argparse.ArgumentParser(description=__doc__)
    known = [row.name for row in ROWS]
    arguments.add_argument("names", nargs="*", choices=[*known, []], help="default: all of them")
    print(table(arguments.parse_args().names or None))
