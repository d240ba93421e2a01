"""What to record next: the promise after a poor recording, what is handed to the design, and the command."""

from __future__ import annotations

import dataclasses
import math
import shlex
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import jointid as jid
from jointid.cli.command_line import main
from jointid.cli.parser import command_parser
from jointid.cli.wording import Wording
from jointid.excitation import next_motion
from jointid.excitation.default_law import default_controller

THESIS = jid.thesis_joint()
TRUE = {"coulomb": 25.0, "static": 20.0, "stribeck": 100.0, "viscous": 20.0}
TRUE |= {"sensor_gain": 2.4, "sensor_offset": 15.0}
LIMITS = {"position": (-math.pi / 3.0, math.pi / 3.0), "velocity": 3.4}
QUICK = jid.DesignSearch(evaluations=200, joints=2, rehearsals=16)


@pytest.fixture(scope="module")
def first(shared_data: Path) -> jid.Recording:
    return jid.load(shared_data / "simulated" / "poorly_excited.csv.gz")


@pytest.fixture(scope="module")
def poor(first: jid.Recording) -> jid.Estimate:
    return jid.identify(first, THESIS)


@pytest.fixture(scope="module")
def design(poor: jid.Estimate) -> jid.Design:
    found = poor.next_motion(LIMITS, 6.0, search=QUICK)
    assert isinstance(found, jid.Design)
    return found


@pytest.mark.parametrize("seed", range(4))
def test_both_recordings_together_are_within_one_per_cent(
    first: jid.Recording, design: jid.Design, seed: int
) -> None:
    joint = THESIS.with_parameters(TRUE)
    sensors = jid.Sensors(torque_noise=0.2)
    second = jid.simulate(joint, design.controller, design.trajectory, sensors=sensors, seed=seed)
    both = jid.identify([first, second], THESIS)
    for name, true in TRUE.items():
        assert both.parameters[name].value == pytest.approx(true, rel=0.01), name
    # The gain was the weakest, and two tenths of its error are left.
    error = abs(both.parameters["sensor_gain"].value - 2.4)
    row = design.parameters["sensor_gain"]
    assert row.before is not None
    assert row.stderr < 0.4 * row.before
    assert error < 4.0 * row.stderr


def test_errors_before_are_the_intervals(poor: jid.Estimate, design: jid.Design) -> None:
    assert set(design.parameters) == set(poor.free)
    for name, row in design.parameters.items():
        interval = poor.parameters[name].interval
        assert interval is not None
        if name == "sensor_offset":  # no motion tells the share of symmetry
            assert row.before is not None
            assert row.before < (interval[1] - interval[0]) / 2.0 / 1.96
            continue
        assert row.before == pytest.approx((interval[1] - interval[0]) / 2.0 / 1.96, rel=1e-3)
        assert row.before is not None
        assert row.stderr < row.before
        assert row.worst >= row.relative
    gain = design.parameters["sensor_gain"]
    share = 100.0 * (gain.before or 0.0) / gain.value
    assert f"weakest before: sensor_gain, {share:.2g} %;" in str(design)
    assert "error before" in str(design)


def test_a_file_of_the_estimate_gives_the_same_motion(
    poor: jid.Estimate, design: jid.Design, tmp_path: Path
) -> None:
    again = jid.Estimate.from_json(poor.to_json()).next_motion(LIMITS, 6.0, search=QUICK)
    assert again.trajectory == design.trajectory
    assert again.parameters == design.parameters
    again.save(tmp_path / "motion.toml")
    assert jid.load_design(tmp_path / "motion.toml").parameters == design.parameters


def test_the_controller_believes_the_estimate(poor: jid.Estimate, design: jid.Design) -> None:
    assert design.controller == default_controller(poor.joint, design.limits.torque or 0.0)
    assert design.sensors.torque_noise == pytest.approx(0.2, rel=0.15)
    assert design.limits.torque == pytest.approx(160.0, rel=1e-3)  # the joint's


def test_one_parameter_may_be_asked_for(poor: jid.Estimate, design: jid.Design) -> None:
    alone = poor.next_motion(LIMITS, 6.0, search=QUICK, parameters=("sensor_gain",))
    assert tuple(alone.parameters) == ("sensor_gain",)
    assert alone.weakest == "sensor_gain"
    assert alone.parameters["sensor_gain"].stderr < design.parameters["sensor_gain"].stderr


class CalledError(Exception):
    """Raised in place of a design."""


@pytest.fixture
def handed(monkeypatch: pytest.MonkeyPatch) -> dict[str, Any]:
    """What the design is called with."""
    arguments: dict[str, Any] = {}

    def caught(joint: jid.Joint, limits: Any, duration: float, **options: Any) -> jid.Design:
        arguments.update(options, joint=joint, limits=limits, duration=duration)
        raise CalledError

    monkeypatch.setattr(next_motion, "design_excitation", caught)
    return arguments


def test_what_is_known_and_possible_is_handed_over(
    poor: jid.Estimate, handed: dict[str, Any]
) -> None:
    search = jid.DesignSearch(joints=5, seed=3)
    with pytest.raises(CalledError):
        poor.next_motion(LIMITS, search=search, control_period=0.002)
    assert handed["duration"] == 12.0
    assert handed["control_period"] == 0.002
    assert len(handed["prior"]) == 48  # as many have to keep the limits
    assert handed["prior"][0] == {n: poor.parameters[n].value for n in handed["known"].names}
    assert set(handed["parameters"]) == set(TRUE)
    assert handed["known"].stderr()["sensor_gain"] == pytest.approx(0.0189, abs=0.001)
    assert handed["joint"].parameters["viscous"].value == poor.parameters["viscous"].value


def test_what_is_given_is_not_overruled(poor: jid.Estimate, handed: dict[str, Any]) -> None:
    controller, sensors = jid.AdaptiveRobust(coulomb=9.0), jid.Sensors(torque_noise=3.0)
    prior = {"viscous": (10.0, 30.0)}
    with pytest.raises(CalledError):
        poor.next_motion(LIMITS, controller=controller, sensors=sensors, prior=prior)
    assert handed["controller"] is controller
    assert handed["sensors"] is sensors
    assert handed["prior"] is prior


def test_what_cannot_be_asked_for(poor: jid.Estimate, first: jid.Recording) -> None:
    with pytest.raises(
        jid.InputError, match="no free parameter of this name; choose one of coulomb"
    ):
        poor.next_motion(LIMITS, parameters=("inertia",))
    with pytest.raises(jid.InputError, match="velocity: this limit is needed"):
        poor.next_motion({"position": (-1.0, 1.0)})
    nothing = np.zeros((0, 0))
    fixed = dataclasses.replace(poor, free=(), covariance=nothing, information=nothing)
    with pytest.raises(jid.InputError, match="the estimate has no free parameter, so no motion"):
        fixed.next_motion(LIMITS)
    bare = jid.identify(first)
    with pytest.raises(jid.InputError, match="the joint has no link; give a joint with its link"):
        bare.next_motion(LIMITS | {"torque": 160.0})


def test_a_link_may_be_given(first: jid.Recording, handed: dict[str, Any]) -> None:
    bare = jid.identify(first)
    with pytest.raises(CalledError):
        bare.next_motion(LIMITS, joint=THESIS)
    assert handed["joint"].link == THESIS.link
    assert "inertia" in handed["parameters"]


def test_advice_is_obeyed(poor: jid.Estimate, handed: dict[str, Any]) -> None:
    """The arguments of the finding, with what only the user knows filled in."""
    (finding,) = [each for each in poor.findings if each.code == "undetermined"]
    (action,) = [each for each in finding.advice if each.designs]
    assert action.arguments["limits"] == {"position": ..., "velocity": ...}
    limits = {"position": (-1.0, 1.0), "velocity": 1.12}
    with pytest.raises(CalledError):
        poor.next_motion(**{**action.arguments, "limits": limits})
    assert handed["duration"] == 6.0
    assert handed["limits"]["velocity"] == 1.12


def test_the_command_does_what_the_finding_says(
    poor: jid.Estimate, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    THESIS.save("joint.toml")
    poor.save("first.json")
    wording = Wording("identify", joint_file="joint.toml", saved="first.json")
    (finding,) = [each for each in poor.findings if each.code == "undetermined"]
    words = wording.of_action(finding.advice[0])
    command = shlex.split(
        words.partition("designed by jointid ")[2]
        .replace("LOW,HIGH", "-1,1")
        .replace("SPEED", "1.12")
    )
    quick = ["--evaluations", "100", "--joints", "2", "--rehearsals", "16"]
    assert main([*command, *quick, "--seed", "4", "--quiet"]) == 0
    design = jid.load_design("motion.toml")
    assert design.duration == pytest.approx(6.0)
    assert design.limits.velocity == 1.12
    assert all(row.before is not None for row in design.parameters.values())
    assert design.controller == default_controller(poor.joint, design.limits.torque or 0.0)
    search = jid.DesignSearch(evaluations=100, joints=2, rehearsals=16, seed=4)
    limits = {"position": (-1.0, 1.0), "velocity": 1.12}
    assert poor.next_motion(limits, 6.0, search=search).trajectory == design.trajectory


def test_every_option_that_a_finding_names_is_one_of_the_command() -> None:
    limits = dict.fromkeys(("position", "velocity", "acceleration", "torque", "sensor_range"), ...)
    action = jid.Action("record", {"limits": limits, "duration": 6.0}, "", "next_motion")
    words = Wording("identify").of_action(action).partition("designed by jointid ")[2]
    read = command_parser().parse_args(shlex.split(words))
    assert read.after == Path("ESTIMATE")
    assert read.sensor_range == "TORQUE"


def test_the_session_s_controller_believes_the_estimate(
    poor: jid.Estimate, handed: dict[str, Any], tmp_path: Path
) -> None:
    """A bench's law is kept, with the estimate's values in place of those that it has."""
    from argparse import Namespace

    from jointid.cli.design_settings import controller_after

    class Bench:
        controller = jid.AdaptiveRobust(bandwidth=33.0, coulomb=1.0)

    none = Namespace(gain=[], controller=None, believe=None)
    bench: Any = Bench()
    law = controller_after(none, poor.joint, bench)
    assert isinstance(law, jid.AdaptiveRobust)
    assert law == jid.AdaptiveRobust(bandwidth=33.0, **jid.control_estimates(poor.joint))
    gained = Namespace(gain=[("viscous", "7")], controller=None, believe=None)
    assert controller_after(gained, poor.joint, bench) == law.replace(viscous=7.0)
    Bench.controller = pd = jid.Pd(stiffness=100.0, damping=10.0)  # type: ignore[assignment]
    assert controller_after(none, poor.joint, bench) == pd
