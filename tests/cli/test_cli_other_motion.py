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
WIDER = (
    "jointid design --after first.json --position=-60deg,60deg --velocity 3.4 --output motion.toml"
)
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
    assert "jointid explain undetermined" in printed
    commands = re.findall(r"do: (jointid design .*)", printed)
    if name != "no reversal":  # how wide or fast it may be is for the user to say
        assert not commands
        assert "do: record " in printed
        commands = [WIDER]
    (command,) = commands
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


@pytest.mark.slow
def test_the_demos_first_command_improves_its_weakest_value(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    assert main(["demo"]) == 0
    printed = capsys.readouterr().out
    assert len(printed.splitlines()) <= 16
    assert all(len(line) <= 100 for line in printed.splitlines())
    command = re.search(r"do: (jointid .*)", printed)
    assert command is not None
    assert main([*shlex.split(command[1])[1:], "--quiet"]) == 0
    before = jid.Estimate.load("demo/estimate.json")
    design = jid.load_design("motion.toml")
    recording = jid.simulate(
        design.joint, design.controller, design.trajectory, sensors=design.sensors, seed=3
    )
    after = jid.identify(recording, model="coulomb_viscous")
    for name in ("inertia", "coulomb", "viscous"):
        assert (after[name].stderr or math.inf) < (before[name].stderr or 0.0), name
        assert after[name].value == pytest.approx(design.joint.parameters[name].value, rel=0.05)


@pytest.mark.parametrize("model", ["coulomb_viscous", "stribeck", "stribeck_general"])
def test_every_model_of_the_demo_designs_what_to_record_next(
    model: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    kuka = jid.demo()
    known = kuka.joint.model.replace(name=model)
    jid.identify(kuka.recording, kuka.joint.replace(model=known)).save("first.json")
    command = ["design", "--after", "first.json", "--position=0,0.8", "--velocity", "0.4"]
    assert main([*command, "--torque", "2200", "--output", "motion.toml", *QUICK]) == 0
    assert jid.load_design("motion.toml").trajectory.duration > 0.0
