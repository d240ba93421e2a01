"""Whole commands under the failing library: what they leave is whole, and a failure is said in a sentence."""

import atexit
import functools
import os
import shutil
import sys
import tempfile
from collections.abc import Sequence
from pathlib import Path

import designs
import small_arm
from closed_loop import TRUTH
from simulated_servo import bench_runs, servo_joint

import jointid as jid
from jointid.cli.command_line import main
from write_faults import whole_files
from write_faults.savers import long_run
from write_faults.scenario import Acknowledge, Scenario

_EXAMPLES = Path(__file__).resolve().parents[2] / "examples"
# A session of 1.5 s: the rows of longer ones are written no other way.
_SHORT = ("duration = 12.0 ", "duration = 1.5 ")
_EDITED = "# by hand\n"  # what a file that is edited has to keep


class CommandError(Exception):
    """A command failed, and said why."""


@functools.cache
def _given() -> Path:
    """What the commands read; it lies elsewhere than what they write."""
    folder = Path(tempfile.mkdtemp(prefix="given-"))
    atexit.register(shutil.rmtree, folder)
    run = long_run()
    run.save(folder / "run.npz")
    jid.identify(run, model="coulomb_viscous", search="separable").save(folder / "estimate.json")
    joint = folder / "joint.toml"
    jid.thesis_joint().with_parameters(TRUTH).save(joint)
    joint.write_text(_EDITED + joint.read_text())
    small_arm.urdf(folder)
    (folder / "design.toml").write_text(designs.bench_text())
    bench = (_EXAMPLES / "hardware" / "joint.toml").read_text()
    assert bench.count(_SHORT[0]) == 1
    (folder / "bench.toml").write_text(bench.replace(*_SHORT))
    (folder / "runs").mkdir()
    for number, each in enumerate(bench_runs(runs=8)):
        each.save(folder / "runs" / f"run{number}.csv")
    servo_joint().save(folder / "servo.toml")
    return folder


_ONE = ("--model", "coulomb_viscous", "--method", "separable", "--threads", "1")
_MODEL = (*_ONE, "--quiet")
_SWEEP = (
    *("sweep", "@run.npz", *_MODEL, "--workers", "1", "--grid", "windows=50,60,70"),
    *("--trials", "4", "--output", "study.jsonl"),
)
_DESIGN = (
    *("design", "@design.toml", "--evaluations", "64", "--rehearsals", "10"),
    *("--joints", "2", "--threads", "1", "--quiet", "--output", "motion.toml"),
)
# A word that begins with @ is a file that the command reads; one with + is one that it also writes.
COMMANDS: dict[str, tuple[str, ...]] = {
    "identify": (
        *("identify", "@run.npz", *_MODEL),
        *("--report", "report.html", "--save", "estimate.json"),
    ),
    "long identify": (
        *("identify", "@run.npz", "--model", "coulomb_viscous", "--threads", "1", "--quiet"),
        *("--population", "8", "--generations", "6", "--checkpoint", "search.state"),
        *("--save", "+joint.toml"),
    ),
    "identify servo": (
        *("identify", "@runs", "--joint", "@servo.toml", "--quiet"),
        *("--report", "report.html", "--save", "estimate.json"),
    ),
    "compare": (
        *("compare", "@run.npz", "--model", "coulomb_viscous", "--threads", "1"),
        *("--quiet", "--report", "report.html", "--save", "estimate.json"),
    ),
    "report": ("report", "@estimate.json", "--output", "report.html"),
    "new": ("new", "joint.toml", "@run.npz", "--gear-ratio", "101", "--no-questions"),
    "demo": ("demo", "--output", "demo"),
    "sweep": (*_SWEEP, "--table", "table.csv"),
    "sweep drawn": (
        *(*_SWEEP, "--table", "table.parquet"),
        *("--plot", "study.png", "--report", "report.html"),
    ),
    "design": _DESIGN,
    "design drawn": (*_DESIGN, "--plot", "motion.svg", "--report", "report.html"),
    "simulate": (
        *("simulate", "@joint.toml", "--trajectory", "thesis:duration=1"),
        *("--output", "simulated.npz"),
    ),
    "export": ("export", "@estimate.json", "--to", "joint.xml"),
    "export into": (
        *("export", "@estimate.json", "--to", "+small.urdf", "--into", "+small.urdf"),
        *("--joint-name", "elbow"),
    ),
    "run": ("run", "@bench.toml", "--emulate", "--cycles", "0", "--quiet", "--output", "."),
    "run and identify": (
        *("run", "@bench.toml", "--emulate", "--cycles", "1", "--threads", "1", "--quiet"),
        *("--output", "ring", "--save", "identified.toml"),
    ),
}


def command(words: Sequence[str]) -> Scenario:
    """A command line; when it ends well, all files that it ends with have been acknowledged."""
    complete: set[Path] = set()

    def prepare(folder: Path) -> None:
        _given()
        for name in {word[1:] for word in words if word[0] == "+"}:
            shutil.copy(_given() / name, folder)

    def act(folder: Path, acknowledge: Acknowledge) -> None:
        os.chdir(folder)
        line = [str(_given() / word[1:]) if word[0] == "@" else word.lstrip("+") for word in words]
        heard = os.dup(2)
        with tempfile.TemporaryFile("w+") as said:
            os.dup2(said.fileno(), 1)
            os.dup2(said.fileno(), 2)
            try:
                code = main(line)
            finally:
                os.dup2(heard, 2)
            sys.stdout.flush()
            sys.stderr.flush()
            said.seek(0)
            text = said.read()
        if code == 0:
            acknowledge()
            return
        if code not in (2, 3) or "Traceback" in text or f"jointid {words[0]}: " not in text:
            raise RuntimeError(text)
        raise CommandError(text.strip().splitlines()[-1])

    def judged(folder: Path, known: int) -> str:
        found = {path.relative_to(folder) for path in folder.rglob("[!.]*") if path.is_file()}
        for path in sorted(found):
            torn = whole_files.fault(folder / path)
            if torn:
                return f"{path}: {torn}"
        for name in {word[1:] for word in words if word[0] == "+"}:
            if not (folder / name).is_file():
                return f"{name} is gone"
            if name == "joint.toml" and _EDITED not in (folder / name).read_text():
                return f"{name} has lost what was in it"
        if not complete and known:
            complete.update(found)
        missing = sorted(map(str, complete - found))
        return f"lost: {missing}" if known and missing else ""

    return Scenario(prepare, act, judged)


SCENARIOS = {f"command {name}": command(words) for name, words in COMMANDS.items()}
