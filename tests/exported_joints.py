"""Joints of every kind that exports are tested on, with values, and an estimate of one."""

from __future__ import annotations

import functools

from every_model import MODELS, joint_of
from example_recordings import WELL_EXCITED

import jointid as jid

STRIBECK = {"coulomb": 25.0, "static": 20.0, "stribeck": 100.0, "viscous": 20.0}
PLAIN = {"coulomb": 3.1, "viscous": 1.7}

THESIS = jid.thesis_joint().with_parameters({**STRIBECK, "sensor_gain": 2.4, "sensor_offset": 15.0})
LOADED = jid.Joint(
    name="loaded joint",
    gear_ratio=-100.0,
    rotor_inertia=2e-5,
    torque_constant=0.11,
    model=jid.Model("coulomb_viscous", gravity="known"),
    link=jid.Link(mass=2.5, centre_of_mass=0.21, angle=0.4, inertia=0.15),
    limits=jid.Limits(torque=60.0, velocity=2.5, position=(-2.0, 2.0)),
).with_parameters(PLAIN)
EVERYTHING = jid.Joint(
    name="1: \u00e4 */ joint *) --> ??/",
    gear_ratio=-51.0,
    inertia=1.3,
    model=jid.Model(
        "stribeck_general",
        gravity="free",
        asymmetric=True,
        ripple=(2, 4.5),
        harmonics=(3,),
        load_friction=True,
    ),
).with_parameters(
    {
        "coulomb_positive": 5.0,
        "coulomb_negative": 4.0,
        "static_positive": 2.0,
        "static_negative": 1.0,
        "viscous_positive": 3.0,
        "viscous_negative": 3.5,
        "stribeck_velocity": 0.07,
        "stribeck_exponent": 1.3,
        "load_friction": 0.08,
        "torque_offset": -1.25,
        "gravity_cos": 6.0,
        "gravity_sin": -2.0,
        "position_cos_3": 0.4,
        "position_sin_3": -0.3,
        "ripple_cos_2": 0.5,
        "ripple_sin_2": 1e-05,
        "ripple_cos_4.5": -0.25,
        "ripple_sin_4.5": 0.125,
    }
)
SLIDING = jid.Joint(
    name="slide",
    kind="prismatic",
    gear_ratio=300.0,
    inertia=12.0,
    model=jid.Model("coulomb_viscous"),
    limits=jid.Limits(torque=400.0, velocity=0.8, position=(-0.5, 1.5)),
).with_parameters({"coulomb": 14.0, "viscous": 90.0, "torque_offset": 3.0})

JOINTS = {"thesis": THESIS, "loaded": LOADED, "everything": EVERYTHING, "sliding": SLIDING}
JOINTS |= {name: joint_of(name) for name in MODELS}


@functools.cache
def shipped_estimate() -> jid.Estimate:
    """The estimate of a recording that ships with jointid."""
    return jid.identify(jid.load(WELL_EXCITED), jid.thesis_joint())
