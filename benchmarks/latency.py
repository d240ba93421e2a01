"""What a user waits for: imports, the command line, the first call, a file, a report. Ratios of CPU time; Markdown.

Each program is a new process with compiled bytecode, all of them in turn; the shortest CPU time of each counts, since
what else the machine does only adds to it. Look at the ratios.
"""

import argparse
import json
import os
import subprocess
import sys
import tempfile
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

import jointid as jid
from jointid.base.files import write_whole
from jointid.cli.demo import data_folder

_CALLS = """
import json, sys, time
from pathlib import Path

def cpu(call):
    began = time.process_time()
    call()
    return time.process_time() - began

from jointid import identify, load, thesis_joint
path, joint = Path(sys.argv[1]), thesis_joint()
recording = load(path)
found = {"first": cpu(lambda: identify(recording, joint))}
found["warm"] = min(cpu(lambda: identify(recording, joint)) for _ in range(20))
found["scipy"] = "scipy" in sys.modules
estimate = identify(recording, joint)
from jointid.report.html import save_report
page = path.with_suffix(".html")
found["first report"] = cpu(lambda: save_report(estimate, page))
found["report"] = min(cpu(lambda: save_report(estimate, page)) for _ in range(2))
import pandas
for name, file in (("csv", path), ("gz", path.with_suffix(".csv.gz"))):
    pairs = [(cpu(lambda: load(file)), cpu(lambda: pandas.read_csv(file))) for _ in range(30)]
    found[name] = min(ours for ours, _ in pairs)
    found[name + " pandas"] = min(theirs for _, theirs in pairs)
print(json.dumps(found))
"""

_NOTES = """
- Bytecode is compiled before, as pip does it. `python -c pass` includes what the environment's own `.pth` files take.
- `import jointid` imports no room and not even numpy: they come with the first name that needs them.
- *First*: the first `identify()` behind `from jointid import identify` and `load`, with what it still imports. *Warm*:
  the quickest of the 20 that follow.
- pandas reads the numbers; `jid.load` also finds out which column is what in which unit, and checks the signals.
- The file is `examples/data/well_excited.csv.gz`: 12,000 rows of five columns, 0.6 MB of text."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Row:
    """One line of the table: a time, what it is compared with, and the largest ratio that is allowed."""

    what: str
    against: str
    limit: float | None = None


_ROWS = (
    Row(what="`jointid --help`", against="`python -c pass`", limit=4.0),
    Row(what="`import jointid`", against="`import numpy`", limit=1.3),
    Row(what="`from jointid import identify, load`", against="`import numpy`"),
    Row(what="`jointid identify run.csv`", against="`import numpy`", limit=2.2),
    Row(what="first `identify()`", against="warm `identify()`", limit=3.0),
    Row(what="`jid.load` of the .csv", against="`pandas.read_csv`", limit=1.0),
    Row(what="`jid.load` of the .csv.gz", against="`pandas.read_csv` of it"),
    Row(what="HTML report", against="warm `identify()`", limit=10.0),
    Row(what="first HTML report", against="warm `identify()`"),
)


def seconds_of(command: list[str], environment: Mapping[str, str]) -> float:
    """CPU time of a program and its threads."""
    with Path(os.devnull).open("w") as nowhere:
        process = subprocess.Popen(command, stdout=nowhere, stderr=nowhere, env=environment)
        _, status, used = os.wait4(process.pid, 0)
        process.returncode = os.waitstatus_to_exitcode(status)
    if process.returncode:
        raise RuntimeError(f"{' '.join(command)} ended with {process.returncode}")
    return used.ru_utime + used.ru_stime


def measure(runs: int) -> dict[str, float]:
    """CPU seconds by name."""
    with tempfile.TemporaryDirectory() as folder:
        environment = {k: v for k, v in os.environ.items() if k != "PYTHONDONTWRITEBYTECODE"}
        environment |= {"PYTHONPYCACHEPREFIX": folder, "OPENBLAS_NUM_THREADS": "1"}
        path = Path(folder) / "run.csv"
        recording = jid.load(data_folder() / "well_excited.csv.gz")
        header = "time_s,position_rad,velocity_rad_s,torque_Nm,sensor_raw"
        columns = [getattr(recording, name).tolist() for name in recording.signals]
        rows = (",".join(map(repr, row)) for row in zip(*columns, strict=True))
        path.write_text("\n".join([header, *rows, ""]), encoding="utf-8")
        subprocess.run(["gzip", "--keep", str(path)], check=True)
        python = sys.executable
        programs = {
            "`python -c pass`": [python, "-c", "pass"],
            "`import numpy`": [python, "-c", "import numpy"],
            "`import jointid`": [python, "-c", "import jointid"],
            "`from jointid import identify, load`": [
                *(python, "-c", "from jointid import identify, load"),
            ],
            "`jointid --help`": [python, "-m", "jointid", "--help"],
            "`jointid identify run.csv`": [python, "-m", "jointid", "identify", str(path)],
        }
        found = dict.fromkeys(programs, float("inf"))
        for run in range(runs + 1):
            for name, command in programs.items():
                seconds = seconds_of(command, environment)
                if run:  # the first one compiles the bytecode
                    found[name] = min(found[name], seconds)
        calls = [
            json.loads(
                subprocess.run(
                    [python, "-c", _CALLS, str(path)],
                    env=environment,
                    stdout=subprocess.PIPE,
                    check=True,
                ).stdout
            )
            for _ in range(max(1, runs // 4) + 1)
        ][1:]
    least = {name: min(each[name] for each in calls) for name in calls[0]}
    if any(each["scipy"] for each in calls):
        raise RuntimeError("identify() imports SciPy")
    return found | {
        "first `identify()`": least["first"],
        "warm `identify()`": least["warm"],
        "`jid.load` of the .csv": least["csv"],
        "`pandas.read_csv`": least["csv pandas"],
        "`jid.load` of the .csv.gz": least["gz"],
        "`pandas.read_csv` of it": least["gz pandas"],
        "HTML report": least["report"],
        "first HTML report": least["first report"],
    }


def main(runs: int, output: Path | None) -> None:
    """Measure, and print the table."""
    seconds = measure(runs)
    lines = [
        "# What a user waits for\n",
        "Written by `benchmarks/latency.py` (part of `make bench`); do not edit. CPU time of the quickest of",
        f"{runs} runs, all programs in turn on one machine; the ratios are what holds.\n",
        "| what | CPU [ms] | against | CPU [ms] | ratio | required | holds |",
        "|---|---|---|---|---|---|---|",
    ]
    for row in _ROWS:
        ratio = seconds[row.what] / seconds[row.against]
        limit = "" if row.limit is None else f"≤ {row.limit:g}"
        holds = "" if row.limit is None else "yes" if ratio <= row.limit else "**no**"
        times = f"{1e3 * seconds[row.what]:.3g} | {row.against} | {1e3 * seconds[row.against]:.3g}"
        lines.append(f"| {row.what} | {times} | {ratio:.2f} | {limit} | {holds} |")
    page = "\n".join([*lines, _NOTES, ""])
    print(page)
    if output is not None:
        write_whole(output, page.encode())


if __name__ == "__main__":
    arguments = argparse.ArgumentParser(description=__doc__)
    arguments.add_argument("--runs", type=int, default=15, help="of each program (default 15)")
    arguments.add_argument("--output", type=Path, help="write the page here, too")
    options = arguments.parse_args()
    main(options.runs, options.output)
