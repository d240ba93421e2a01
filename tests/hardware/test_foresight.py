"""Where a joint would stop that nobody has seen for a while: by the motion of constant torque."""

from types import SimpleNamespace
from typing import Any

import pytest

from jointid.hardware.session.foresight import Foresight
from jointid.hardware.session.stop import LimitError

INERTIA, BRAKING = 2.0, 40.0  # kg·m², rad/s²


def stop_of(velocity: float, age: float, accepted: float) -> float:
    """Seen at 0.4 rad in a window that it leaves in any case."""
    limits: Any = SimpleNamespace(torque=100.0, position=(0.39, 0.41))
    joint: Any = SimpleNamespace(inertia=INERTIA, braking=lambda _: (BRAKING, BRAKING))
    foresight = Foresight(limits, 1e-3, joint, 0.0)
    with pytest.raises(LimitError):
        foresight.moving(0.4, velocity, 0.0)
    with pytest.raises(LimitError) as caught:
        foresight.unseen(age, accepted)
    measured = caught.value.measured
    assert measured is not None
    return float(measured)


@pytest.mark.parametrize("side", [1.0, -1.0])
def test_what_drives_an_unseen_joint_on_counts_and_what_brakes_it_does_not(side: float) -> None:
    age, torque = 0.05, 20.0
    gained = torque / INERTIA * age
    idle = stop_of(2.0 * side, age, 0.0)
    assert stop_of(2.0 * side, age, -torque * side) == idle
    # Driven on for the same time: the way on it, and what is gained then takes its way to brake.
    driven = stop_of(2.0 * side, age, torque * side)
    later = stop_of((2.0 + gained) * side, 0.0, torque * side)
    way = (2.0 * age + 0.5 * gained * age) * side
    assert driven == pytest.approx(later + way, rel=1e-12)
    assert side * driven > side * idle
