"""Tables of steady speeds and torques: `identify` and `info` print their friction."""

import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from jointid.cli.command_line import main

Array = np.ndarray[Any, np.dtype[np.float64]]
SPEEDS = np.concatenate([-np.geomspace(0.02, 3.0, 20), np.geomspace(0.02, 3.0, 20)])
RPM = 30.0 / np.pi


def friction(
    v: Array, coulomb: tuple[float, float] = (0.8, 0.8), static: float = 0.0, seed: int = 0
) -> Array:
    """Coulomb friction forward and backward, static 20 s²/rad² wide, and viscous 0.3."""
    level = np.where(v > 0.0, *coulomb) + static * np.exp(-20.0 * v**2)
    noise = np.random.default_rng(seed).normal(0.0, 0.01, len(v))
    return np.asarray(np.sign(v) * level + 0.3 * v + noise)


def table(path: Path, v: Array, torque: Array, header: str = "speed_rad_s,torque_Nm") -> Path:
    rows = [f"{a:.9g},{b:.9g}" for a, b in zip(v, torque, strict=True)]
    path.write_text("\n".join([header, *rows]))
    return path


def fitted(
    path: Path, capsys: pytest.CaptureFixture[str], command: str = "identify"
) -> Mapping[str, Any]:
    assert main([command, str(path), "--json"]) == 0
    found: Mapping[str, Any] = json.loads(capsys.readouterr().out)["friction_map"]
    return found


def inside(found: Mapping[str, Any], right: Mapping[str, float]) -> None:
    assert set(found["parameters"]) == set(right)
    for name, value in right.items():
        low, high = found["parameters"][name]["interval"]
        half = high - low
        assert low - half <= value <= high + half, name
        assert half < 0.2 * value, name


@pytest.mark.parametrize("command", ["identify", "info"])
@pytest.mark.parametrize("scattered", [False, True])
def test_coulomb_and_viscous_friction(
    command: str, scattered: bool, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    v = np.random.default_rng(5).uniform(-3.0, 3.0, 60) if scattered else SPEEDS
    found = fitted(table(tmp_path / "a.csv", v, friction(v)), capsys, command)
    inside(found, {"coulomb": 0.8, "viscous": 0.3})
    assert found["directions"] == 2


def test_each_direction_has_its_own_where_they_differ(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = table(tmp_path / "a.csv", SPEEDS, friction(SPEEDS, (0.9, 0.7)))
    inside(
        fitted(path, capsys),
        {"coulomb_positive": 0.9, "coulomb_negative": 0.7, "viscous": 0.3},
    )
    assert main(["identify", str(path)]) == 0
    assert "an offset of the torque looks like a difference" in capsys.readouterr().out


def test_stribeck_friction_is_found_where_it_shows(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = table(tmp_path / "a.csv", SPEEDS, friction(SPEEDS, static=0.5))
    inside(fitted(path, capsys), {"coulomb": 0.8, "static": 0.5, "viscous": 0.3, "stribeck": 20.0})


def test_units_one_direction_and_rows_at_rest(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    v = np.linspace(0.0, 3.0, 13)
    path = table(tmp_path / "a.csv", v * RPM, friction(v) * 1000.0, "velocity [rpm];friction [mNm]")
    path.write_text(path.read_text().replace(",", ";"))
    found = fitted(path, capsys)
    inside(found, {"coulomb": 0.8, "viscous": 0.3})
    assert (found["directions"], found["rows"], found["at_rest"]) == (1, 12, 1)


def test_the_report_says_what_is_not_in_it(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = table(tmp_path / "a.csv", SPEEDS, -friction(SPEEDS))
    assert main(["identify", str(path)]) == 0
    said = capsys.readouterr().out
    assert "missing    inertia and gravity" in said
    assert "friction is negative: the torque must have the sign of the speed" in said


@pytest.mark.parametrize(
    ("header", "options", "reason"),
    [
        # A column that nobody knows may be the position: a log, and no table of steady speeds.
        ("clock,speed,torque", [], "no position column"),
        ("time,speed,torque", [], "no position column"),
        ("speed,torque", ["--save", "a.toml"], "--save: this file is a table of steady speeds"),
        ("speed,torque", ["--model", "stribeck"], "--model: this file is a table of steady speeds"),
        ("speed,torque", ["--where=speed=1"], "--where: this file is a table of steady speeds"),
    ],
)
def test_other_tables_are_refused_as_before(
    header: str,
    options: list[str],
    reason: str,
    tmp_path: Path,
    capsys: pytest.CaptureFixture[str],
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.chdir(tmp_path)
    columns = [SPEEDS, friction(SPEEDS)]
    if header.count(",") == 2:
        columns.insert(0, np.arange(len(SPEEDS)))
    rows = [",".join(map(repr, row)) for row in np.column_stack(columns).tolist()]
    Path("a.csv").write_text("\n".join([header, *rows]))
    assert main(["identify", "a.csv", *options]) == 2
    assert reason in capsys.readouterr().err


def test_too_few_rows_are_counted(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    v = np.array([1.0, 2.0, 0.0])
    assert main(["identify", str(table(tmp_path / "a.csv", v, v))]) == 2
    assert "2 rows with 2 different speeds above 0" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("header", "options", "assumed"),
    [
        ("speed,torque", [], ["velocity", "torque"]),
        ("rpm,torque_Nm", ["--column", "velocity=rpm"], ["velocity"]),
        ("speed,torque_Nm", ["--unit", "velocity=rpm"], []),
        ("speed,torque_Nm", ["--scale", "velocity=0.1"], []),
    ],
)
def test_units_that_nobody_states_are_said(
    header: str,
    options: list[str],
    assumed: list[str],
    tmp_path: Path,
    capsys: pytest.CaptureFixture[str],
) -> None:
    path = table(tmp_path / "a.csv", SPEEDS, friction(SPEEDS), header)
    assert main(["identify", str(path), *options]) == 0
    said = capsys.readouterr().out
    assert ("SI units assumed" in said) == bool(assumed)
    assert main(["identify", str(path), *options, "--json"]) == 0
    assert json.loads(capsys.readouterr().out)["friction_map"]["assumed"] == assumed
