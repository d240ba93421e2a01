"""How much of what brakes in proportion to speed is back-EMF, where no recording says it.

While the motor is driven only the sum of back-EMF and viscous friction is seen; where it turns freely the sum's
viscous part is all that matters. Nothing in the logs prefers a share, so it is chosen for what it does: the load is
let go, and the share is taken whose swing is nearest to those of all other shares, at worst. It is not a half: a swing
dies soon under any larger friction, so that it tells small frictions apart, not large ones.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from jointid import _core
from jointid.joint.joint import Joint
from jointid.servo.signals import ServoSignals

Array = NDArray[np.float64]

_SHARES = np.linspace(0.0, 1.0, 21)
_STEP = 5e-3  # s


def share_of(joint: Joint, runs: Sequence[ServoSignals], values: Array) -> float:
    """Return the share of back-EMF whose free swing is nearest to those of all others; a half without gravity.

    Parameters
    ----------
    joint : Joint
        Its link is the load.
    runs : sequence of ServoSignals
        The load is let go where it pulls hardest in them, for as long as the longest of them.
    values : ndarray
        A solution: of its back-EMF and viscous friction only the sum is used.
    """
    if joint.link is None:
        return 0.5
    weight = joint.gravity_coefficients
    positions = np.concatenate([run.position for run in runs])
    pull = np.abs(weight.cos * np.cos(positions) + weight.sin * np.sin(positions))
    start = float(positions[int(np.argmax(pull))])
    _, back_emf, viscous, coulomb, load, inertia = values[:6]
    total = float(back_emf + viscous)
    if pull.max() == 0.0 or total <= 0.0 or inertia + joint.link_inertia <= 0.0:
        return 0.5
    link = joint.link
    loops = []
    for share in _SHARES:
        own = (1.0 - share) * total
        plant = _core.SimulatedJoint(
            inertia=float(inertia) + joint.link_inertia,
            decay="none",
            coulomb_positive=float(coulomb),
            coulomb_negative=float(coulomb),
            viscous_positive=own,
            viscous_negative=own,
            weights=[(link.mass * link.gravity * link.centre_of_mass, link.angle)],
        )
        loops.append(
            _core.ServoLoop(joint=plant, load_friction=float(load), closed=False, position=start)
        )
    time = np.arange(0.0, max(float(run.time[-1] - run.time[0]) for run in runs), _STEP)
    log = (time, np.zeros(len(time)), np.zeros(len(time)), np.zeros(len(time)))
    motions = _core.roll_out_servos(loops, [log] * len(loops), step=_STEP)
    swings = np.stack([position for position, _ in motions])
    farthest = [np.abs(swings - own).mean(axis=1).max() for own in swings]
    return float(_SHARES[int(np.argmin(farthest))])
