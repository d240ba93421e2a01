"""A log in which the joint stands still is refused in one sentence: where, what, and what to do."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from defects import changed
from plain_joint import motion, recorded

import jointid as jid

TIME = motion()[0]
REST = np.full(len(TIME), 0.3)
PUSHED = np.sin(TIME)


@pytest.mark.parametrize("model", ["coulomb_viscous", "stribeck", "stribeck:gravity=free", None])
@pytest.mark.parametrize("velocity", [None, 0.0 * REST, np.cos(TIME)])
def test_a_joint_at_rest_is_refused(model: Any, velocity: np.ndarray | None) -> None:
    run = jid.Recording(time=TIME, position=REST, velocity=velocity, torque=PUSHED, name="bench")
    with pytest.raises(
        jid.InputError, match=r"the joint never moves: its position is 0\.3 rad"
    ) as refused:
        jid.identify(run, model=model) if model else jid.identify(run)
    said = str(refused.value)
    assert said.startswith("recording 0 (bench): ")
    assert "record motion" in said
    assert ("although the velocity reaches 1 rad/s" in said) == (
        velocity is not None and velocity.any()
    )


def test_the_thesis_joint_with_a_closed_brake_is_refused() -> None:
    """Its bounds are computed from the motion, which is none."""
    run = jid.Recording(time=TIME, position=0.0 * REST, torque=PUSHED)
    with pytest.raises(jid.InputError, match="the joint never moves: its position is 0 rad"):
        jid.identify(run, jid.thesis_joint())


def test_one_of_several_joints_at_rest_is_left_out() -> None:
    still = jid.Recording(time=TIME, position=REST, torque=PUSHED, name="parked")
    with pytest.raises(jid.InputError, match=r"recording 1 \(parked\).*leave this recording out"):
        jid.identify([recorded(name="moving"), still])


def test_a_velocity_of_another_unit_is_no_standstill() -> None:
    run = recorded()
    wrong = changed(run, velocity=900.0 * np.asarray(run.velocity))
    with pytest.raises(
        jid.InputError, match=r"velocity: the change of position is 0\.001111 times"
    ) as error:
        jid.identify(wrong)
    assert "side={'velocity': 'motor'}, gear_ratio=900.0" in str(error.value)
