"""A limit that is not kept is named: which, by how much, and by which of the joints drawn."""

import re
from typing import Any

import numpy as np
import pytest
from closed_loop import TRUTH, thesis_joint
from designs import motion

import jointid as jid
from jointid.excitation.holding import shrunk
from jointid.excitation.judging import Situation
from jointid.excitation.motion_limits import MotionLimits
from jointid.excitation.prior import ranges_of
from jointid.excitation.request import request_of

JOINT = thesis_joint()
REQUEST = request_of(JOINT, None)
RANGES = {name: (0.8 * TRUTH[name], 1.2 * TRUTH[name]) for name in REQUEST.names}
LAW = jid.AdaptiveRobust(**jid.control_estimates(JOINT.with_parameters(TRUTH)))


def situation(controller: Any = LAW, **limits: Any) -> Situation:
    """The thesis's joint, each parameter known to 20 %."""
    usual: dict[str, Any] = {"position": (-1.2, 1.2), "velocity": 3.4, "torque": 160.0}
    return Situation(
        joint=JOINT,
        request=REQUEST,
        ranges=ranges_of(JOINT, REQUEST.names, RANGES),
        limits=MotionLimits(**usual | limits),
        controller=controller,
        sensors=jid.Sensors(torque_noise=0.5),
        duration=6.0,
        control_period=1e-3,
        criterion="worst",
        known=np.zeros((len(REQUEST.names), len(REQUEST.names))),
    )


@pytest.fixture(autouse=True)
def _one_step(monkeypatch: pytest.MonkeyPatch) -> None:
    """The motion is not made smaller."""
    monkeypatch.setattr("jointid.excitation.holding._STEPS", 1)


def problem(where: Situation) -> str:
    return shrunk(where, motion(), 0, 1)[2]


def test_limits_that_are_kept_are_no_problem() -> None:
    assert problem(situation()) == ""


@pytest.mark.parametrize(
    ("limits", "says"),
    [
        ({"position": (-0.5, 0.5)}, r"the position reaches -\d.* rad, outside -0\.5 to 0\.5 rad"),
        ({"velocity": 1.0}, r"the velocity reaches [\d.]+ rad/s, \d+ % more than the limit of 1 "),
        ({"sensor_range": 5.0}, r"the torque at the torque sensor reaches [\d.]+ N·m, \d+ % more"),
        ({"torque": 70.0}, r"the torque would have to be [\d.]+ N·m, \d+ % more than the limit of"),
    ],
)
def test_the_limit_is_named_with_the_joint(limits: dict[str, Any], says: str) -> None:
    found = problem(situation(**limits))
    assert re.match(says, found), found
    values = dict(part.rsplit(" ", 1) for part in found.partition("a joint with ")[2].split(", "))
    assert set(values) == set(REQUEST.names)
    for name, value in values.items():
        assert 0.79 * TRUTH[name] <= float(value) <= 1.21 * TRUTH[name]


def test_the_torque_that_is_needed_is_that_without_the_drives_limit() -> None:
    needed = float(problem(situation(torque=70.0)).split("have to be ")[1].split()[0])
    reached = shrunk(situation(torque=1000.0), motion(), 0, 1)[1].torque
    assert 70.0 < needed <= 1.02 * reached


def test_the_acceleration_is_the_references_and_of_no_joint() -> None:
    found = problem(situation(acceleration=1.0))
    assert found.startswith("the acceleration of the reference reaches ")
    assert found.endswith(" times the limit of 1 rad/s²")


def test_a_loop_that_is_not_stable_is_named_with_its_joint() -> None:
    found = problem(situation(jid.Pd(stiffness=1e12), torque=1e100))
    assert found.startswith("the loop is not stable, for a joint with coulomb ")
