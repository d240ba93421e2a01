"""What writes files from Python: each saver replaces a file, a study and a session grow."""

import functools
from collections.abc import Callable
from functools import partial
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import designs
import numpy as np
from closed_loop import TRUTH
from read_back.registry import EXAMPLES

import jointid as jid
from jointid.hardware.proof.certificate import Certificate
from jointid.hardware.session.recorder import COLUMNS, Recorder
from jointid.report.saving import save_report
from jointid.study.row import Row
from jointid.study.study_file import StudyFile
from write_faults.scenario import Acknowledge, Scenario

_TIME = np.arange(20) * 1e-3
_OLD = b"what stood there before\n"
_HEADER = {
    "format": "jointid-study",
    "schema": 1,
    "version": "0.1.0",
    "swept": ["windows"],
    "cells": [{"windows": 50}],
    "seed": 0,
    "settings": {},
    "fingerprint": "abc",
    "trials": 40,
    "truth": {},
    "truths": [],
}
_ROWS = [
    Row(cell=0, trial=k, seed=k, status="converged", penalty=1.5, values={"coulomb": 2.0 + k})
    for k in range(40)
]


def _whole(name: str, saver: Callable[[], Callable[[Path], object]], old: bytes = _OLD) -> Scenario:
    """A file that is replaced: it is the old one or the new one, and the new one when that was said."""

    @functools.cache
    def save() -> Callable[[Path], object]:
        return saver()

    @functools.cache
    def new() -> bytes:
        with TemporaryDirectory() as folder:
            path = Path(folder) / name
            path.write_bytes(old)
            save()(path)
            return path.read_bytes()

    def prepare(folder: Path) -> None:
        new()
        (folder / name).write_bytes(old)

    def act(folder: Path, acknowledge: Acknowledge) -> None:
        save()(folder / name)
        acknowledge()

    def judged(folder: Path, known: int) -> str:
        found = (folder / name).read_bytes()
        if found not in (old, new()):
            return "torn"
        return "lost" if known and found != new() else ""

    return Scenario(prepare, act, judged)


def _run() -> jid.Recording:
    return jid.Recording(time=_TIME, position=np.sin(2.0 * _TIME), torque=np.cos(_TIME))


def _robot_run() -> jid.RobotRecording:
    pair = np.column_stack([np.sin(_TIME), np.cos(_TIME)])
    return jid.RobotRecording(
        time=_TIME, position=pair, torque=pair, names=("a", "b"), gear_ratio=(10.0, -20.0)
    )


@functools.cache
def _read(name: str) -> Any:
    """What a valid example of a file holds."""
    example = EXAMPLES[name]()
    with TemporaryDirectory() as folder:
        path = Path(folder) / example.name
        path.write_text(example.text(), encoding="utf-8")
        for other, content in example.beside.items():
            (path.parent / other).write_bytes(content)
        return _READERS[name](path)


_READERS: dict[str, Callable[[Path], Any]] = {
    "estimate": jid.Estimate.load,
    "servo": jid.ServoEstimate.load,
    "robot": jid.RobotEstimate.load,
    "certificate": Certificate.load,
    "study": jid.Study.load,
}


def _saver(name: str) -> Callable[[Path], object]:
    save: Callable[[Path], object] = _read(name).save
    return save


def _joints() -> Callable[[Path], object]:
    run = long_run()
    assert run.velocity is not None
    assert run.torque is not None
    several = jid.RobotRecording(
        time=run.time,
        position=np.column_stack([run.position, run.position]),
        velocity=np.column_stack([run.velocity, run.velocity]),
        torque=np.column_stack([run.torque, run.torque]),
        names=("a", "b"),
    )
    found = jid.identify_joints(several, model="coulomb_viscous", search="separable")
    return found.save


def long_run() -> jid.Recording:
    """A recording of a simple joint."""
    time = np.arange(3000) * 1e-3
    velocity = np.cos(5.0 * time) + 0.3 * np.cos(17.0 * time)
    return jid.Recording(
        time=time,
        position=np.sin(5.0 * time) / 5.0 + 0.3 / 17.0 * np.sin(17.0 * time),
        velocity=velocity,
        torque=-5.0 * np.sin(5.0 * time) + 20.0 * velocity + 5.0 * np.sign(velocity),
    )


@functools.cache
def _searched() -> Callable[[Path], object]:
    """A search that keeps its state: after some generations, and at its end."""
    run = long_run()
    ga = jid.GaOptions(population=8, generations=4)
    return lambda path: jid.identify(
        run,
        model="coulomb_viscous",
        windows=12,
        search=jid.Search(ga=ga, threads=1, checkpoint=str(path)),
    )


def _swept(folder: Path, acknowledge: Acknowledge) -> None:
    with StudyFile(folder / "study.jsonl", _HEADER, resume=False) as file:
        for row in _ROWS:
            file.append([row])
            acknowledge()


def _begun(folder: Path) -> None:
    """A study that a crash cut off in the middle of a row."""
    with StudyFile(folder / "study.jsonl", _HEADER, resume=False) as file:
        file.append(_ROWS[:10])
    with (folder / "study.jsonl").open("ab") as stream:
        stream.write(b'{"cell": 0, "trial": 10, "se')


def _resumed(folder: Path, acknowledge: Acknowledge) -> None:
    """The ten rows that were there count as acknowledged."""
    for _ in range(10):
        acknowledge()
    with StudyFile(folder / "study.jsonl", _HEADER, resume=True) as file:
        for row in _ROWS[10:20]:
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
        return "" if "no complete line" in str(error) and not known else f"torn: {error}"


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


def _nothing(_: Path) -> None:
    """No file is there before."""


def _exported() -> Callable[[Path], object]:
    joint = jid.thesis_joint().with_parameters(TRUTH)
    return lambda path: jid.export(joint, path, approximate=True, speed=1.0)


SAVERS = {
    "recording": _whole("run.npz", lambda: _run().save),
    "recording text": _whole("run.csv.gz", lambda: _run().save),
    "robot recording": _whole("arm.csv", lambda: _robot_run().save),
    "joint": _whole(
        "joint.toml",
        lambda: jid.thesis_joint().with_parameters(TRUTH).save,
        b"# by hand\nschema = 2\n",
    ),
    "design": _whole("design.toml", lambda: designs.designed().save),
    "estimate": _whole("estimate.json", lambda: _saver("estimate")),
    "joints": _whole("several.json", _joints),
    "robot": _whole("robot.json", lambda: _saver("robot")),
    "servo": _whole("servo.json", lambda: _saver("servo")),
    "certificate": _whole("joint.certificate.toml", lambda: _saver("certificate")),
    "study table": _whole("table.csv", lambda: _saver("study")),
    "study": _whole("study.jsonl", lambda: _saver("study")),
    "report": _whole("report.html", lambda: partial(save_report, _read("estimate"))),
    "model": _whole("joint.xml", _exported),
    "header": _whole("joint.h", _exported),
    "run": Scenario(_nothing, _ran, _judged_run),
    "sweep": Scenario(_nothing, _swept, _judged_study, synced=False),
    "resumed sweep": Scenario(_begun, _resumed, _judged_study, synced=False, before=10),
}
