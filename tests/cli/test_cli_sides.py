"""A velocity of the motor beside the joint's position, and the other way: named, and read by what is advised."""

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
TORQUE = 0.5 * RATE + 3.0 * np.sign(SPEED) + 1.2 * SPEED


def log(path: Path, position: float = 1.0, velocity: float = 1.0) -> str:
    columns = (TIME, ANGLE * position, SPEED * velocity, TORQUE)
    rows = [",".join(f"{value:.9g}" for value in row) for row in zip(*columns, strict=True)]
    path.write_text("\n".join(["time_s,position_rad,velocity_rad_s,torque_Nm", *rows, ""]))
    return str(path)


def advised(path: str, options: list[str], capsys: pytest.CaptureFixture[str]) -> list[str]:
    """The options of the first advice that names a side."""
    line = ["identify", path, "--model", "coulomb_viscous", *options]
    assert main(line) == 0
    found = re.search(
        r"do: jointid identify .* (--side \S+ --gear-ratio \S+)", capsys.readouterr().out
    )
    assert found is not None
    return shlex.split(found[1])


@pytest.mark.parametrize(
    ("position", "velocity"), [(1.0, 100.0), (1.0, 50.0), (1.0, -32.0), (6.3, 1.0)]
)
@pytest.mark.parametrize("known", [False, True])
def test_the_motors_side_is_named_and_read(
    position: float,
    velocity: float,
    known: bool,
    tmp_path: Path,
    capsys: pytest.CaptureFixture[str],
) -> None:
    path = log(tmp_path / "a.csv", position, velocity)
    ratio = position * velocity
    stated = ["--gear-ratio", f"{ratio:g}"] if known else []
    options = advised(path, stated, capsys)
    assert options[1] == ("velocity=motor" if position == 1.0 else "position=motor")
    assert float(options[3]) == pytest.approx(ratio, rel=0.01)
    line = ["identify", path, "--model", "coulomb_viscous", *options]
    assert main(line) == 0
    shown = capsys.readouterr().out
    assert "velocity_mismatch" not in shown
    assert float(shown.partition("coulomb ")[2].split()[0]) == pytest.approx(3.0, rel=0.02)


def test_the_ratio_of_the_joint_file_is_taken(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    joint = tmp_path / "joint.toml"
    jid.Joint(name="a", gear_ratio=100.0, model=jid.Model.of("coulomb_viscous")).save(joint)
    path = log(tmp_path / "a.csv", velocity=100.0)
    assert main(["identify", path, "--joint", str(joint), "--side", "velocity=motor"]) == 0
    assert "velocity_mismatch" not in capsys.readouterr().out


def test_a_side_needs_the_ratio_and_a_name(tmp_path: Path) -> None:
    path = log(tmp_path / "a.csv", velocity=100.0)
    with pytest.raises(jid.InputError, match="the gear ratio is needed to combine these signals"):
        jid.load(path, side={"velocity": "motor"})
    with pytest.raises(jid.InputError, match="velocity and torque on the joint side;"):
        jid.load(path, side={"position": "motor"})  # nothing is said of a reference
    with pytest.raises(jid.InputError, match="can have a side"):
        jid.load(path, side={"current": "motor"}, gear_ratio=100.0)
    with pytest.raises(jid.InputError, match='"motor" or "joint" is expected'):
        jid.load(path, side={"velocity": "output"}, gear_ratio=100.0)
    loaded = jid.load(path, side={"velocity": "motor"}, gear_ratio=100.0)
    np.testing.assert_allclose(loaded.velocity, SPEED, atol=1e-7)
    np.testing.assert_allclose(loaded.position, ANGLE, atol=1e-7)


@pytest.mark.parametrize(
    ("factor", "header", "options"),
    [
        (1.0, "position_rad", ["--gear-ratio", "50"]),
        (50.0, "motor_position_1_rad", ["--gear-ratio", "50"]),
        (50.0, "motor_position_1_rad", []),
    ],
)
def test_a_motors_torque_of_the_wrong_sign_is_turned_by_what_is_pasted(
    factor: float,
    header: str,
    options: list[str],
    tmp_path: Path,
    capsys: pytest.CaptureFixture[str],
) -> None:
    path = tmp_path / "a.csv"
    torque = "motor_torque_1_mNm" if "1" in header else "motor_torque_mNm"
    table = np.column_stack([TIME, ANGLE * factor, -20.0 * TORQUE])
    np.savetxt(path, table, delimiter=",", header=f"time_s,{header},{torque}", comments="")
    assert main(["identify", str(path), "--model", "coulomb_viscous", *options]) == 0
    said = capsys.readouterr().out
    found = re.search(r"wrong sign\n  do: jointid (identify .*)", said)
    assert found is not None
    assert main(shlex.split(found[1])) == 0
    coulomb = float(capsys.readouterr().out.partition("coulomb ")[2].split()[0])
    assert coulomb == pytest.approx(3.0 if options else 0.06, rel=0.02)


@pytest.mark.parametrize(
    ("position", "torque"),
    [("motor_angle_deg", "motor_torque_mNm"), ("Motorwinkel [deg]", "Motormoment [mNm]")],
)
def test_a_motors_angle_is_proposed_as_the_motors(
    position: str, torque: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = tmp_path / "a.csv"
    table = np.column_stack([TIME, np.degrees(ANGLE) * 50.0, 20.0 * TORQUE])
    np.savetxt(path, table, delimiter=",", header=f"time_s,{position},{torque}", comments="")
    line = ["identify", str(path), "--model", "coulomb_viscous", "--gear-ratio", "50"]
    assert main(line) == 2
    said = capsys.readouterr().err
    assert main([*line, *shlex.split(said.partition("load with ")[2])]) == 0
    shown = capsys.readouterr().out
    assert float(shown.partition("coulomb ")[2].split()[0]) == pytest.approx(3.0, rel=0.02)
    joint = tmp_path / "joint.toml"
    assert main(["new", str(joint), str(path), "--gear-ratio", "50"]) == 0
    assert "--side position=motor" in capsys.readouterr().out


@pytest.mark.parametrize(
    ("options", "cured"),
    [
        ([], "--side position=motor"),
        (["--side", "position=motor", "--unit", "position=rad"], "--unit position=deg"),
    ],
)
def test_a_stated_degree_that_is_too_fast_is_the_motors_or_overridden(
    options: list[str], cured: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = tmp_path / "a.csv"
    table = np.column_stack([TIME, np.degrees(ANGLE) * 50.0, TORQUE / 50.0])
    header = "time_s,motor_angle_deg,motor_torque_Nm"
    np.savetxt(path, table, delimiter=",", header=header, comments="")
    column = ["--column", "position=motor_angle_deg", "--gear-ratio", "50"]
    assert main(["identify", str(path), "--model", "coulomb_viscous", *column, *options]) == 0
    found = re.search(r"the motor would turn .*\n  do: jointid (.*)", capsys.readouterr().out)
    assert found is not None
    assert cured in found[1]
    assert main(shlex.split(found[1])) == 0
    coulomb = float(capsys.readouterr().out.partition("coulomb ")[2].split()[0])
    assert coulomb == pytest.approx(3.0, rel=0.02)


def test_the_unit_of_a_motors_torque_is_named_by_the_known_inertia(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = tmp_path / "a.csv"
    table = np.column_stack([TIME, ANGLE, 20.0 * TORQUE])
    header = "time_s,position_rad,motor_torque"
    np.savetxt(path, table, delimiter=",", header=header, comments="")
    line = ["identify", str(path), "--model", "coulomb_viscous", "--gear-ratio", "50"]
    assert main([*line, "--rotor-inertia", "0.0002"]) == 0
    found = re.search(r"times the known 0.5\n  do: jointid (.*)", capsys.readouterr().out)
    assert found is not None
    assert "--unit motor_torque=mNm" in found[1]
    assert main(shlex.split(found[1].partition(" (")[0])) == 0
    coulomb = float(capsys.readouterr().out.partition("coulomb ")[2].split()[0])
    assert coulomb == pytest.approx(3.0, rel=0.02)
