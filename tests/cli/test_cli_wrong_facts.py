"""A rate, a gear ratio or units that position and velocity contradict: each is asked, and the first paste cures it."""

import re
import shlex
from pathlib import Path

import numpy as np
import pytest

import jointid as jid
from jointid.cli.command_line import main

TIME = 0.004 * np.arange(1500)
ANGLE = np.sin(2.0 * TIME) + 0.4 * np.sin(5.3 * TIME)
SPEED = 2.0 * np.cos(2.0 * TIME) + 2.12 * np.cos(5.3 * TIME)
RATE = -4.0 * np.sin(2.0 * TIME) - 11.236 * np.sin(5.3 * TIME)
CURRENT = (0.5 * RATE + 3.0 * np.sign(SPEED) + 1.2 * SPEED) / 5.0
FACTS = ["--model", "coulomb_viscous", "--torque-constant", "0.1"]


def log(path: Path, **columns: np.ndarray) -> str:
    table = np.column_stack(list(columns.values()))
    np.savetxt(path, table, fmt="%.9g", delimiter=",", header=",".join(columns), comments="")
    return str(path)


def shown(line: list[str], capsys: pytest.CaptureFixture[str]) -> str:
    assert main(["identify", *line, *FACTS]) == 0
    return capsys.readouterr().out


def first_paste(text: str) -> list[str]:
    """The first command that the answer proposes."""
    found = re.search(r"^  do: jointid (.*)$", text, re.MULTILINE)
    assert found is not None, text
    return shlex.split(found[1])


def check_cured(path: str, options: list[str], capsys: pytest.CaptureFixture[str]) -> str:
    """The log is not usable, names no parameter, keeps the velocity, and is right after the first paste."""
    text = shown([path, *options], capsys)
    assert text.startswith("a: not usable\n")
    assert "velocity=none" not in text
    assert main(first_paste(text)) == 0
    cured = capsys.readouterr().out
    for name, value in (("inertia", 0.5), ("coulomb", 3.0), ("viscous", 1.2)):
        found = re.search(rf"^  {name} +(\S+)", cured, re.MULTILINE)
        assert found is not None
        assert float(found[1]) == pytest.approx(value, rel=0.02)
    return cured


@pytest.mark.parametrize("rate", [500.0, 125.0])
def test_a_wrong_rate_is_corrected_by_the_velocity(
    rate: float, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = log(tmp_path / "a.csv", position_rad=ANGLE, velocity_rad_s=SPEED, current_A=CURRENT)
    check_cured(path, ["--gear-ratio", "50", "--rate", str(rate)], capsys)


@pytest.mark.parametrize(("stated", "right"), [(25.0, 50.0), (100.0, 50.0), (60.0, 50.0)])
def test_a_wrong_gear_ratio_is_corrected_by_the_position(
    stated: float, right: float, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    columns = {"time_s": TIME, "position_rad": ANGLE, "velocity_rad_s": right * SPEED}
    path = log(tmp_path / "a.csv", **columns, current_A=CURRENT)
    check_cured(path, ["--gear-ratio", f"{stated:g}", "--side", "velocity=motor"], capsys)


def test_units_are_recognised_behind_a_stated_gear_ratio(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    columns = {"time": TIME, "pos": np.degrees(ANGLE), "vel": 50.0 * SPEED * 30.0 / np.pi}
    path = log(tmp_path / "a.csv", **columns, current=CURRENT)
    text = shown([path, "--gear-ratio", "50"], capsys)
    assert "position=rad" not in text  # what is asked is not proposed otherwise
    assert "--gear-ratio 50 --unit position=deg --unit velocity=rpm" in text
    check_cured(path, ["--gear-ratio", "50"], capsys)


@pytest.mark.parametrize("wrong", ["time=ms", "position=deg", "velocity=rpm"])
def test_a_unit_against_the_file_is_taken_back(
    wrong: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    columns = {"time_s": TIME, "position_rad": ANGLE, "velocity_rad_s": SPEED}
    path = log(tmp_path / "a.csv", **columns, current_A=CURRENT)
    options = ["--unit", wrong, "--gear-ratio", "50"]
    check_cured(path, options, capsys)


@pytest.mark.parametrize("velocity", [False, True])
def test_a_position_of_the_motor_in_stated_units_is_named_and_read(
    velocity: bool, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    columns = {"time_s": TIME, "position_deg": 200.0 * np.degrees(ANGLE)}
    if velocity:
        columns["velocity_rpm"] = 200.0 * SPEED * 30.0 / np.pi
    path = log(tmp_path / "a.csv", **columns, motor_torque_mNm=CURRENT * 5e3 / 200.0)
    text = shown([path, "--gear-ratio", "200"], capsys)
    assert "the position is probably the motor angle" in text
    check_cured(path, ["--gear-ratio", "200"], capsys)


def test_a_log_of_the_motor_is_read_with_the_ratio_of_the_joint(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    columns = {
        "time_s": TIME,
        "motor_position_1_rad": 50.0 * ANGLE,
        "motor_torque_1_Nm": CURRENT / 10,
    }
    path = log(tmp_path / "a.csv", **columns)
    joint = jid.Joint(gear_ratio=50.0, model=jid.Model.of("coulomb_viscous"))
    findings = {each.code: each for each in jid.identify(jid.load(path), joint).findings}
    assert "implausible_units" not in findings  # the motor's speed is not multiplied again
    found = findings["motor_side"]
    assert found.severity == "blocking"
    assert found.advice[0].arguments == {"gear_ratio": 50.0}
    joint.replace(name="a").save(tmp_path / "joint.toml")
    text = shown([path, "--joint", str(tmp_path / "joint.toml")], capsys)
    assert "motor_side" not in text
    assert "  viscous         1.20" in text, text


def drive_log(path: Path, header: str, factor: float) -> str:
    """The log with the drive's column in another unit or on another side."""
    columns = {"time_s": TIME, "position_rad": ANGLE, "velocity_rpm": SPEED * 50.0 * 30.0 / np.pi}
    return log(path, **columns, **{header: CURRENT * factor})


MOTOR = ["--gear-ratio", "50", "--side", "velocity=motor"]


@pytest.mark.parametrize(
    ("header", "factor", "known", "paste"),
    [
        ("current", 1e3, [], ["--unit", "current=mA"]),
        ("torque", 5e3, [], ["--unit", "torque=mNm"]),
        ("torque", 0.1, [], ["--side", "torque=motor"]),
        ("torque_Nm", 0.1, [], ["--side", "torque=motor"]),
        ("current", 1e3, ["--unit", "current=A"], ["--unit", "current=mA"]),
        ("torque", 5e2, ["--side", "torque=joint"], ["--unit", "torque=Ncm"]),
        ("torque_Nm", 0.1, [], ["--side", "torque=motor", "--gear-ratio", "50"]),
    ],
)
def test_a_torque_of_another_size_is_asked(
    header: str,
    factor: float,
    known: list[str],
    paste: list[str],
    tmp_path: Path,
    capsys: pytest.CaptureFixture[str],
) -> None:
    path = drive_log(tmp_path / "a.csv", header, factor)
    options = [*MOTOR, *known]
    if known or "--gear-ratio" in paste:
        options += ["--inertia", "0.5"]
    if paste == ["--unit", "torque=mNm"]:
        options += ["--side", "torque=joint"]
    text = shown([path, *options], capsys)
    assert {*paste} <= {*first_paste(text)}
    cured = check_cured(path, options, capsys)
    assert "blocking" not in cured


def test_a_statement_is_obeyed_and_an_implausible_one_asked(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = drive_log(tmp_path / "a.csv", "current", 1e3)
    text = shown([path, *MOTOR, "--unit", "current=A"], capsys)
    assert text.startswith("a: usable with care\n")
    assert "current=mA" in first_paste(text)
    path = drive_log(tmp_path / "b.csv", "torque_Nm", 5.0)
    assert "--side torque=joint" in shown([path, *MOTOR, "-v"], capsys)
    assert "b: usable\n" in shown([path, *MOTOR, "--side", "torque=joint"], capsys)


def test_no_side_is_asked_where_it_is_known(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = drive_log(tmp_path / "a.csv", "joint_torque_Nm", 5.0)
    assert "torque_side" not in shown([path, *MOTOR], capsys)
    path = drive_log(tmp_path / "b.csv", "motor_torque_Nm", 0.1)
    assert "torque_side" not in shown([path, *MOTOR], capsys)
    path = drive_log(tmp_path / "c.csv", "torque_Nm", 5.0)
    assert "torque_side" not in shown([path, *MOTOR, "--inertia", "0.5"], capsys)


def test_a_velocity_in_stated_units_shows_that_time_is_in_seconds(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    columns = {"t": TIME, "position_rad": ANGLE, "velocity_rad_s": SPEED, "current_A": CURRENT}
    path = log(tmp_path / "a.csv", **columns)
    assert "assumed_units" not in shown([path, "--gear-ratio", "50"], capsys)
    assert "assumed_units" in shown(
        [path, "--gear-ratio", "50", "--column", "velocity=none"], capsys
    )
    columns["velocity_rad_s"] = 1.02 * SPEED
    path = log(tmp_path / "b.csv", **columns)
    assert "assumed_units" in shown([path, "--gear-ratio", "50"], capsys)


def test_no_motion_is_designed_in_silence_from_values_that_cannot_be_used(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    speed = np.concatenate([np.zeros(3000), SPEED])
    speed += np.random.default_rng(1).normal(0.0, 1e-3, len(speed))
    columns = {
        "time_s": 0.004 * np.arange(4500),
        "position_rad": np.concatenate([np.full(3000, ANGLE[0]), ANGLE]),
        "velocity_rad_s": 50.0 * speed,
        "current_A": np.concatenate([np.zeros(3000), CURRENT]),
    }
    path, saved = log(tmp_path / "a.csv", **columns), str(tmp_path / "a.json")
    text = shown([path, "--gear-ratio", "50", "--save", saved], capsys)
    assert "standing" in text
    assert "--velocity=" not in text  # the motor's speed is no limit of the joint
    joint = tmp_path / "joint.toml"
    jid.Joint(name="a", gear_ratio=50.0, torque_constant=0.1, inertia=0.5).save(joint)
    limits = "--position=-1,1 --velocity=2 --torque=30 --duration 2 --criterion other"
    assert main(["design", str(joint), "--after", saved, *limits.split(), "--quiet"]) == 2
    assert "cannot be used: " in capsys.readouterr().err


def test_what_one_signal_lacks_is_said_once(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = log(tmp_path / "a.csv", time_s=TIME, position_rad=ANGLE, **{"iqmeasA [A]": CURRENT})
    assert main(["identify", path]) == 2
    message = capsys.readouterr().err
    assert message.count("torque: ") == 1
    assert "--torque-constant VALUE --gear-ratio RATIO (facts of motor and gear)" in message
