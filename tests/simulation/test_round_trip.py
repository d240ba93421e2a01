"""What a joint is simulated with is what the same joint identifies: with and without sensor, link and gravity."""

import math
from typing import Any

import pytest

import jointid as jid

LINK = jid.Link(mass=3.0, centre_of_mass=0.25, inertia=0.25, angle=0.3)
FRICTION = {"coulomb": 25.0, "static": 20.0, "stribeck": 100.0, "viscous": 20.0}


def moved(
    joint: jid.Joint, values: dict[str, float], payload: jid.Link | float
) -> jid.SimulatedRecording:
    return jid.simulate(
        joint.with_parameters(values),
        jid.Pd(stiffness=3000.0, damping=200.0),
        jid.Trajectory.thesis(math.radians(60.0), cycle=3.0, duration=6.0),
        control_period=2.5e-4,
        payload=payload,
    )


@pytest.mark.parametrize("gravity", ["none", "known", "free"])
@pytest.mark.parametrize("link", [LINK, None], ids=["link", "no link"])
@pytest.mark.parametrize("sensor", [False, True], ids=["sensorless", "sensor"])
def test_round_trip(sensor: bool, link: jid.Link | None, gravity: Any) -> None:
    if gravity == "known" and link is None:
        pytest.skip("gravity is known by the link")
    values = dict(FRICTION)
    if gravity == "free":
        values |= {"gravity_cos": 6.0, "gravity_sin": -3.0}
    values |= {"sensor_gain": 2.4, "sensor_offset": 15.0} if sensor else {"torque_offset": 1.5}
    joint = jid.Joint(
        inertia=2.5, link=link, sensor=sensor, model=jid.Model("stribeck", gravity=gravity)
    )
    payload: jid.Link | float = LINK if sensor and link is None else 0.0  # a sensor needs a load
    recording = moved(joint, values, payload)
    estimate = jid.identify(recording, joint, search="separable")
    # A sensor's reading steps with the command; the instant of its sample is not known.
    tolerance = 3e-3 if sensor else 1e-3
    for name, found in estimate.parameters.items():
        true = recording.truth.get(name, found.value)  # known gravity is no parameter of the plant
        assert found.value == pytest.approx(true, rel=tolerance), name
    assert not {"wrong_scale", "model_too_rich"} & {found.code for found in estimate.warnings}
    inertia = 2.5 + (0.25 if link is not None and not sensor else 0.0)
    assert estimate.parameters["inertia"].value == pytest.approx(inertia, rel=1e-12)


def test_an_estimated_inertia_is_the_drives_in_the_joint() -> None:
    """Freed, the inertia contains the link's; the joint must not count the link twice when it is used again."""
    joint = jid.Joint(inertia=2.5, link=LINK, model=jid.Model("stribeck"))
    recording = moved(joint, FRICTION | {"torque_offset": 0.0}, 0.0)
    free = jid.identify(
        recording, joint, parameters={"inertia": {"vary": True, "value": None}}, search="separable"
    )
    assert free.parameters["inertia"].value == pytest.approx(2.75, rel=1e-3)
    assert free.joint.inertia == pytest.approx(2.5, rel=1.2e-3)
    assert free.joint.known_inertia == pytest.approx(2.75, rel=1e-3)
    prismatic = jid.Joint(
        kind="prismatic", inertia=2.0, link=jid.Link(mass=3.0, centre_of_mass=0.0)
    )
    assert prismatic.known_inertia == 5.0
