"""A known inertia is doubted where the recording contradicts it, and not where it merely cannot tell."""

import math
import re

import numpy as np
import pytest
from closed_loop import TRUTH, thesis_joint
from example_recordings import WELL_EXCITED
from plain_joint import INERTIA, recorded

import jointid as jid

HANGING, LEVEL = thesis_joint(), jid.thesis_joint()


def moved(
    joint: jid.Joint, amplitude: float, law: str, *, noise: float, cycle: float = 3.0
) -> jid.Recording:
    """The joint [°]."""
    true = joint.with_parameters(TRUTH)
    controller = (
        jid.Pd(stiffness=3000.0, damping=200.0)
        if law == "pd"
        else jid.AdaptiveRobust(**jid.control_estimates(true))
    )
    motion = jid.Trajectory.thesis(math.radians(amplitude), cycle=cycle, duration=12.0)
    return jid.simulate(true, controller, motion, sensors=jid.Sensors(torque_noise=noise), seed=1)


def codes(recording: jid.Recording, joint: jid.Joint) -> set[str]:
    return {warning.code for warning in jid.identify(recording, joint).warnings}


@pytest.mark.parametrize("bounded", [True, False])
@pytest.mark.parametrize("noise", [0.0, 0.5])
@pytest.mark.parametrize("law", ["pd", "robust"])
@pytest.mark.parametrize("amplitude", [3.0, 10.0, 20.0])
@pytest.mark.parametrize("joint", [HANGING, LEVEL], ids=["hanging", "level"])
def test_a_right_inertia_is_not_doubted(
    joint: jid.Joint, amplitude: float, law: str, noise: float, bounded: bool
) -> None:
    # A sensor that hardly varies beside its noise leaves the link's inertia to the joint's; a motion
    # that creeps leaves the inertia to friction.
    known = joint if bounded else joint.replace(parameters={})
    for cycle in (3.0, 13.0):
        recording = moved(joint, amplitude, law, noise=noise, cycle=cycle)
        assert not codes(recording, known) & {"wrong_scale", "implausible_units", "reversed_sign"}


@pytest.mark.parametrize("factor", [0.5, 0.9, 1.1, 2.0])
@pytest.mark.parametrize(("joint", "amplitude"), [(HANGING, 20.0), (HANGING, 60.0), (LEVEL, 60.0)])
@pytest.mark.parametrize("law", ["pd", "robust"])
def test_a_wrong_inertia_is(joint: jid.Joint, amplitude: float, law: str, factor: float) -> None:
    recording = moved(joint, amplitude, law, noise=0.5)
    assert joint.rotor_inertia is not None
    wrong = joint.replace(rotor_inertia=factor * joint.rotor_inertia)
    (wording,) = (w for w in jid.identify(recording, wrong).warnings if w.code == "wrong_scale")
    stated = re.search(r"([\d.]+) times the", wording.message)
    assert stated is not None
    assert float(stated[1]) == pytest.approx(1.0 / factor, rel=0.03)


@pytest.mark.parametrize("factor", [1e-3, 0.1, 0.5, 2.0, 10.0, 1e3])
@pytest.mark.parametrize("sensor", [True, False])
def test_a_torque_in_another_unit_is_not_usable(factor: float, sensor: bool) -> None:
    whole = jid.load(WELL_EXCITED)
    assert whole.torque is not None
    run = jid.Recording(
        time=whole.time,
        position=whole.position,
        velocity=whole.velocity,
        torque=factor * whole.torque,
        sensor=whole.sensor if sensor else None,
    )
    # The default model, which says little of this joint: the misfit has a cause with a name, and is blocking all the
    # same.
    estimate = jid.identify(run, jid.Joint(rotor_inertia=2.472e-4, gear_ratio=101, sensor=sensor))
    blocking = {found.code for found in estimate.findings if found.severity == "blocking"}
    assert blocking & {"wrong_scale", "poor_fit"}
    assert estimate.verdict.level == "not usable"


@pytest.mark.parametrize("factor", [0.7, 1.06, 1.4])
def test_a_torque_of_another_scale_concerns_every_value_in_units_of_torque(factor: float) -> None:
    run = recorded()
    run = jid.Recording(
        time=run.time,
        position=run.position,
        velocity=run.velocity,
        torque=factor * np.array(run.torque),
    )
    estimate = jid.identify(run, jid.Joint(inertia=INERTIA))
    (wording,) = (each for each in estimate.findings if each.code == "wrong_scale")
    assert set(wording.parameters) >= {"inertia", "coulomb", "viscous", "torque_offset"}
