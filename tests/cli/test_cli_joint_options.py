"""A first identification without a joint file: its usual facts as options, which errors name."""

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from command_line_answers import answer
from example_recordings import WELL_EXCITED

import jointid as jid
from jointid.cli.command_line import main

WELL = str(WELL_EXCITED)


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A joint with the drive's current, and a link that hangs on it, without a sensor."""
    monkeypatch.chdir(tmp_path)
    time = np.arange(0.0, 12.0, 0.002)
    position = 0.8 * np.sin(1.7 * time) + 0.3 * np.sin(4.1 * time)
    velocity = np.gradient(position, time)
    torque = 0.9 * np.gradient(velocity, time) + 3.0 * np.tanh(50.0 * velocity) + 1.5 * velocity
    torque += 2.0 * 9.80665 * 0.25 * np.sin(position)
    table = np.column_stack([time, position, velocity, torque / (0.2 * 50.0)])
    header = "time_s,position_rad,velocity_rad_s,current_A"
    np.savetxt("current.csv", table, delimiter=",", header=header, comments="")
    return tmp_path


def found(capsys: pytest.CaptureFixture[str], *words: str) -> dict[str, Any]:
    assert main([*words, "--json", "--quiet"]) == 0
    document: dict[str, Any] = json.loads(capsys.readouterr().out)
    return document


def test_a_current_needs_two_facts(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    code, sentence = answer(["identify", "current.csv", "--quiet"], capsys)
    assert code == 2
    assert "identify with --torque-constant VALUE --gear-ratio RATIO" in sentence
    facts = ("--torque-constant", "0.2", "--gear-ratio", "50")
    parameters = found(capsys, "identify", "current.csv", *facts)["parameters"]
    assert parameters["coulomb"]["value"] == pytest.approx(3.0, rel=0.1)
    assert parameters["viscous"]["value"] == pytest.approx(1.5, rel=0.1)


def test_the_weight_of_a_stated_link_is_known(
    folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    drive = ("--torque-constant", "0.2", "--gear-ratio", "50")
    facts = (*drive, "--mass", "2", "--centre-of-mass", "0.25", "--link-angle=-90deg")
    document = found(capsys, "identify", "current.csv", *facts, "--model", "coulomb_viscous")
    gravity = document["parameters"]["gravity_sin"]
    assert (gravity["vary"], gravity["value"]) == (False, pytest.approx(2.0 * 9.80665 * 0.25))
    assert document["parameters"]["coulomb"]["value"] == pytest.approx(3.0, rel=0.1)


def test_options_are_as_a_joint_file(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """The same bits, and an option wins over the file."""
    facts = {"gear_ratio": 101.0, "rotor_inertia": 2.472e-4}
    jid.Joint(sensor=True, **facts).save("joint.toml")  # type: ignore[arg-type]
    jid.Joint(sensor=True, gear_ratio=7.0, rotor_inertia=2.472e-4).save("other.toml")
    options = ("--gear-ratio", "101", "--rotor-inertia", "2.472e-4")
    line = ("identify", WELL, "--model", "stribeck")
    by_file = found(capsys, *line, "--joint", "joint.toml")["parameters"]
    assert found(capsys, *line, *options)["parameters"] == by_file
    corrected = (*line, "--joint", "other.toml", "--gear-ratio", "101")
    assert found(capsys, *corrected)["parameters"] == by_file
    assert by_file["inertia"]["vary"] is False


def test_compare_takes_them_too(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    line = ("compare", WELL, "--model", "coulomb_viscous", "--folds", "2")
    assert (
        found(capsys, *line, "--inertia", "2.5217")["estimate"]["parameters"]["inertia"]["value"]
        == 2.5217
    )


@pytest.mark.parametrize("command", ["identify", "compare"])
@pytest.mark.parametrize(
    ("options", "says"),
    [
        ("--gear-ratio 0", "--gear-ratio 0"),
        ("--torque-constant -1", "--torque-constant -1"),
        ("--torque-constant strong", "--torque-constant"),
        ("--rotor-inertia nan", "--rotor-inertia nan"),
        ("--inertia free", "--inertia free"),
        ("--inertia 2 --rotor-inertia 3", "--inertia 2"),
        ("--mass 2", "add --centre-of-mass VALUE"),
        ("--mass -2 --centre-of-mass 1", "--mass -2"),
        ("--mass 1 --centre-of-mass 1 --link-angle up", "--link-angle"),
    ],
)
def test_an_error_names_the_option(
    command: str, options: str, says: str, capsys: pytest.CaptureFixture[str]
) -> None:
    code, sentence = answer([command, WELL, "--quiet", *options.split()], capsys)
    assert code == 2
    assert says in sentence, sentence
