"""Every file that jointid reads back, with what writes it and who reads it."""

import json
import tomllib
from collections.abc import Callable
from dataclasses import replace
from functools import cache
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np
from designs import designed

import jointid as jid
from jointid.base.result import KeptResult
from jointid.cli.demonstration import data_folder
from jointid.hardware import Bench, EmulatedBus, Session, emulated_devices
from jointid.hardware.elmo import ElmoDrive
from jointid.hardware.proof.certificate import Certificate
from jointid.hardware.proof.result import FirstMotion
from jointid.hardware.session.watchdog import Watchdog
from jointid.joints.reading import load_estimate
from jointid.recording.file_remarks import remarks
from jointid.robot.links.facts import read_facts
from jointid.simulation.motion_file import load_motion
from jointid.study import study_file
from jointid.study.row import Row
from read_back.example import Example

SAVED = Path(__file__).resolve().parents[1] / "data" / "saved_results"
_BENCH = Path(__file__).resolve().parents[2] / "examples" / "hardware" / "joint.toml"
_CELL = {"windows": 50}
_HEADER: dict[str, Any] = {
    "format": "jointid-study",
    "schema": 1,
    "version": "0.1.0",
    "swept": ["windows"],
    "cells": [_CELL, {"windows": 100}],
    "seed": 0,
    "settings": {"version": "0.1.0", "joint": "Joint()", "bounds": [0.0, [1.0]]},
    "fingerprint": "abc",
    "trials": 2,
    "truth": {"coulomb": 2.0},
    "truths": [{"coulomb": 2.0}, {"coulomb": 2.0}],
}


def _joint() -> Example:
    text = (data_folder() / "kr300_joint1.toml").read_text(encoding="utf-8")
    return Example(
        name="joint.toml",
        documents=[tomllib.loads(text) | {"tolerances": {"inertia": "5 %"}}],
        use=lambda path: jid.Joint.load(path).save(path.with_name("again.toml")),
        modules=["joint.joint_file"],
    )


def _bench() -> Example:
    return Example(
        name="bench.toml",
        documents=[tomllib.loads(_BENCH.read_text(encoding="utf-8"))],
        use=Bench.load,
        modules=["joint.joint_file", "hardware.bench.bench_file", "hardware.bench.table"],
    )


def _motion(name: str, use: Callable[[Path], object], module: str) -> Example:
    return Example(
        name=name,
        documents=[designed(believed={"coulomb": (20.0, 30.0)}).to_dict()],
        use=use,
        modules=[module, "base.toml_file"],
        elsewhere=("joint",),
    )


def _certificate() -> Example:
    bench = Bench.load(_BENCH)
    identity = {"drive": "Elmo SimplIQ", "node": 127, "serial": "1959", "peak_current": 8.0}
    passed = FirstMotion(
        passed=True,
        travel=0.005,
        breakaway=(45.7, 44.9),
        inertia=2.8,
        identity=identity,
        drive_watchdog=Watchdog(time=0.05, fed_by="heartbeat", then="off", read_back=True),
    )
    with TemporaryDirectory() as folder:
        path = Path(folder) / "joint.certificate.toml"
        Certificate.of(bench, passed).save(path)
        document = tomllib.loads(path.read_text(encoding="utf-8"))

    def use(path: Path) -> None:
        read = Certificate.load(path)
        "".join([*read.objections(bench, identity), *read.notes(bench, identity)])

    return Example(
        name="joint.certificate.toml",
        documents=[document],
        use=use,
        modules=["hardware.proof.certificate", "hardware.proof.certified_limits"],
    )


def _facts() -> Example:
    facts = {
        "joints": ["shoulder", "elbow"],
        "gear_ratios": [32.0, -45.0],
        "couplings": {"elbow": {"shoulder": 0.5}},
        "rotor_inertias": ["free", 0.2],
        "zero_offsets_deg": [0.0, 90.0],
        "gravity": [0.0, 0.0, -9.81],
        "side": "motor",
        "torque_scales": [1.0, -1.0],
        "directions": [1, -1],
    }

    def use(path: Path) -> None:
        from small_arm import urdf  # needs pinocchio

        jid.Robot.from_urdf(urdf(path.parent), facts=path)

    return Example(
        name="robot.toml",
        documents=[facts],
        use=use if _has_pinocchio() else read_facts,
        modules=["robot.links.facts"],
    )


@cache
def _estimate() -> dict[str, Any]:
    run = jid.load(data_folder() / "kr300_joint1.csv.gz")
    joint = jid.Joint.load(data_folder() / "kr300_joint1.toml")
    ga = jid.GaOptions(population=20, generations=3)
    found = jid.identify(run, joint, model="stribeck", windows=12, search=jid.Search(ga=ga))
    return dict(json.loads(found.to_json()))


def _saved_estimate() -> Example:
    return Example(
        name="estimate.json",
        documents=[_estimate()],
        use=jid.Estimate.load,  # pages of it: tests/estimate/test_saved_estimates.py
        modules=["estimate.estimate", "estimate.json", "base.schema"],
    )


def _several() -> Example:
    one: dict[str, Any] = {
        "status": "identified",
        "error": None,
        "side": "joint",
        "explained_by_others": 0.0,
    }
    one |= {"others": [], "sentences": [], "estimate": {"schema": 3}}

    def use(path: Path) -> None:
        for name in ("3", None):
            load_estimate(path, name)

    return Example(
        name="several.json",
        documents=[  # the estimate inside has its own example
            {
                "schema": 1,
                "kind": "jointid joints",
                "name": "arm",
                "seconds": 1.0,
                "joints": {"3": one | {"estimate": _estimate()}},
            }
        ],
        use=use,
        modules=["joints.reading", "estimate.json"],
        elsewhere=("joints", "3", "estimate"),
    )


def _saved(
    name: str, kind: type[jid.Result], modules: list[str], elsewhere: tuple[str, ...] = ()
) -> Example:
    """A result as it was saved once; its estimate has an example of its own."""
    return Example(
        name=name,
        documents=[_document(name)],
        use=lambda path: _shown(kind, path),
        modules=[*modules, "base.result", "base.schema"],
        elsewhere=elsewhere,
    )


def _document(name: str) -> dict[str, Any]:
    return dict(json.loads((SAVED / name).read_text(encoding="utf-8")))


def _shown(kind: type[jid.Result], path: Path) -> None:
    found = kind.load(path)
    assert isinstance(found, KeptResult)
    found.report()
    found.report(verbose=True)
    found.overview.title.encode()
    found.to_json()


def _servo_comparison() -> Example:
    from jointid.servo.comparison_reading import KIND, SCHEMA

    document = {
        "schema": SCHEMA,
        "kind": KIND,
        "best": "b",
        "models": ["a", "b"],
        "runs": ["one", "two"],
        "groups": ["10", "20"],
        "errors": [[0.1, 0.2], [0.01, 0.02]],
        "bistable": [[False, True], [False, False]],
        "estimate": _document("servo.json"),
    }
    return Example(
        name="servo_comparison.json",
        documents=[document],
        use=lambda path: _shown(jid.ServoComparison, path),
        modules=["servo.comparison_result", "servo.comparison_reading"],
        elsewhere=("estimate",),
    )


def _design_as_json() -> Example:
    return Example(
        name="design.json",
        documents=[designed(believed={"coulomb": (20.0, 30.0)}).to_dict()],
        use=lambda path: _shown(jid.Design, path),
        modules=["excitation.design", "excitation.design_file"],
        elsewhere=("joint",),
    )


def _study_as_json() -> Example:
    return Example(
        name="study.json",
        documents=[jid.Study.load(SAVED / "study.jsonl").to_dict()],
        use=lambda path: _shown(jid.Study, path),
        modules=["study.study_result", "study.reading_back", "study.row"],
    )


def _any_kind() -> Example:
    """A file of which nobody says what it holds."""
    return Example(
        name="any.json",
        documents=[_document("servo.json")],
        use=jid.Result.load,
        modules=["verbs.result_kinds", "servo.reading_back"],
        elsewhere=("joint",),
    )


def _robot() -> Example:
    from small_arm import recording, urdf

    with TemporaryDirectory() as folder:
        path = urdf(Path(folder))
        run = recording(path, static=0.5, duration=3.0)
        robot = jid.Robot.from_urdf(path)
        found = jid.identify_robot(run, robot, inertia="free", model="coulomb_viscous", windows=20)
    return Example(
        name="robot.json",
        documents=[json.loads(found.to_json())],
        use=jid.RobotEstimate.load,
        modules=["robot.result.result", "robot.result.reading_back"],
    )


def _servo() -> Example:
    from simulated_servo import bench_runs, servo_joint

    found = jid.identify_servo(bench_runs(runs=8), servo_joint())

    def use(path: Path) -> None:
        read = jid.ServoEstimate.load(path)
        read.report()
        read.to_json()
        read.identified.save(path.with_name("again.toml"))

    return Example(
        name="servo.json",
        documents=[json.loads(found.to_json())],
        use=use,
        modules=["servo.estimate", "servo.reading_back"],
        elsewhere=("joint",),
    )


def _study(use: Callable[[Path], object], name: str) -> Example:
    values = {"coulomb": 2.0}
    rows = [
        Row(cell=0, trial=k, seed=k, status="converged", penalty=1.5, values=values).asdict()
        for k in range(2)
    ]
    rows.append(Row(cell=1, trial=0, seed=0, status="refused", message="too few").asdict())
    return Example(
        name=name, documents=[_HEADER, *rows], use=use, modules=["study.study_file", "study.row"]
    )


def _read_study(path: Path) -> None:
    study = jid.Study.load(path)
    str(study)
    study.summary().asdict()


def _resumed(path: Path) -> None:
    with study_file.StudyFile(path, _HEADER, resume=True):
        pass


def _recording() -> Example:
    time = np.arange(8) * 1e-3
    run = jid.Recording(
        time=time,
        position=np.sin(time),
        torque=np.cos(time),
        metadata={"assumed_units": {"torque": "Nm"}, "left_out": {"a": "b"}},
        extra={"mass": time},
    )
    return _text_table("recording.csv", run.save, _read_recording, ["recording.saved"])


def _robot_recording() -> Example:
    time = np.arange(8) * 1e-3
    pair = np.column_stack([np.sin(time), np.cos(time)])
    run = jid.RobotRecording(
        time=time, position=pair, torque=pair, names=("a", "b"), gear_ratio=(10.0, -20.0)
    )
    modules = ["recording.saved", "recording.wide.reading_back"]
    return _text_table("arm.csv", run.save, jid.load_robot, modules)


def _read_recording(path: Path) -> None:
    run = jid.load(path)
    remarks(run.metadata)
    run.save(path.with_name("again.csv"))


def _session() -> Example:
    """A session's file and its frame log, from an emulated drive; slow cycles, of which few are on the way there."""
    bench = replace(Bench.load(_BENCH), trajectory=jid.Trajectory.sine(5e-4, 10.0, duration=0.1))
    with TemporaryDirectory() as folder, EmulatedBus(*emulated_devices(bench, seed=1)) as bus:
        path = Path(folder) / "run.csv"
        Session(
            ElmoDrive(bus, bench.joint, bench.drive),
            bench.controller,
            bench.trajectory,
            bench.limits,
            options=replace(bench.options, settle=0.0, period=0.01),
            output=path,
        ).run()
        log = path.with_suffix(".log").read_bytes()

        def save(target: Path) -> None:
            target.write_bytes(path.read_bytes())

        def use(path: Path) -> None:
            run = jid.load(path)
            remarks(run.metadata)
            jid.hardware.replay(path.with_suffix(".log"), bench.joint)

        modules = ["recording.truncated", "hardware.bench.frame_replay", "hardware.can.frame_log"]
        modules.append("hardware.elmo.recorded_options")
        return replace(_text_table("run.csv", save, use, modules), beside={"run.log": log})


def _text_table(
    name: str, save: Callable[[Path], object], use: Callable[[Path], object], modules: list[str]
) -> Example:
    """A .csv file whose marked lines hold JSON."""
    with TemporaryDirectory() as folder:
        path = Path(folder) / name
        save(path)
        lines = path.read_text(encoding="utf-8").splitlines()
    marks, documents = [], []
    for line in lines:
        begin = line.index("{") if line.startswith("# jointid") else len(line)
        marks.append(line[:begin] if begin < len(line) else "")
        documents.append(json.loads(line[begin:]) if begin < len(line) else line)
    return Example(name=name, documents=documents, marks=marks, use=use, modules=modules)


def _has_pinocchio() -> bool:
    try:
        import pinocchio  # noqa: F401
    except ModuleNotFoundError:
        return False
    return True


EXAMPLES: dict[str, Callable[[], Example]] = {
    "joint": _joint,
    "bench": _bench,
    "design": lambda: _motion("design.toml", jid.load_design, "excitation.design_file"),
    "motion": lambda: _motion("motion.toml", load_motion, "simulation.motion_file"),
    "certificate": _certificate,
    "facts": _facts,
    "estimate": _saved_estimate,
    "joints": _several,
    "all joints": lambda: _saved(
        "joints.json", jid.JointEstimates, ["joints.result", "joints.reading_back"]
    ),
    "comparison": lambda: _saved(
        "comparison.json",
        jid.Comparison,
        ["comparison.result", "comparison.reading_back"],
        ("estimate",),
    ),
    "robot comparison": lambda: _saved(
        "robot_comparison.json",
        jid.RobotComparison,
        ["robot.result.comparison_result", "robot.result.comparison_reading"],
        ("estimate",),
    ),
    "servo comparison": _servo_comparison,
    "design as JSON": _design_as_json,
    "study as JSON": _study_as_json,
    "any kind": _any_kind,
    "servo": _servo,
    "study": lambda: _study(_read_study, "study.jsonl"),
    "resumed study": lambda: _study(_resumed, "resumed.jsonl"),
    "recording": _recording,
    "robot recording": _robot_recording,
    "session": _session,
} | ({"robot": _robot} if _has_pinocchio() else {})

OTHERS: dict[str, str] = {
    "base.schema": "what the readers above use",
    "base.toml_file": "what the readers above use",
    "cli.commands": "an estimate of this run",
    "cli.explaining": "only which kind of file it is; tests/cli",
    "cli.facts_advice": "lines of a facts file that was read before; tests/cli/test_facts_advice.py",
    "cli.robot": "only which kind of file it is; tests/cli/test_cli_robot.py",
    "cli.session": "a copy of the joint file, which was read before",
    "exports.exporting": "an XML file to edit; tests/exports",
    "hardware.can.blf_file": "tests/hardware/test_frame_log.py",
    "hardware.can.bus": "of the kernel",
    "hardware.session.realtime": "of the kernel",
    "identification.search.run": "a checkpoint, of bytes: tests/base/test_read_back_bytes.py",
    "recording.attributes": "metadata of this run",
    "recording.hierarchies.hdf5_file": "tests/recording/test_hdf5_collection.py",
    "recording.messages.json_messages": "tests/recording/test_message_faults.py",
    "recording.messages.mcap_source": "tests/recording/test_message_faults.py",
    "recording.messages.ros1_source": "tests/recording/test_message_faults.py",
    "recording.messages.ros2_source": "tests/recording/test_message_faults.py",
    "recording.messages.sqlite_file": "tests/recording/test_sqlite_logs.py",
    "recording.readers.csv_text": "tests/recording/test_bad_files.py",
    "recording.readers.json_reader": "tests/recording/test_json.py",
    "recording.readers.lerobot": "tests/recording/test_lerobot.py",
    "recording.readers.mat_reader": "tests/recording/test_mat.py",
    "recording.readers.npz_reader": "tests/recording/test_bad_files.py",
    "recording.readers.parquet_reader": "tests/recording/test_bad_files.py",
    "recording.readers.wpilog_reader": "tests/recording/test_wpilog.py",
    "robot.links.reading_urdf": "tests/robot/test_robot_refusals.py",
}
"""Modules that read something else, and where that is tried."""
