"""The ten steps of docs/robots.md run on a bag and print what they show; the code of its reference runs, too."""

from pathlib import Path

import numpy as np
import pytest
import small_arm
from documents import (
    blocks,
    parsed_commands,
    read,
    run_console_blocks,
    run_python_blocks,
    same_text,
)
from message_files import START, State, joint_state, ros2_bag

import jointid as jid
from jointid.robot.links.facts import read_facts

pytest.importorskip("pinocchio")
STEPS, REFERENCE = "docs/robots.md", "docs/robot_reference.md"


def bag(folder: Path, urdf: Path, seed: int, duration: float) -> None:
    """250 messages a second of an arm of two joints; the shoulder's friction grows with its load."""
    run = small_arm.recording(urdf, seed=seed, under_load=(0.15, 0.0), duration=duration)
    velocity = np.gradient(run.position, run.time, axis=0)
    assert run.torque is not None
    columns = [each[::4].tolist() for each in (run.time, run.position, velocity, run.torque)]
    states = [
        State(stamp=START + round(1e9 * t), name=run.names, position=q, velocity=v, effort=tau)
        for t, q, v, tau in zip(*columns, strict=True)
    ]
    ros2_bag(folder, [joint_state("/joint_states", each) for each in states])


def test_the_ten_steps_run(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    pytest.importorskip("rosbags")
    monkeypatch.setenv("COLUMNS", "100")
    urdf = tmp_path / "arm.urdf"
    urdf.write_text(small_arm.URDF.replace('name="small"', 'name="arm"'), encoding="utf-8")
    bag(tmp_path / "run", urdf, 0, duration=20.0)
    bag(tmp_path / "other", urdf, 1, duration=5.0)
    monkeypatch.chdir(tmp_path)
    text = read(STEPS)
    shown = text.replace("```toml", "```facts")  # facts, which change no joint file
    commands = run_console_blocks(shown, tmp_path, capsys, within=0.02)
    assert commands == ["info", "info", *["identify"] * 3, "export"]
    names = run_python_blocks(text, tmp_path, monkeypatch)
    rolled = names["rolled"].report()
    assert same_text("\n".join(blocks(text, "text")), rolled, within=0.02)
    assert "elbow: Coulomb friction 2.00 -> " in capsys.readouterr().out


def test_facts_of_the_steps_are_read(tmp_path: Path) -> None:
    urdf = small_arm.urdf(tmp_path)
    path = tmp_path / "robot.toml"
    motors, driven = blocks(read(STEPS), "toml")
    path.write_text(motors, encoding="utf-8")
    robot = jid.Robot.from_urdf(urdf, facts=path)
    assert robot.gear_ratios == (100.0, -50.0)
    assert robot.torque_constants == (0.11, 0.08)
    path.write_text(driven, encoding="utf-8")
    drive = jid.Robot.from_urdf(urdf, facts=path).drive
    assert drive is not None
    assert drive.kp == (20.0, 20.0)


@pytest.mark.slow
def test_the_reference_runs(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    urdf = tmp_path / "arm.urdf"
    urdf.write_text(small_arm.URDF, encoding="utf-8")
    small_arm.recording(urdf).save(tmp_path / "arm.csv")
    names = run_python_blocks(read(REFERENCE), tmp_path, monkeypatch)
    assert names["coulomb"].value == pytest.approx(4.0, rel=0.02)
    assert 'friction="' in (tmp_path / "arm_with_friction.urdf").read_text(encoding="utf-8")


def test_the_commands_between_the_steps_exist() -> None:
    assert parsed_commands(read(STEPS).replace("CODE", "load_friction")) == ["explain", "compare"]
    assert parsed_commands(read(REFERENCE)) == [
        *("identify", "compare", "report", "export"),
        "explain",
    ]


def test_its_facts_are_read(shared_data: Path, tmp_path: Path) -> None:
    (text,) = blocks(read(REFERENCE), "toml")
    path = tmp_path / "robot.toml"
    path.write_text(text, encoding="utf-8")
    assert read_facts(path)["zero_offsets"][1] == pytest.approx(-1.5707963)
    robot = jid.Robot.from_urdf(shared_data / "tx40" / "tx40.urdf", facts=path)
    assert robot.couplings[5].tolist() == [0.0, 0.0, 0.0, 0.0, 1.0, 1.0]
    assert robot.rotor_inertias == (None,) * 6
