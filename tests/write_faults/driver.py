"""Run under the failing library: a scenario of writing, once for each call and each fault, in a process of its own.

Prints a line for each fault after which a file is torn, something acknowledged is lost, or no sentence was said.
"""

import ctypes
import errno
import os
import sys
from collections.abc import Callable
from pathlib import Path
from tempfile import TemporaryDirectory

import designs
import numpy as np
from closed_loop import TRUTH

import jointid as jid
from jointid.hardware.session.recorder import COLUMNS, Recorder
from jointid.study.row import Row
from jointid.study.study_file import StudyFile

Acknowledge = Callable[[], object]
_POWER = 99  # exit code of a process whose power failed
_TIME = np.arange(20) * 1e-3
_OLD = jid.Recording(time=_TIME, position=np.sin(_TIME), torque=np.cos(_TIME))
_NEW = jid.Recording(time=_TIME, position=np.sin(2.0 * _TIME), torque=np.cos(_TIME))
_HEADER = {
    "format": "jointid-study",
    "schema": 1,
    "version": "0.1.0",
    "swept": ["windows"],
    "cells": [{"windows": 50}],
    "seed": 0,
    "settings": {},
    "fingerprint": "abc",
    "trials": 100,
    "truth": {},
    "truths": [],
}
_ROWS = [
    Row(cell=0, trial=k, seed=k, status="converged", penalty=1.5, values={"coulomb": 2.0 + k})
    for k in range(100)
]


def _whole(
    name: str, first: Callable[[Path], object], second: Callable[[Path], object]
) -> tuple[
    Callable[[Path], object], Callable[[Path, Acknowledge], None], Callable[[Path, int], str]
]:
    """A file that is replaced: it is the old one or the new one, and the new one when that was said."""
    with TemporaryDirectory() as folder:
        path = Path(folder) / name
        contents = []
        for write in (first, second):
            write(path)
            contents.append(path.read_bytes())

    def save(folder: Path, acknowledge: Acknowledge) -> None:
        second(folder / name)
        acknowledge()

    def judged(folder: Path, known: int) -> str:
        found = (folder / name).read_bytes()
        if found not in contents:
            return "torn"
        return "lost" if known and found != contents[1] else ""

    return lambda folder: (folder / name).write_bytes(contents[0]), save, judged


def _nothing(_: Path) -> None:
    """No file is there before."""


def _swept(folder: Path, acknowledge: Acknowledge) -> None:
    with StudyFile(folder / "study.jsonl", _HEADER, resume=False) as file:
        for row in _ROWS:
            file.append([row])
            acknowledge()


def _judged_study(folder: Path, known: int) -> str:
    path = folder / "study.jsonl"
    if not path.exists() or not path.stat().st_size:
        return "lost" if known else ""
    try:
        with StudyFile(path, _HEADER, resume=True) as file:
            return "lost" if len(file.rows) < known else ""
    except jid.InputError as error:
        return "" if "no whole line" in str(error) and not known else f"torn: {error}"


def _ran(folder: Path, acknowledge: Acknowledge) -> None:
    """Rows are acknowledged by the end of `close`."""
    recorder = Recorder(folder / "run.csv", {"session": True})
    for number in range(20):
        recorder.sample([number * 1e-3, *[0.25 * number] * (len(COLUMNS) - 1)])
        recorder.frame(number * 1e-3, 0x181, bytes(8), sent=False)
    recorder.close({"stop": None})
    for _ in range(20):
        acknowledge()


def _judged_run(folder: Path, known: int) -> str:
    path = folder / "run.csv"
    if not path.exists() or not path.stat().st_size:
        return "lost" if known else ""
    try:
        return "lost" if len(jid.load(path).time) < known else ""
    except jid.InputError as error:
        said = str(error)
        return "" if not known and "\n" not in said and path.name in said else f"torn: {said}"


_JOINT = jid.thesis_joint()
_FIRST, _SECOND = (
    jid.Estimate.load(
        Path(__file__).resolve().parents[1] / "estimate" / f"estimate_schema_{k}.json"
    )
    for k in (1, 2)
)
_DESIGN = designs.designed()
SCENARIOS = {
    "recording": _whole("run.npz", _OLD.save, _NEW.save),
    "joint": _whole("joint.toml", _JOINT.save, _JOINT.with_parameters(TRUTH).save),
    "design": _whole("design.toml", _DESIGN.save, designs.designed(seed=7).save),
    "estimate": _whole("estimate.json", _FIRST.save, _SECOND.save),
    "run": (_nothing, _ran, _judged_run),
    "sweep": (_nothing, _swept, _judged_study),
}


def _faulted(name: str, call: int, number: int, library: ctypes.CDLL) -> tuple[int, str]:
    """How often the scenario calls (of a call above all: without a fault), and what is wrong."""
    prepare, act, judge = SCENARIOS[name]
    with TemporaryDirectory() as place:
        folder = Path(place).resolve()
        prepare(folder)
        reading, writing = os.pipe()
        child = os.fork()
        if child == 0:
            library.arm(os.fsencode(folder), ctypes.c_long(call), number)
            said = "0"
            try:
                act(folder, lambda: os.write(writing, b"+"))
            except (OSError, jid.InputError) as error:
                said = "1" if "\n" not in str(error) and str(error) else "2"
            except BaseException:
                said = "2"
            os.write(writing, f" {said} {library.counted()}".encode())
            os._exit(0)
        os.close(writing)
        with os.fdopen(reading) as stream:
            acknowledged, *rest = stream.read().split(" ")
        _, status = os.waitpid(child, 0)
        powerless = os.waitstatus_to_exitcode(status) == _POWER
        known = 0 if powerless and name == "sweep" else len(acknowledged)
        wrong = judge(folder, known)
        if not powerless and (not rest or rest[0] == "2"):
            wrong = wrong or "no sentence"
        left = [each.name for each in folder.iterdir() if each.name.startswith(".")]
        if left and not powerless:
            wrong = wrong or f"left behind: {left}"
        return int(rest[1]) if len(rest) > 1 else 0, wrong


def main(name: str, path: str) -> None:
    """Each call of a scenario, with each fault."""
    library = ctypes.CDLL(path)
    total, _ = _faulted(name, 0, 0, library)
    faults = 0
    for call in range(1, total + 1):
        for number in (errno.ENOSPC, errno.EIO, 0):
            faults += 1
            _, wrong = _faulted(name, call, number, library)
            if wrong:
                said = errno.errorcode.get(number, "power")
                sys.stdout.write(f"call {call} of {total}, {said}: {wrong}\n")
    sys.stdout.write(f"{faults} faults\n")


if __name__ == "__main__":
    main(*sys.argv[1:])
