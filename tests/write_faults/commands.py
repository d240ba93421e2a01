"""Whole commands under the failing library: what they leave is whole, and a failure is said in a sentence."""

import atexit
import functools
import json
import os
import shutil
import sys
import tempfile
import tomllib
from collections.abc import Callable, Sequence
from pathlib import Path
from xml.etree import ElementTree

import designs
import numpy as np
from closed_loop import TRUTH

import jointid as jid
from jointid.cli.command_line import main
from jointid.study.study_file import read

Acknowledge = Callable[[], object]
_EXAMPLES = Path(__file__).resolve().parents[2] / "examples"
# A session of 1.5 s: the rows of longer ones are written no other way.
_SHORT = ("duration = 12.0 ", "duration = 1.5 ")


class CommandError(Exception):
    """A command failed, and said why."""


def _recording(folder: Path) -> None:
    """A recording of a simple joint."""
    time = np.arange(3000) * 1e-3
    velocity = np.cos(5.0 * time) + 0.3 * np.cos(17.0 * time)
    jid.Recording(
        time=time,
        position=np.sin(5.0 * time) / 5.0 + 0.3 / 17.0 * np.sin(17.0 * time),
        velocity=velocity,
        torque=-5.0 * np.sin(5.0 * time) + 20.0 * velocity + 5.0 * np.sign(velocity),
    ).save(folder / "run.npz")


@functools.cache
def _given() -> Path:
    """What the commands read; it lies elsewhere than what they write."""
    folder = Path(tempfile.mkdtemp(prefix="given-"))
    atexit.register(shutil.rmtree, folder)
    _recording(folder)
    run = jid.load(folder / "run.npz")
    jid.identify(run, model="coulomb_viscous", search="separable").save(folder / "estimate.json")
    jid.thesis_joint().with_parameters(TRUTH).save(folder / "joint.toml")
    (folder / "design.toml").write_text(designs.bench_text())
    bench = (_EXAMPLES / "hardware" / "joint.toml").read_text()
    assert bench.count(_SHORT[0]) == 1
    (folder / "bench.toml").write_text(bench.replace(*_SHORT))
    return folder


_MODEL = ("--model", "coulomb_viscous", "--method", "separable", "--threads", "1", "--quiet")
COMMANDS: dict[str, tuple[str, ...]] = {
    "identify": (
        "identify",
        "run.npz",
        *_MODEL,
        "--report",
        "report.html",
        "--save",
        "estimate.json",
    ),
    "report": ("report", "estimate.json", "--output", "report.html"),
    "sweep": (
        *(
            "sweep",
            "run.npz",
            "--model",
            "coulomb_viscous",
            "--method",
            "separable",
            "--threads",
            "1",
        ),
        *("--workers", "1", "--grid", "windows=50,60,70", "--trials", "4", "--quiet"),
        *("--output", "study.jsonl", "--table", "table.csv"),
    ),
    "design": (
        *("design", "design.toml", "--evaluations", "64", "--rehearsals", "10"),
        *("--joints", "2", "--threads", "1", "--quiet", "--output", "motion.toml"),
    ),
    "simulate": (
        *("simulate", "joint.toml", "--trajectory", "thesis:duration=1"),
        *("--output", "simulated.npz"),
    ),
    "export": ("export", "estimate.json", "--to", "joint.xml"),
    "run": (
        *("run", "bench.toml", "--emulate", "--cycles", "0", "--quiet"),
        *("--output", "."),
    ),
}


def command(
    words: Sequence[str],
) -> tuple[
    Callable[[Path], object], Callable[[Path, Acknowledge], None], Callable[[Path, int], str]
]:
    """A command line; when it ends well, all files that it ends with have been acknowledged."""
    complete: set[str] = set()

    def act(folder: Path, acknowledge: Acknowledge) -> None:
        os.chdir(folder)
        with tempfile.TemporaryFile("w+") as said:
            os.dup2(said.fileno(), 1)
            os.dup2(said.fileno(), 2)
            first, given, *rest = words
            code = main([first, str(_given() / given), *rest])
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
        found = {path.name for path in folder.iterdir() if not path.name.startswith(".")}
        for path in sorted(folder.iterdir()):
            if not path.name.startswith("."):
                torn = _torn(path)
                if torn:
                    return f"{path.name}: {torn}"
        if not complete and known:
            complete.update(found)
        return f"lost: {sorted(complete - found)}" if known and complete - found else ""

    return lambda _: _given(), act, judged


def _torn(path: Path) -> str:
    """Why a file is none that its reader takes; of a session or a study also what it says of a short one."""
    content = path.read_bytes()
    try:
        if path.suffix == ".html":
            return "" if content.rstrip().endswith(b"</html>") else "torn"
        if path.suffix == ".json":
            json.loads(content)
        elif path.suffix == ".toml":
            tomllib.loads(content.decode())
        elif path.suffix == ".xml":
            ElementTree.fromstring(content)
        elif path.suffix == ".jsonl":
            read(path)
        elif path.suffix in (".csv", ".npz") and path.name != "table.csv":
            jid.load(path)
    except jid.InputError as error:
        return "" if "\n" not in str(error) and path.name in str(error) else f"torn: {error}"
    except (ValueError, ElementTree.ParseError) as error:
        return f"torn: {error}"
    return ""


SCENARIOS = {name: command(words) for name, words in COMMANDS.items()}
