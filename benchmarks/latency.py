"""Waiting times of a user: imports, the command line, the first call, a file, a report. Ratios of CPU time.

Each program is a new process with compiled bytecode, all in turn. The shortest CPU time of each counts, because other
work of the machine only adds to it. Only the ratios are meaningful.
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

from measured import Part, publish
from recordings import WELL_EXCITED

import jointid as jid

_CALLS = """
import json, math, sys, time
from pathlib import Path

def least(call, times):
    return min(cpu(call) for _ in range(times))

def cpu(call):
    began = time.process_time()
    call()
    return time.process_time() - began

from jointid import identify, load, thesis_joint
path, joint = Path(sys.argv[1]), thesis_joint()
recording = load(path)
found = {"first `identify()`": cpu(lambda: identify(recording, joint))}
found["warm `identify()`"] = least(lambda: identify(recording, joint), 20)
estimate = identify(recording, joint)
from jointid import Estimate, compare_models
from jointid.report.saving import save_report
page = path.with_suffix(".html")
found["first HTML report"] = cpu(lambda: save_report(estimate, page))
found["HTML report"] = least(lambda: save_report(estimate, page), 3)
text = estimate.to_json()
found["`to_json`"] = least(estimate.to_json, 10)
found["`Estimate.from_json`"] = least(lambda: Estimate.from_json(text), 10)
found["`identify` with `auto`"] = least(lambda: identify(recording, model="auto"), 5)
found["`bootstrap(1000)`"] = least(lambda: estimate.bootstrap(1000), 2)
two = ["coulomb_viscous", "stribeck"]
found["`compare_models` of two models"] = least(lambda: compare_models(recording, joint, models=two), 8)
five = [*two, "coulomb_viscous:gravity=free", "stribeck:gravity=free", "stribeck_general"]
found["`compare_models` of five models"] = least(lambda: compare_models(recording, joint, models=five), 1)
found["others"] = sorted({name for name in ("scipy", "matplotlib") if name in sys.modules})
import pandas
for file in (path, path.with_suffix(".csv.gz")):
    ours, theirs = math.inf, math.inf
    for _ in range(30):
        ours = min(ours, cpu(lambda: load(file)))
        theirs = min(theirs, cpu(lambda: pandas.read_csv(file)))
    found[f"`jid.load` of {file.name}"], found[f"`pandas.read_csv` of {file.name}"] = ours, theirs
print(json.dumps(found))
"""

PART = Part(
    title="Latency",
    asked="How long does a user wait? The table has the shortest CPU time of {runs} runs, and its ratio to the time "
    "of another program or call. All programs run in turn. Only the ratios are comparable between machines.",
    header=("program or call", "CPU time [ms]", "compared with", "ratio of CPU times"),
    reading="*Warm*: the shortest of 20 calls. `run.csv` has 12,000 rows of five columns, 0.6 MB. *Five models*: two "
    "models, each without and with free gravity, and `stribeck_general`. SciPy and matplotlib are not imported.",
)


@dataclass(frozen=True, slots=True, kw_only=True)
class Row:
    """One line of the table: a time, and the time it is compared with."""

    what: str
    against: str = "`import numpy`"


_ROWS = (
    Row(what="`jointid --help`", against="`python -c pass`"),
    Row(what="`import jointid`", against="`import numpy`"),
    Row(what="`from jointid import identify, load`"),
    Row(what="`jointid identify run.csv`"),
    Row(what="`jointid identify run.csv --report page.html`"),
    Row(what="`jointid demo`", against="warm `identify()`"),
    Row(what="first `identify()`", against="warm `identify()`"),
    Row(what="`jid.load` of run.csv", against="`pandas.read_csv` of run.csv"),
    Row(what="`jid.load` of run.csv.gz", against="`pandas.read_csv` of run.csv.gz"),
    Row(what="HTML report", against="warm `identify()`"),
    Row(what="first HTML report", against="warm `identify()`"),
    Row(what="`to_json`", against="warm `identify()`"),
    Row(what="`Estimate.from_json`"),
    Row(what="`identify` with `auto`", against="warm `identify()`"),
    Row(what="`bootstrap(1000)`", against="warm `identify()`"),
    Row(what="`compare_models` of two models", against="warm `identify()`"),
    Row(what="`compare_models` of five models", against="warm `identify()`"),
)


def seconds_of(command: list[str], environment: Mapping[str, str]) -> float:
    """Return the CPU time of a program and its threads."""
    with Path(os.devnull).open("w") as nowhere:
        process = subprocess.Popen(command, stdout=nowhere, stderr=nowhere, env=environment)
        _, status, used = os.wait4(process.pid, 0)
        process.returncode = os.waitstatus_to_exitcode(status)
    if process.returncode:
        raise RuntimeError(f"{' '.join(command)} ended with {process.returncode}")
    return used.ru_utime + used.ru_stime


def _output(command: list[str], environment: Mapping[str, str]) -> str:
    done = subprocess.run(command, env=environment, stdout=subprocess.PIPE, text=True, check=True)
    return done.stdout


def measure(runs: int) -> dict[str, float]:
    """Return CPU seconds by name."""
    with tempfile.TemporaryDirectory() as folder:
        environment = {k: v for k, v in os.environ.items() if k != "PYTHONDONTWRITEBYTECODE"}
        environment |= {"PYTHONPYCACHEPREFIX": folder, "OPENBLAS_NUM_THREADS": "1"}
        path = Path(folder) / "run.csv"
        recording = jid.load(WELL_EXCITED)
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
            "`jointid identify run.csv --report page.html`": [
                *(python, "-m", "jointid", "identify", str(path)),
                *("--report", str(path.with_suffix(".html"))),
            ],
            "`jointid demo`": [python, "-m", "jointid", "demo", "--output", str(path.parent)],
        }
        found = dict.fromkeys(programs, float("inf"))
        for run in range(runs + 1):
            for name, command in programs.items():
                seconds = seconds_of(command, environment)
                if run:  # the first one compiles the bytecode
                    found[name] = min(found[name], seconds)
        command = [python, "-c", _CALLS, str(path)]
        calls = [json.loads(_output(command, environment)) for _ in range(runs // 4 + 2)]
        del calls[0]  # it compiled the bytecode
    for others in [each.pop("others") for each in calls]:
        if others:
            raise RuntimeError(f"{', '.join(others)} is imported")
    return found | {name: min(each[name] for each in calls) for name in calls[0]}


def main(runs: int, *, write: bool) -> None:
    """Measure, and publish the table."""
    seconds = measure(runs)
    rows = []
    for row in _ROWS:
        own, other = seconds[row.what], seconds[row.against]
        rows.append([row.what, f"{1e3 * own:.3g}", row.against, f"{own / other:.2f}"])
    publish(PART, rows, write=write, runs=runs)


if __name__ == "__main__":
    arguments = argparse.ArgumentParser(description=__doc__)
    arguments.add_argument("--runs", type=int, default=15, help="of each program (default 15)")
    arguments.add_argument("--write", action="store_true", help="write it into the page, too")
    options = arguments.parse_args()
    main(options.runs, write=options.write)
