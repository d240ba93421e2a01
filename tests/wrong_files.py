"""The files that `cli/wrong_command_lines.toml` names: good ones, and one for every way to be wrong."""

import json
from pathlib import Path

import numpy as np
from example_recordings import WELL_EXCITED

import jointid as jid

_TRUTH = {"coulomb": 25.0, "static": 20.0, "stribeck": 100.0, "viscous": 20.0}
_TRUTH |= {"sensor_gain": 2.4, "sensor_offset": 15.0}
_HEADER = "time_s,position_rad,torque_Nm"
_ROWS = [f"{0.01 * k:.2f},{0.1 * k},{1.0}" for k in range(20)]


def write_wrong_files(folder: Path) -> None:
    """Fill a folder."""
    _recordings(folder)
    _broken_recordings(folder)
    _joint_files(folder)
    _others(folder)


def _recordings(folder: Path) -> None:
    run = jid.load(WELL_EXCITED).crop(0.0, 5.0)
    columns = {
        "time_s": run.time,
        "position_rad": run.position,
        "velocity_rad_s": run.velocity,
        "torque_Nm": run.torque,
        "sensor_raw": run.sensor,
    }

    arrays = {name: np.asarray(column) for name, column in columns.items()}

    def write(name: str, **headers: str) -> None:
        table = np.column_stack([arrays[column] for column in headers])
        header = ",".join(headers.values())
        np.savetxt(folder / name, table, delimiter=",", header=header, comments="")

    time, torque = {"time_s": "time_s"}, {"torque_Nm": "torque_Nm"}
    position, velocity = {"position_rad": "position_rad"}, {"velocity_rad_s": "velocity_rad_s"}
    write("good.csv", **time, **position, **velocity, **torque)
    write("sensor.csv", **time, **position, **velocity, **torque, sensor_raw="sensor_raw")
    write("motor.csv", **time, **position, **velocity, torque_Nm="motor_torque_Nm")
    write("encoder.csv", **time, position_rad="enc1", **velocity, **torque)
    write("volts.csv", **time, position_rad="position_volt", **velocity, **torque)
    write("positions.csv", **time, **position, velocity_rad_s="position_deg", **torque)


def _broken_recordings(folder: Path) -> None:
    texts = {
        "text.csv": [_HEADER, *_ROWS, "oops,1,2"],
        "no_torque.csv": [row.rsplit(",", 1)[0] for row in (_HEADER, *_ROWS)],
        "back.csv": [_HEADER, *_ROWS, "0.05,1,2"],
        "still.csv": [_HEADER, *(f"{0.01 * k:.2f},1,2" for k in range(200))],
        "header.csv": [_HEADER],
        "plain.csv.gz": [_HEADER, *_ROWS],
        "nan.csv": [_HEADER, *_ROWS, "0.2,nan,1"],
        "ragged.csv": [_HEADER, *_ROWS, "0.2,1", "0.21,2.1,1.0"],
        "linear.csv": ["time_s,position_m,force_N", *_ROWS],
        "runs.csv": [
            f"run,{_HEADER}",
            *(f"{number},{row}" for number in (1, 2) for row in _ROWS),
        ],
    }
    for name, lines in texts.items():
        (folder / name).write_text("\n".join([*lines, ""]), encoding="utf-8")
    (folder / "folder.csv").mkdir()
    (folder / "empty.csv").touch()
    (folder / "log.xlsx").write_bytes(b"PK")
    for ending in ("csv", "npz", "mat", "parquet"):
        (folder / f"binary.{ending}").write_bytes(bytes(range(256)))


def _joint_files(folder: Path) -> None:
    joint = jid.thesis_joint()
    joint.save(folder / "unknown.toml")
    joint.with_parameters(_TRUTH).save(folder / "true.toml")
    plain = {name: _TRUTH[name] for name in ("coulomb", "viscous")}
    jid.Joint(model=jid.Model("coulomb_viscous")).with_parameters(plain).save(folder / "plain.toml")
    bench = Path(__file__).resolve().parents[1] / "examples" / "hardware" / "joint.toml"
    text = bench.read_text(encoding="utf-8")
    texts = {
        "typo.toml": "schema = 1\n[drive]\ngear_ration = 3.0\n",
        "kind.toml": 'schema = 1\n[drive]\ngear_ratio = "three"\n',
        "zero.toml": "schema = 1\n[drive]\ngear_ratio = 0\n",
        "newer.toml": "schema = 99\n",
        "bounds.toml": "schema = 1\n[parameters]\nviscous = { value = 1.0, min = 2.0 }\n",
        "sensor.toml": "schema = 1\n[sensor]\npresent = true\n",
        "slide.toml": 'schema = 2\nkind = "prismatic"\n[drive]\ninertia = 5.0\n',
        "bench.toml": text,
        "moved.toml": _taking(text, "nowhere.toml"),
        "far.toml": _taking(text, "far_motion.toml"),
        "far_motion.toml": (
            '[trajectory]\nform = "thesis"\n'
            "[peaks]\nposition = [-1.5, 1.5]\nvelocity = 1\nacceleration = 1\ntorque = 1\n"
        ),
        "drive.toml": text.replace("counts_per_turn = 8000", "counts_per_turn = -8000"),
    }
    for name, content in texts.items():
        (folder / name).write_text(content, encoding="utf-8")


def _taking(bench: str, motion: str) -> str:
    """A bench file's text with its motion in a file."""
    begin, end = bench.index('form = "thesis"'), bench.index("[session.controller]")
    return f'{bench[:begin]}file = "{motion}"\n\n{bench[end:]}'


def _others(folder: Path) -> None:
    estimate = jid.identify(jid.load(folder / "good.csv"), jid.Joint())
    estimate.save(folder / "estimate.json")
    (folder / "other.json").write_text(json.dumps({"schema": 1}), encoding="utf-8")
    arm = '<robot name="arm"><joint name="elbow" type="fixed"><parent link="a"/></joint></robot>'
    (folder / "arm.urdf").write_text(arm, encoding="utf-8")
    (folder / "study.jsonl").write_text("{}\n", encoding="utf-8")
    (folder / "full").mkdir()
    (folder / "full" / "cycle_1.json").touch()
