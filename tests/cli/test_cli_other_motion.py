"""The command that a finding prints is executed as it stands, and the motion that it designs heals the finding."""

import math
import re
import shlex
from pathlib import Path

import pytest
from closed_loop import TRUTH

import jointid as jid
from jointid.cli.command_line import main

THESIS = jid.thesis_joint()
TRUE = THESIS.with_parameters(TRUTH)
LAW = jid.AdaptiveRobust(**jid.control_estimates(TRUE))
SENSORS = jid.Sensors(torque_noise=0.2)
QUICK = ["--evaluations", "300", "--rehearsals", "40", "--quiet"]
# What only the user knows.
FILLED = {"LOW,HIGH": "-60deg,60deg", "SPEED": "3.4"}
MOTIONS = {
    "too slow": jid.Trajectory.thesis(math.radians(60.0), cycle=120.0, duration=30.0),
    "too short a range": jid.Trajectory.thesis(math.radians(3.0), cycle=3.0, duration=6.0),
    "no reversal": jid.Trajectory.sigmoid(math.radians(60.0), rise=4.0, duration=5.0),
}


@pytest.mark.parametrize(
    "name",
    [
        pytest.param("too slow", marks=pytest.mark.slow),
        "too short a range",
        "no reversal",
    ],
)
def test_the_printed_command_designs_the_motion_that_is_missing(
    name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    THESIS.save("joint.toml")
    first = jid.simulate(TRUE, LAW, MOTIONS[name], sensors=SENSORS)
    first.save("first.csv")
    words = ["identify", "first.csv", "--joint", "joint.toml", "--save", "first.json", "--quiet"]
    assert main(words) == 0
    printed = "".join(capsys.readouterr())
    assert "warning (undetermined)" in printed
    (command,) = set(re.findall(r"jointid design .*? --output motion\.toml", printed))
    for unknown, value in FILLED.items():
        command = command.replace(unknown, value)
    assert "..." not in command
    assert main([*shlex.split(command)[1:], *QUICK]) == 0
    design = jid.load_design("motion.toml")
    second = jid.simulate(TRUE, LAW, design.trajectory, sensors=SENSORS, seed=7)
    low, high = design.limits.position
    assert low <= second.position.min() <= second.position.max() <= high
    second.save("second.csv")
    capsys.readouterr()
    words = ["identify", "first.csv", "second.csv", "--joint", "joint.toml", "--model", "stribeck"]
    assert main([*words, "--save", "both.json", "--quiet"]) == 0
    assert "undetermined" not in "".join(capsys.readouterr())
    both = jid.Estimate.load("both.json")
    for parameter, true in TRUTH.items():
        assert both.parameters[parameter].value == pytest.approx(true, rel=0.01), parameter
