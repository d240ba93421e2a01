"""Reference values of a joint's law: motions and their torques."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from jointid.exports.subject import Subject


@dataclass(frozen=True, slots=True, kw_only=True)
class Reference:
    """One motion and its torques."""

    position: float
    velocity: float
    acceleration: float
    load: float
    reading: float
    width: float  # width of the smooth sign; 0: the exact sign
    friction: float
    position_torque: float
    torque: float
    sensor_torque: float


def speed_scale(subject: Subject) -> float:
    """Return the largest speed of the tables: the recorded one, or 1 if it is unknown."""
    return subject.speed or 1.0


def smooth_width(subject: Subject) -> float:
    """Return the speed below which a smooth sign fades: 1 % of the recorded range."""
    return 0.01 * speed_scale(subject)


def reference_values(subject: Subject) -> tuple[Reference, ...]:
    """Return motions in both directions, at rest, slow and fast, and their torques."""
    law, peak = subject.law, speed_scale(subject)
    shares = [0.0, 1e-6, 0.003, 0.03, 0.1, 0.25, 0.5, 1.0]
    signed = [sign * share for share in shares for sign in ((1.0, -1.0) if share else (1.0,))]
    rows = []
    for number, share in enumerate(signed):
        for smooth in (False, True):
            turn = 0.37 * number - 2.0
            velocity, position = (
                share * peak,
                turn if subject.joint.kind == "revolute" else turn / 10.0,
            )
            acceleration, load, reading = 0.5 - 0.1 * number, 2.0 * number - 11.0, 3.0 - number
            width = smooth_width(subject) if smooth else 0.0
            friction = float(law.friction_torque(velocity, load, width=width)[0])
            over = float(law.position_torque(position)[0])
            gain, offset = law.sensor or (0.0, 0.0)
            rows.append(
                Reference(
                    position=position,
                    velocity=velocity,
                    acceleration=acceleration,
                    load=load,
                    reading=reading,
                    width=width,
                    friction=friction,
                    position_torque=over,
                    torque=law.inertia_torque(position, velocity, acceleration)
                    + friction
                    + over
                    + law.offset,
                    sensor_torque=gain * reading + offset,
                )
            )
    return tuple(rows)


def torque_scale(subject: Subject) -> float:
    """Return the size of the law's torques, as a reference for differences."""
    rows = reference_values(subject)
    sizes = [max(abs(r.friction), abs(r.torque), abs(r.sensor_torque)) for r in rows]
    return float(np.max(sizes)) or 1.0
