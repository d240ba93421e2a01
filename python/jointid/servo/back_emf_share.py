"""Share of back-EMF in the braking torque that is proportional to speed, if no recording shows it.

While the motor is driven, only the sum of back-EMF and viscous friction is visible. While it turns freely, only the
viscous part acts. If the logs do not determine the share, it is chosen by its effect on a free swing of the load. The
chosen share has the swing with the smallest largest difference from the swings of all other shares. It is not a half:
a swing shows differences between small frictions, but it ends soon under any larger friction.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from jointid import _core
from jointid.joint.joint import Joint
from jointid.servo.layout import LOAD_FRICTION, Layout
from jointid.servo.rolling_out import servo_plant
from jointid.servo.signals import ServoSignals

Array = NDArray[np.float64]

_SHARES = np.linspace(0.0, 1.0, 21)
_STEP = 5e-3  # s


def share_of(joint: Joint, runs: Sequence[ServoSignals], layout: Layout, solution: Array) -> float:
    """Return the share of back-EMF with the free swing closest to those of all other shares; a half without gravity.

    The swing starts at the position with the largest gravity torque in the runs, and lasts as long as the longest run.
    Only the sum of the solution's back-EMF and viscous friction is used.
    """
    if joint.link is None:
        return 0.5
    weight = joint.gravity_coefficients
    positions = np.concatenate([run.position for run in runs])
    pull = np.abs(weight.cos * np.cos(positions) + weight.sin * np.sin(positions))
    start = float(positions[int(np.argmax(pull))])
    values, linear = layout.by_name(solution), layout.linear
    inertia, load = values["inertia"], values[LOAD_FRICTION.name]
    total = values["back_emf"] + values[linear]
    if pull.max() == 0.0 or total <= 0.0 or inertia + joint.link_inertia <= 0.0:
        return 0.5
    loops = []
    for share in _SHARES:
        plant = servo_plant(joint, inertia, {**values, linear: (1.0 - share) * total})
        loops.append(_core.ServoLoop(joint=plant, load_friction=load, closed=False, position=start))
    time = np.arange(0.0, max(float(run.time[-1] - run.time[0]) for run in runs), _STEP)
    log = (time, np.zeros(len(time)), np.zeros(len(time)), np.zeros(len(time)))
    motions = _core.roll_out_servos(loops, [log] * len(loops), step=_STEP)
    swings = np.stack([position for position, _ in motions])
    farthest = [np.abs(swings - own).mean(axis=1).max() for own in swings]
    return float(_SHARES[int(np.argmin(farthest))])
