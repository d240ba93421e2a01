"""Run under the failing library: a scenario of writing, once for each call and each fault, in a process of its own.

Prints a line for each fault after which a file is torn, something acknowledged is lost, or no sentence was said. The
last fault of a scenario is a loss of power behind its end.
"""

import ctypes
import errno
import os
import struct
import sys
import time
from collections.abc import Callable, Sequence
from functools import partial
from pathlib import Path
from tempfile import TemporaryDirectory
from threading import Timer

import designs
import numpy as np
from closed_loop import TRUTH

import jointid as jid
from jointid.hardware.session.recorder import COLUMNS, Recorder
from jointid.report.saving import save_report
from jointid.study.row import Row
from jointid.study.study_file import StudyFile
from write_faults import commands

Acknowledge = Callable[[], object]
_POWER = 99  # exit code of a process whose power failed
_FAULTS = (errno.ENOSPC, errno.EDQUOT, errno.EIO, 0)
_AFTER = -1  # the power fails behind the end
_MISSING = 1.0  # [s]: not more of a session is lost with the power
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


def _recorded(folder: Path, acknowledge: Callable[[bytes], object]) -> None:
    """A session that goes on while the power fails: each row's moment is acknowledged, 1,000 a second."""
    recorder = Recorder(folder / "run.csv", {"session": True})
    begin = time.monotonic()
    for number in range(5000):
        left = begin + 1e-3 * number - time.monotonic()
        if left > 0.0:
            time.sleep(left)
        recorder.sample([number * 1e-3, *[0.25 * number] * (len(COLUMNS) - 1)])
        acknowledge(struct.pack("d", time.monotonic()))


def _judged_recorded(folder: Path, known: Sequence[float]) -> str:
    """By the clock: where others use the machine, many rows come at once."""
    rows = max(0, (folder / "run.csv").read_text().count("\n") - 2)
    if rows < len(known) and known[-1] - known[rows] > _MISSING:
        return f"lost: {known[-1] - known[rows]:.2f} s, {rows} of {len(known)} rows are left"
    return "" if rows < 8 or len(jid.load(folder / "run.csv").time) == rows else "torn"


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
    "report": _whole("report.html", partial(save_report, _FIRST), partial(save_report, _SECOND)),
    "run": (_nothing, _ran, _judged_run),
    "sweep": (_nothing, _swept, _judged_study),
} | {f"command {name}": scenario for name, scenario in commands.SCENARIOS.items()}


def _faulted(name: str, call: int, number: int, library: ctypes.CDLL) -> tuple[int, str]:
    """How often the scenario calls (of a call above all: without a fault), and what is wrong."""
    prepare, act, judge = SCENARIOS[name]
    with TemporaryDirectory() as place:
        folder = Path(place).resolve() / "files"
        folder.mkdir()
        prepare(folder)
        reading, writing = os.pipe()
        child = os.fork()
        if child == 0:
            library.arm(os.fsencode(folder), ctypes.c_long(max(call, 0)), number)
            said = "0"
            try:
                act(folder, lambda: os.write(writing, b"+"))
            except (OSError, jid.InputError, commands.CommandError) as error:
                said = "1" if "\n" not in str(error) and str(error) else "2"
            except BaseException as error:
                os.write(2, f"{error!r}\n".encode())
                said = "2"
            calls = library.counted()
            if call == _AFTER:
                library.lose()
            os.write(writing, f" {said} {calls}".encode())
            os._exit(0)
        os.close(writing)
        with os.fdopen(reading) as stream:
            acknowledged, *rest = stream.read().split(" ")
        _, status = os.waitpid(child, 0)
        powerless = os.waitstatus_to_exitcode(status) == _POWER
        known = 0 if powerless and name == "sweep" and call != _AFTER else len(acknowledged)
        wrong = judge(folder, known)
        if not powerless and (not rest or rest[0] == "2"):
            wrong = wrong or "no sentence"
        if call == 0 and rest[:1] != ["0"]:
            wrong = wrong or "fails without a fault"
        left = [each.name for each in folder.iterdir() if each.name.startswith(".")]
        if left and not powerless:
            wrong = wrong or f"left behind: {left}"
        return int(rest[1]) if len(rest) > 1 else 0, wrong


def _interrupted(times: list[float], library: ctypes.CDLL) -> list[str]:
    """What is wrong after the power failed at some moments of a session."""
    said = []
    for moment in times:
        with TemporaryDirectory() as place:
            folder = Path(place).resolve() / "files"
            folder.mkdir()
            reading, writing = os.pipe()
            child = os.fork()
            if child == 0:
                library.arm(os.fsencode(folder), ctypes.c_long(0), 0)
                Timer(moment, library.lose).start()
                _recorded(folder, partial(os.write, writing))
                os._exit(0)
            os.close(writing)
            with os.fdopen(reading, "rb") as stream:
                known = [each[0] for each in struct.iter_unpack("d", stream.read())]
            _, status = os.waitpid(child, 0)
            wrong = _judged_recorded(folder, known)
            if os.waitstatus_to_exitcode(status) != _POWER:
                wrong = wrong or "the power did not fail"
            if wrong:
                said.append(f"power after {moment:g} s: {wrong}\n")
    return said


def main(name: str, path: str, most: str = "0") -> None:
    """Calls of a scenario, all or about `most` of them, with each fault."""
    library = ctypes.CDLL(path)
    if name == "session":
        times = [0.7, 1.3, 2.1, 3.4] if int(most) else list(np.arange(0.3, 4.4, 0.1))
        sys.stdout.writelines(_interrupted(times, library))
        sys.stdout.write(f"{len(times)} faults\n")
        return
    # Twice: a first run of a command may make what later ones find.
    (_, _), (total, failed) = (_faulted(name, 0, 0, library) for _ in range(2))
    if failed:
        sys.stdout.write(f"{failed}\n")
    chosen = range(1, total + 1)
    if 0 < int(most) < total:
        chosen = sorted({1 + (total - 1) * k // (int(most) - 1) for k in range(int(most))})  # type: ignore[assignment]
    faults = [(call, number) for call in chosen for number in _FAULTS]
    for call, number in [*faults, (_AFTER, 0)]:
        _, wrong = _faulted(name, call, number, library)
        if wrong:
            said = errno.errorcode.get(number, "power")
            sys.stdout.write(f"call {call} of {total}, {said}: {wrong}\n")
    sys.stdout.write(f"{len(faults) + 1} faults\n")


if __name__ == "__main__":
    main(*sys.argv[1:])
