"""Limits of a motion: stated, or the joint's; each that cannot be used is named."""

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

import jointid as jid
from jointid.excitation.motion_limits import MotionLimits
from jointid.joint.link import Limits

JOINT = jid.Joint(sensor=True, limits=Limits(position=(-1.0, 3.0), velocity=4.0, torque=100.0))
STATED: dict[str, Any] = {"position": (-1.0, 1.0), "velocity": 3.4}


def test_what_is_not_stated_is_the_joints() -> None:
    limits = MotionLimits.of(None, JOINT)
    assert limits.position == pytest.approx((-0.8, 2.8))  # nine tenths, about the same middle
    assert limits.velocity == pytest.approx(3.6)
    assert limits.torque == 100.0
    assert limits.acceleration is None
    assert limits.sensor_range is None


def test_what_is_stated_stands() -> None:
    stated = STATED | {"torque": 50.0, "acceleration": 20.0, "sensor_range": 30.0}
    limits = MotionLimits.of(stated, JOINT)
    assert limits == MotionLimits(**stated)
    assert limits.asdict() == stated
    assert MotionLimits.of(limits, JOINT) == limits


def test_the_smaller_of_torque_and_current_counts() -> None:
    joint = jid.Joint(
        torque_constant=0.1, gear_ratio=-100.0, limits=Limits(torque=90.0, current=8.0)
    )
    assert MotionLimits.of(STATED, joint).torque == pytest.approx(80.0)


@pytest.mark.parametrize(
    ("given", "says"),
    [
        (3, "limits is 3: MotionLimits or a mapping of them is expected"),
        (STATED | {"speed": 1.0}, "limits: speed: there is no such limit; choose one of position"),
        (STATED | {"velocty": 1.0}, "did you mean 'velocity'"),
        (STATED | {"position": 1.0}, "limits: position is 1.0: a lowest and a highest"),
        (STATED | {"position": (1.0, 1.0)}, "the first value must be below the second"),
        (STATED | {"position": (1.0, float("nan"))}, "position is nan: a finite number"),
        (STATED | {"velocity": 0.0}, "limits: velocity is 0.0: more than 0"),
        (STATED | {"velocity": "fast"}, "limits: velocity is 'fast': a number"),
        (STATED | {"torque": -1.0}, "limits: torque is -1.0: more than 0"),
    ],
)
def test_limits_that_cannot_be_used_are_named(given: Any, says: str) -> None:
    with pytest.raises(jid.InputError) as refused:
        MotionLimits.of(given, JOINT)
    assert says in str(refused.value)


@pytest.mark.parametrize(
    ("changes", "says"),
    [
        ({"position": np.array([-9.0, 9.0])}, "position is [-9.0, 9.0]: this is outside"),
        (
            {"velocity": np.float32(9.0)},
            "velocity is 9.0: this is above the joint's own limit of 4",
        ),
        ({"velocity": np.int64(9)}, "velocity is 9.0: this is above the joint's own limit of 4"),
    ],
)
def test_limits_of_numpy_are_held_within_the_joints_own(changes: Any, says: str) -> None:
    with pytest.raises(jid.InputError) as refused:
        MotionLimits.of(STATED | changes, JOINT)
    assert says in str(refused.value)


@pytest.mark.parametrize("name", ["position", "velocity", "torque"])
def test_a_limit_that_nobody_states_is_asked_for(name: str) -> None:
    joint = replace(JOINT, limits=Limits())
    stated = {**STATED, "torque": 50.0}
    del stated[name]
    with pytest.raises(
        jid.InputError, match=f"limits: {name}: this limit is needed, but the joint"
    ):
        MotionLimits.of(stated, joint)


def test_a_range_needs_a_sensor() -> None:
    with pytest.raises(
        jid.InputError, match=r"sensor_range is 30\.0: the joint has no torque sensor"
    ):
        MotionLimits.of(STATED | {"sensor_range": 30.0}, replace(JOINT, sensor=False))
