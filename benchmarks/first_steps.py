"""The steps from `pip install` to an estimate of one's own log, each timed. Ratios of CPU time; Markdown.

The user states neither the meaning of the log's columns nor how to read it. The output of a step is pasted into the
next one, as a newcomer does. Each step is a program of its own; the shortest of `--runs` counts.

    python benchmarks/first_steps.py
    python benchmarks/first_steps.py --wheel dist/jointid-*.whl
"""

import argparse
import os
import re
import shlex
import subprocess
import sys
import tempfile
from pathlib import Path

REPOSITORY = Path(__file__).resolve().parents[1]
LOG = REPOSITORY / "tests" / "cli" / "foreign_logs" / "kr300_125_hz.csv.gz"
RATIO = "256.86"  # from the robot's data sheet: known to the newcomer


def run(command: list[str], folder: Path, code: int = 0) -> tuple[float, str]:
    """Return the CPU time of a program with its threads and child processes, and its output."""
    before = os.times()
    environment = os.environ | {"OPENBLAS_NUM_THREADS": "1"}
    done = subprocess.run(
        command, cwd=folder, env=environment, capture_output=True, text=True, check=False
    )
    after = os.times()
    if done.returncode != code:
        raise RuntimeError(f"{command} ended with {done.returncode}: {done.stderr}")
    used = after.children_user + after.children_system
    return used - before.children_user - before.children_system, done.stdout + done.stderr


def advised(printed: str) -> list[str]:
    """Return the options after the first "with", with the facts that only the user knows."""
    advice = re.sub(r"\([^()]*\)", "", printed.partition(" with ")[2])
    advice = re.split(";| or ", advice)[0]
    return [RATIO if word == "RATIO" else word for word in shlex.split(advice)]


def steps(runs: int) -> list[tuple[str, float, str]]:
    """Yield command, CPU seconds and purpose of each step, in order."""
    jointid = [sys.executable, "-m", "jointid"]
    log = LOG.name
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        (folder / log).write_bytes(LOG.read_bytes())
        first = ["identify", log, "--quiet"]
        _, printed = run([*jointid, *first], folder, code=2)
        options = advised(printed)
        calls = [
            (first, "says what is missing, all at once"),
            ([*first, *options], "**the first estimate**: what was printed, pasted"),
            (["new", "joint.toml", log, *options], "a joint file to write facts into"),
            (
                [*first, *options, "--joint", "joint.toml", "--report", "report.html"],
                "with the joint file, and a report",
            ),
        ]
        rows = []
        for words, purpose in calls:
            times = []
            for _ in range(runs):
                if words[0] == "new":
                    (folder / "joint.toml").unlink(missing_ok=True)
                times.append(run([*jointid, *words], folder, code=2 * (words is first))[0])
            shown = " ".join(word for word in words if word != "--quiet")
            rows.append((f"`jointid {shown}`", min(times), purpose))
    return rows


def installed(wheel: Path) -> tuple[str, float, str]:
    """Install a wheel in a new environment with NumPy: the first step."""
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        subprocess.run([sys.executable, "-m", "venv", str(folder / "env")], check=True)
        pip = [str(folder / "env" / "bin" / "pip"), "install", "--quiet"]
        subprocess.run([*pip, "numpy"], check=True)
        seconds, _ = run([*pip, "--no-deps", str(wheel.resolve())], folder)
    return f"`pip install {wheel.name.partition('-')[0]}`", seconds, "a wheel, NumPy there before"


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--runs", type=int, default=5)
    parser.add_argument("--wheel", type=Path)
    arguments = parser.parse_args()
    numpy = min(run([sys.executable, "-c", "import numpy"], REPOSITORY)[0] for _ in range(9))
    rows = [installed(arguments.wheel)] if arguments.wheel else []
    rows += steps(arguments.runs)
    print("| step | does | CPU time, in imports of NumPy |\n|---|---|--:|")
    for step, cpu, does in rows:
        print(f"| {step} | {does} | {cpu / numpy:.1f} |")


if __name__ == "__main__":
    main()
