"""A motion that was designed for another bench is named with what differs, and with nothing else."""

from dataclasses import replace
from typing import Any

import pytest
from closed_loop import TRUTH, thesis_joint

import jointid as jid
from jointid.simulation.designed_for import DesignedFor

JOINT = thesis_joint().with_parameters(TRUTH)
LAW = jid.AdaptiveRobust(**jid.control_estimates(JOINT))
MOTION = jid.Trajectory.thesis(duration=6.0)
FOR = DesignedFor(
    source="motion.toml",
    trajectory=MOTION,
    joint=JOINT,
    controller=LAW,
    control_period=2e-3,
    believed={"coulomb": (20.0, 30.0), "sensor_offset": (-20.0, 20.0)},
)
assert JOINT.link is not None
assert JOINT.rotor_inertia is not None


def warning(**changes: Any) -> str:
    given: dict[str, Any] = {
        "trajectory": MOTION,
        "joint": JOINT,
        "controller": LAW,
        "control_period": 2e-3,
    }
    return FOR.warning(**given | changes)


def test_its_own_bench_is_not_warned_of() -> None:
    assert warning() == ""


@pytest.mark.parametrize(
    ("changes", "says"),
    [
        ({"joint": JOINT.replace(gear_ratio=50.0)}, "gear ratio 101 (here 50)"),
        ({"joint": JOINT.replace(gear_ratio=50.0)}, "inertia 2.522"),
        ({"joint": JOINT.replace(torque_constant=0.3)}, "torque constant 0.198 (here 0.3)"),
        ({"joint": JOINT.replace(torque_constant=None)}, "(here not stated)"),
        ({"joint": JOINT.replace(sensor=False)}, "sensor on (here off)"),
        ({"joint": JOINT.replace(model="coulomb_viscous")}, "(here coulomb_viscous"),
        ({"joint": JOINT.replace(link=None)}, "a joint with a link (here without a link)"),
        ({"joint": JOINT.replace(link=replace(JOINT.link, mass=9.0))}, "link mass 3 (here 9)"),
        (
            {"joint": JOINT.with_parameters({"coulomb": 31.0})},
            "coulomb from 20 to 30 (here 31)",
        ),
        (
            {"joint": JOINT.with_parameters({"sensor_offset": -30.0})},
            "sensor_offset from -20 to 20 (here -30)",
        ),
        ({"controller": jid.Pd()}, "the law adaptive_robust (here pd)"),
        ({"controller": LAW.replace(coulomb=10.0)}, "the controller's coulomb 25 (here 10)"),
        (
            {"controller": LAW.replace(torque_feedback=not LAW.torque_feedback)},
            "the controller's torque feedback on (here off)",
        ),
        ({"control_period": 1e-3}, "period 0.002 s (here 0.001 s)"),
    ],
)
def test_what_differs_is_named(changes: dict[str, Any], says: str) -> None:
    said = warning(**changes)
    assert says in said
    assert said.startswith("motion.toml was designed for ")
    assert said.endswith("design the motion again for this bench")
    assert "\n" not in said


@pytest.mark.parametrize(
    "changes",
    [
        {"trajectory": jid.Trajectory.thesis(duration=5.0)},  # another motion was not designed
        {"joint": None},  # a drive that knows of no joint
        {"joint": JOINT.replace(name="another")},
        {"joint": JOINT.replace(torque_constant=0.1981)},  # printed to fewer digits
        {"joint": JOINT.with_parameters({"coulomb": 29.0, "viscous": 40.0})},
        {"controller": LAW.replace(coulomb=25.1)},
    ],
)
def test_what_moves_no_joint_otherwise_is_not_named(changes: dict[str, Any]) -> None:
    assert warning(**changes) == ""


def test_the_controller_is_named_once() -> None:
    said = warning(controller=LAW.replace(coulomb=10.0, viscous=11.234567))
    assert "for the controller's coulomb 25 (here 10), viscous 20 (here 11.23):" in said


def test_a_controller_without_torque_feedback_believes_nothing_of_the_sensor() -> None:
    silent = LAW.replace(torque_feedback=False)
    other = replace(FOR, controller=silent)
    changed = silent.replace(sensor_gain=1.0)
    assert other.warning(MOTION, JOINT, changed, 2e-3) == ""
    assert "sensor gain 2.4 (here 1)" in warning(controller=LAW.replace(sensor_gain=1.0))


def test_many_differences_are_counted() -> None:
    other = JOINT.replace(gear_ratio=30.0, torque_constant=0.1, link=None)
    said = warning(joint=other, controller=jid.Pd(), control_period=4e-3)
    assert ", and 2 more: its reached values" in said
