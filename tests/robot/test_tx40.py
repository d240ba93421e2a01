"""The published friction of a Stäubli TX40, from its motors' positions and torques."""

import json
from pathlib import Path

import numpy as np
import pytest

import jointid as jid

pytest.importorskip("pinocchio")

# Values: figaroh-plus, for the recording of Janot, Vandanjon and Gautier.
VISCOUS = [8.05, 5.53, 1.97, 1.11, 1.86]
COULOMB = [7.14, 8.26, 6.34, 2.48, 3.03]
MOTOR_6 = {"motor_viscous": (0.616, 0.05), "motor_coulomb": (1.95, 0.08)}


@pytest.fixture(name="estimate", scope="module")
def _estimate(shared_data: Path) -> jid.RobotEstimate:
    coupled = np.eye(6)
    coupled[5, 4] = 1.0  # motor 6 turns with joints 5 and 6
    robot = jid.Robot.from_urdf(
        shared_data / "tx40" / "tx40.urdf",
        gear_ratios=[32, 32, 45, -48, 45, 32],
        couplings=coupled,
    )
    recording = jid.load_robot(shared_data / "tx40" / "tx40.csv.gz")
    return jid.identify_robot(recording, robot, inertia="free")


def test_the_published_friction_comes_back(estimate: jid.RobotEstimate) -> None:
    for number, (viscous, coulomb) in enumerate(zip(VISCOUS, COULOMB, strict=True), 1):
        parameters = estimate.joints[f"joint_{number}"].parameters
        for name, published, share in (
            ("viscous", viscous, 0.05),
            ("coulomb", coulomb, 0.08),
        ):
            _assert_near(parameters[name], published, share)
    for name, (published, share) in MOTOR_6.items():
        _assert_near(estimate.joints["joint_6"].parameters[name], published, share)


def _assert_near(found: object, published: float, share: float) -> None:
    value, error = found.value, found.stderr  # type: ignore[attr-defined]
    assert abs(value - published) <= max(share * published, 2.0 * error), (found, published)


def test_another_zero_is_found_and_named(estimate: jid.RobotEstimate) -> None:
    """The controller's zero is the upright arm, the URDF's another pose; the URDF's inertias then fit badly."""
    turned = next(each for each in estimate.findings if each.code == "turned_zero")
    assert turned.evidence["before"].value > 0.2 > 0.08 > turned.evidence["after"].value
    offsets = np.rad2deg(estimate.settings["zero_offsets"])
    np.testing.assert_allclose(offsets, [0, -90, 90, 0, 0, 0], atol=1e-9)
    (advice,) = turned.advice
    assert list(advice.arguments) == ["zero_offsets"]


def test_standing_still_is_reported_and_left_out(estimate: jid.RobotEstimate) -> None:
    (standing,) = (each for each in estimate.findings if each.code == "standing")
    assert list(standing.evidence) == list(estimate.joints)
    for joint in estimate.joints.values():
        assert 0.19 < joint.residuals.left_out < 0.27
        assert joint.windows.stop.max() < 7.8  # the last 1.5 s


def test_the_document_is_whole(estimate: jid.RobotEstimate, tmp_path: Path) -> None:
    document = json.loads(estimate.save(tmp_path / "tx40.json").read_text(encoding="utf-8"))
    found = document["joints"]["joint_1"]["parameters"]["coulomb"]["value"]
    assert found == estimate.joints["joint_1"].parameters["coulomb"].value
    assert len(document["covariance"]) == len(document["free"]) == len(estimate.free)
    assert "joint_6" in estimate.report()


@pytest.mark.slow
def test_a_coupling_that_is_not_told_is_named(shared_data: Path) -> None:
    robot = jid.Robot.from_urdf(
        shared_data / "tx40" / "tx40.urdf", gear_ratios=[32, 32, 45, -48, 45, 32]
    )
    found = jid.identify_robot(jid.load_robot(shared_data / "tx40" / "tx40.csv.gz"), robot)
    (said,) = (each for each in found.findings if each.code == "wrong_coupling")
    (advice,) = said.advice
    assert advice.arguments["couplings"] == {"joint_6": {"joint_5": 1.0}}


def test_nothing_wrong_is_named_of_right_facts(estimate: jid.RobotEstimate) -> None:
    # A real arm: what is left is no noise, and no fact explains it; friction grows with the load.
    named = {"turned_zero", "undetermined", "unexamined_causes", "load_friction"}
    named |= {"slow_motion", "smooth_friction"}
    assert {each.code for each in estimate.warnings} <= named
    assert estimate.settings["shift"] == {}
