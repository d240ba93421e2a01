"""The code in docs/servos.md runs on logs of a known servo and finds its values; its joint file is one."""

from pathlib import Path

import numpy as np
import pytest
from documents import blocks, parsed_commands, read, run_python_blocks

import jointid as jid

PAGE = "docs/servos.md"
TRUTH = {"torque_constant": 0.36, "inertia": 0.0017, "load_friction": 0.15}
COLUMNS = "time_s,goal_position_rad,position_rad,duty,torque_enabled,firmware_kp"


def write_runs(folder: Path, bench: jid.Joint) -> None:
    """Eight runs of the page's servo; in every second one the load is lifted and let go."""
    assert bench.voltage is not None
    loop = bench.voltage.position_loop
    assert loop is not None
    drive = jid.VoltageDrive(supply=bench.voltage.supply, resistance=4.0, position_loop=loop)
    friction = {"viscous": 0.006, "coulomb": 0.01, "load_friction": TRUTH["load_friction"]}
    truth = bench.replace(
        voltage=drive, torque_constant=TRUTH["torque_constant"], inertia=TRUTH["inertia"]
    ).with_parameters(friction)
    time = np.arange(0.0, 6.0, 0.002)
    folder.mkdir()
    for number in range(8):
        gain, free = 100.0 * 2 ** (number // 2), number % 2 == 1
        wanted = np.where(free, -1.6, np.sin(2.6 * time) + 0.5 * np.sin(7.1 * time))
        driven = np.where(free & (time > 1.5), 0.0, 1.0)
        extra = {"driven": driven, "gain": np.full(time.shape, gain)}
        plan = jid.Recording(time=time, position=0.0 * time, reference=wanted, extra=extra)
        moved = jid.simulate(truth, recordings=plan).runs[0].position
        duty = np.clip(loop.gain * gain * (wanted - moved), -1.0, 1.0) * driven
        rows = np.column_stack([time, wanted, moved, duty, driven, extra["gain"]])
        np.savetxt(folder / f"run_{number}.csv", rows, delimiter=",", header=COLUMNS, comments="")


def test_the_page_runs(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path = tmp_path / "servo.toml"
    path.write_text(blocks(read(PAGE), "toml")[0], encoding="utf-8")
    write_runs(tmp_path / "runs", jid.Joint.load(path))
    names = run_python_blocks(read(PAGE), tmp_path, monkeypatch)
    estimate = names["estimate"]
    assert estimate["torque_constant"] == pytest.approx(TRUTH["torque_constant"], rel=0.06)
    assert estimate["inertia"] == pytest.approx(TRUTH["inertia"], rel=0.05)
    assert estimate["load_friction"] == pytest.approx(TRUTH["load_friction"], rel=0.06)
    assert names["rolled"].median < 0.01
    assert jid.Joint.load(tmp_path / "identified.toml").inertia == estimate["inertia"]


def test_its_joint_file_is_read(tmp_path: Path) -> None:
    (text,) = blocks(read(PAGE), "toml")
    path = tmp_path / "servo.toml"
    path.write_text(text, encoding="utf-8")
    joint = jid.Joint.load(path)
    assert joint.voltage is not None
    assert joint.voltage.position_loop is not None
    commented = text.replace("# resistance", "resistance").replace("# duty_scale", "duty_scale")
    path.write_text(commented, encoding="utf-8")
    assert jid.Joint.load(path).voltage is not None


def test_its_command_exists() -> None:
    assert parsed_commands(read(PAGE)) == ["identify"]
