"""A motion of many turns there and back is what wheels, spindles and benches do: no guess overrides stated units."""

from __future__ import annotations

from typing import Any

import pytest
from plain_joint import INERTIA, VISCOUS, motion, recorded, torque

import jointid as jid
from jointid.estimate.findings import Finding

UNSTATED: dict[str, Any] = {"assumed_units": ["position", "velocity"]}


def turning(
    amplitude: float, seed: int = 0, *, velocity: bool = True, **metadata: Any
) -> jid.Recording:
    time, position, rate, acceleration = motion(amplitude=amplitude, seed=seed)
    return jid.Recording(
        time=time,
        position=position,
        velocity=rate if velocity else None,
        torque=torque(rate, acceleration),
        metadata=metadata,
    )


def of_units(estimate: jid.Estimate) -> list[Finding]:
    return [each for each in estimate.findings if each.code == "implausible_units"]


@pytest.mark.parametrize(("amplitude", "seed"), [(30.0, 0), (60.0, 1), (200.0, 2)])
@pytest.mark.parametrize("velocity", [True, False])
def test_many_turns_in_stated_units_are_usable(amplitude: float, seed: int, velocity: bool) -> None:
    estimate = jid.identify(turning(amplitude, seed, velocity=velocity))
    (found,) = of_units(estimate)
    assert found.severity == "info"
    assert estimate.verdict.level != "not usable"
    for name, value in (("inertia", INERTIA), ("viscous", VISCOUS)):
        assert estimate.parameters[name].value == pytest.approx(value, rel=0.03)


def test_a_velocity_of_stated_unit_speaks_for_the_position() -> None:
    estimate = jid.identify(turning(30.0, assumed_units=["position"]))
    assert [each.severity for each in of_units(estimate)] == ["info"]


def test_two_columns_of_no_stated_unit_agree_in_degrees_too() -> None:
    (found,) = of_units(jid.identify(turning(30.0, **UNSTATED)))
    assert found.severity == "blocking"
    assert {"units": {"position": "deg", "velocity": "deg/s"}} in [
        dict(each.arguments) for each in found.advice
    ]


def test_many_turns_of_no_stated_unit_and_no_velocity_are_asked_about() -> None:
    (found,) = of_units(jid.identify(turning(30.0, velocity=False, **UNSTATED)))
    assert found.severity == "blocking"


def test_a_few_turns_are_not_spoken_of() -> None:
    assert of_units(jid.identify(recorded(amplitude=8.0))) == []
