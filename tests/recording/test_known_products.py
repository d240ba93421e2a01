"""Names of known products are read in their documented units, or asked for; a stated unit always wins."""

import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

import jointid as jid
from jointid.cli.command_line import main

TIME: NDArray[np.float64] = np.asarray(0.005 * np.arange(600), dtype=np.float64)
ANGLE = 1.2 * np.sin(3.0 * TIME) + 0.4 * np.sin(8.0 * TIME)  # rad
SPEED = 3.6 * np.cos(3.0 * TIME) + 3.2 * np.cos(8.0 * TIME)
EFFORT = np.sign(SPEED) + SPEED
TURN = 2.0 * math.pi
COUNTS = np.rint(4096.0 * ANGLE / TURN) + 2048.0


def log(path: Path, columns: dict[str, NDArray[np.float64]]) -> Path:
    rows = [
        ",".join(f"{value:.9g}" for value in row) for row in zip(*columns.values(), strict=True)
    ]
    path.write_text("\n".join([",".join(columns), *rows, ""]))
    return path


def odrive(prefix: str = "", motor: str = "") -> dict[str, NDArray[np.float64]]:
    return {
        "time_s": TIME,
        f"{prefix}pos_estimate": ANGLE / TURN,
        f"{prefix}vel_estimate": SPEED / TURN,
        f"{motor}Iq_measured": EFFORT,
    }


@pytest.mark.parametrize(
    ("prefix", "motor"),
    [("", ""), ("axis0.encoder.", "axis0.motor.current_control."), ("axis0_",) * 2],
)
def test_odrive_is_in_turns(prefix: str, motor: str, tmp_path: Path) -> None:
    loaded = jid.load(log(tmp_path / "a.csv", odrive(prefix, motor)))
    np.testing.assert_allclose(loaded.position, ANGLE, atol=1e-8)
    np.testing.assert_allclose(loaded.velocity, SPEED, atol=1e-7)
    assert loaded.current is not None
    assert "assumed_units" not in loaded.metadata
    assert loaded.metadata["recognised_units"]["position"] == "rev, as ODrive documents it"


@pytest.mark.parametrize(
    ("header", "unit", "name"),
    [
        ("present_velocity", 0.229 * TURN / 60.0, "0.229 rpm"),
        ("Present_Velocity", TURN / 4096.0, "1/4096 rev/s"),
        ("present_speed", TURN / 4096.0, "1/4096 rev/s"),
        ("present_speed", 0.732 * TURN / 60.0, "0.732 rpm"),
    ],
)
def test_registers_of_servos(header: str, unit: float, name: str, tmp_path: Path) -> None:
    columns = {"time_s": TIME, "present_position": COUNTS, header: np.rint(SPEED / unit)}
    loaded = jid.load(log(tmp_path / "a.csv", columns))
    np.testing.assert_allclose(np.ptp(loaded.position), np.ptp(ANGLE), rtol=0.01)
    np.testing.assert_allclose(loaded.velocity, SPEED, atol=unit)
    assert loaded.metadata["recognised_units"]["velocity"].startswith(f"{name}, as ")


def test_registers_of_several_servos(tmp_path: Path) -> None:
    columns = {"time_s": TIME, "present_position_1": COUNTS, "present_position_2": 2.0 * COUNTS}
    robot = jid.load_robot(log(tmp_path / "a.csv", columns))
    np.testing.assert_allclose(np.ptp(robot.position, axis=0) / np.ptp(ANGLE), [1, 2], rtol=0.01)


ASKED: dict[str, tuple[dict[str, NDArray[np.float64]], list[str]]] = {
    "CiA 402": (
        {
            "Position actual value": np.rint(1e4 * ANGLE),
            "Velocity actual value": np.rint(1e4 * SPEED),
            "Torque actual value": np.rint(50.0 * EFFORT),
        },
        ["in counts (6064h)", "per mille of the motor's rated torque", "scale position=FACTOR"],
    ),
    "CamelCase": (
        {"PositionActualValue": np.rint(1e4 * ANGLE), "TorqueActualValue": np.rint(50.0 * EFFORT)},
        ["in counts (6064h)", "scale torque=FACTOR"],
    ),
    "a model's current": (
        {"present_position": COUNTS, "present_current": np.rint(100.0 * EFFORT)},
        ["0.00269 for XM, XH and XW", "scale current=FACTOR"],
    ),
    "an older servo": (
        {"present_position": np.rint(512.0 + 195.4 * ANGLE)},
        ["scale position=FACTOR"],
    ),
}


@pytest.mark.parametrize("name", ASKED)
def test_what_a_name_does_not_state_is_asked_for(
    name: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    columns, said = ASKED[name]
    assert main(["info", str(log(tmp_path / "a.csv", {"time_s": TIME, **columns}))]) == 2
    message = capsys.readouterr().err
    assert all(each in message for each in said), message


def test_converted_values_under_these_names_are_not_registers(tmp_path: Path) -> None:
    for header in ("present_position", "Position actual value"):
        loaded = jid.load(log(tmp_path / "a.csv", {"time_s": TIME, header: ANGLE}))
        np.testing.assert_allclose(loaded.position, ANGLE, atol=1e-8)
        assert loaded.metadata["assumed_units"] == ["position"]


def test_what_is_stated_wins_and_a_contradiction_is_said(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    stated = {"time_s": TIME, "pos_estimate [deg]": np.rad2deg(ANGLE), "vel_estimate": SPEED / TURN}
    path = log(tmp_path / "a.csv", stated)
    np.testing.assert_allclose(jid.load(path).position, ANGLE, atol=1e-8)
    assert "overridden_units" not in jid.load(path).metadata
    path = log(tmp_path / "b.csv", odrive())
    given: dict[str, Any] = {"units": {"position": "deg"}}
    loaded = jid.load(path, **given)
    np.testing.assert_allclose(loaded.position, np.deg2rad(ANGLE / TURN), atol=1e-9)
    assert loaded.metadata["overridden_units"] == {"position": "rev"}
    amperes = log(tmp_path / "c.csv", {"time_s": TIME, "q_rad": ANGLE, "i_A": EFFORT})
    line = ["info", str(amperes), "--column", "torque=i_A", "--scale", "torque=1"]
    assert main(line) == 0
    assert (
        "torque is read in the unit that the call states, not in the file's unit A"
        in capsys.readouterr().out
    )
    counts = log(tmp_path / "d.csv", {"time_s": TIME, "position [counts]": COUNTS})
    assert "overridden_units" not in jid.load(counts, scale={"position": 0.001}).metadata
