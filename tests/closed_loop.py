"""The thesis's joint in closed loop, for the tests of the simulator: truth, controller, trajectory."""

import dataclasses
import math
from typing import Any

import jointid as jid

TRUTH = {
    "coulomb": 25.0,
    "static": 20.0,
    "stribeck": 100.0,
    "viscous": 20.0,
    "sensor_gain": 2.4,
    "sensor_offset": 15.0,
}
INERTIA, LINK_INERTIA, WEIGHT = 2.472e-4 * 101**2, 0.25, 3.0 * 9.817 * 0.25


def thesis_joint(**changes: Any) -> jid.Joint:
    """The thesis's joint with its link about the vertical."""
    joint = jid.thesis_joint()
    assert joint.link is not None
    link = dataclasses.replace(joint.link, angle=-math.pi / 2.0)
    return joint.replace(link=link, **changes)


def wrong_controller() -> jid.AdaptiveRobust:
    """As the recordings beside the examples were made."""
    return jid.AdaptiveRobust(
        inertia=INERTIA,
        coulomb=15.0,
        static=10.0,
        stribeck=150.0,
        viscous=10.0,
        sensor_gain=1.5,
        sensor_offset=0.0,
    )


def well_excited(duration: float = 12.0) -> jid.Trajectory:
    return jid.Trajectory.thesis(math.radians(60.0), cycle=3.0, duration=duration)
