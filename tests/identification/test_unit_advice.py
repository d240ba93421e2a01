"""Degrees taken for radians: the advice states what no header states, and obeying it removes the warning."""

from pathlib import Path

import numpy as np
import pytest
from example_recordings import WELL_EXCITED

import jointid as jid
from jointid.estimate.findings import Finding


def written(folder: Path, position: str, velocity: str, *, both: bool = False) -> Path:
    """The shipped recording under these headers, its position (or both) in degrees."""
    run = jid.load(WELL_EXCITED)
    speed = np.degrees(run.velocity) if both else run.velocity
    columns = (run.time, np.degrees(run.position), speed, run.torque, run.sensor)
    path = folder / "log.csv"
    header = f"time_s,{position},{velocity},torque_Nm,sensor_raw"
    np.savetxt(path, np.column_stack(columns), delimiter=",", header=header, comments="")  # type: ignore[arg-type]
    return path


def about_units(path: Path, units: dict[str, str] | None = None) -> list[Finding]:
    recording = jid.load(path, columns={"position": 1, "velocity": 2}, units=units)
    codes = {"implausible_units", "velocity_mismatch", "wrong_scale"}
    found = jid.identify(recording, jid.thesis_joint()).warnings
    return [warning for warning in found if warning.code in codes]


@pytest.mark.parametrize(
    ("position", "velocity", "both", "units"),
    [
        ("enc1", "velocity_rad_s", False, {"position": "deg"}),
        ("enc1", "speed1", True, {"position": "deg", "velocity": "deg/s"}),
        ("enc1", "velocity_deg_s", True, {"position": "deg"}),
    ],
)
def test_the_advice_names_the_units_that_no_header_states(
    position: str, velocity: str, both: bool, units: dict[str, str], tmp_path: Path
) -> None:
    path = written(tmp_path, position, velocity, both=both)
    (warning,) = about_units(path)
    advice = warning.advice[0]
    assert (advice.kind, advice.function) == ("call", "load")
    assert advice.arguments == {"units": units}
    assert about_units(path, advice.arguments["units"]) == []


@pytest.mark.parametrize("both", [False, True])
def test_a_stated_unit_is_not_overruled(both: bool, tmp_path: Path) -> None:
    (warning,) = about_units(written(tmp_path, "position_rad", "velocity_rad_s", both=both))
    assert all(advice.kind == "inspect" for advice in warning.advice)
    assert "the header or program that states radians" in warning.advice[0].text


@pytest.mark.parametrize(
    ("signal", "factor", "unit"),
    [
        ("position", 1.0 / (2.0 * np.pi), "rev"),
        ("velocity", 1.0 / (2.0 * np.pi), "rev_s"),
        ("velocity", 30.0 / np.pi, "rpm"),
        ("position", 1e3, "mrad"),
    ],
)
def test_turns_are_recognised_by_position_and_velocity(
    signal: str, factor: float, unit: str, tmp_path: Path
) -> None:
    run = jid.load(WELL_EXCITED)
    columns = {"time_s": run.time, "position": run.position, "velocity": run.velocity}
    columns["torque_Nm"], columns["sensor_raw"] = run.torque, run.sensor  # type: ignore[assignment]
    columns[signal] = columns[signal] * factor
    path = tmp_path / "log.csv"
    table = np.column_stack(list(columns.values()))
    np.savetxt(path, table, delimiter=",", header=",".join(columns), comments="")
    found = jid.identify(jid.load(path), jid.thesis_joint()).warnings
    (warning,) = (each for each in found if each.code == "velocity_mismatch")
    assert f"{signal} seems to be in {unit}" in warning.title
    assert warning.advice[0].arguments == {"units": {signal: unit}}
    assert warning.severity == "blocking"


_PER_TURN = {"rad": 2.0 * np.pi, "deg": 360.0, "rev": 1.0, "rpm": 60.0, "deg_s": 360.0}
_PER_TURN |= {"rev_s": 1.0}


@pytest.mark.parametrize(
    ("position", "velocity"),
    [("deg", "rpm"), ("deg", "rev_s"), ("rev", "rpm"), ("deg", "deg_s")],
)
def test_two_unstated_units_are_recognised_together(
    position: str, velocity: str, tmp_path: Path
) -> None:
    run = jid.load(WELL_EXCITED)
    angle = run.position / (2.0 * np.pi) * _PER_TURN[position]
    speed = run.velocity / (2.0 * np.pi) * _PER_TURN[velocity]
    path = tmp_path / "log.csv"
    header = "time_s,position,velocity,torque_Nm,sensor_raw"
    table = np.column_stack([run.time, angle, speed, run.torque, run.sensor])  # type: ignore[list-item]
    np.savetxt(path, table, delimiter=",", header=header, comments="")
    warning = next(each for each in about_units(path) if each.code != "wrong_scale")
    assert warning.severity == "blocking"
    units = warning.advice[0].arguments["units"]
    assert {name: unit.replace("/", "_") for name, unit in units.items()} == {
        "position": position,
        "velocity": velocity,
    }
    assert about_units(path, units) == []


def test_a_large_factor_without_an_explanation_is_blocking(tmp_path: Path) -> None:
    run = jid.load(WELL_EXCITED)
    for factor, severity in ((12.3, "blocking"), (0.5, "blocking"), (1.05, "warning")):
        strange = jid.Recording(
            time=run.time, position=run.position, velocity=factor * run.velocity, torque=run.torque
        )
        found = jid.identify(strange, jid.Joint(inertia=2.5), search="separable").warnings
        (warning,) = (each for each in found if each.code == "velocity_mismatch")
        assert warning.severity == severity
