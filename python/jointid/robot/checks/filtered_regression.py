"""The cross-check: a plain filtered least squares of inverse dynamics, to compare its values with the identified ones.

It is the usual first analysis by hand, on the signals as recorded. Only the stated facts, the zeros that were found
and the shapes of friction are taken from the identification.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from jointid.robot.balance.inertia import inertia_columns
from jointid.robot.checks.plain_regression import (
    BETTER,
    Columns,
    Label,
    as_good,
    own_delays,
    solved,
)
from jointid.robot.links.robot import Robot
from jointid.robot.motion.plain_motion import PlainSignals

Array = NDArray[np.float64]

# factors on the average's period, and of the peak speed
SETTINGS = ((1.0, 0.15), (0.6, 0.1), (1.5, 0.25))
_DELAYS: Array = 0.005 * np.arange(-6.0, 7.0)  # [s]
_FINE: Array = 0.001 * np.arange(-4.0, 5.0)


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class SecondLook:
    """Results of the cross-check."""

    values: dict[Label, float]  # values with the first setting
    errors: dict[Label, float]  # clustered over stretches
    spread: dict[Label, float]  # largest difference of the values with the other settings
    # filtered torque of the examined joints, minus the torque of known inertias
    torque: dict[int, Array]
    matrix: dict[int, tuple[tuple[Label, ...], Array]]  # columns of these torques
    size: dict[int, float]  # root mean square of the joint's torque
    delay: Array  # (n,), delay that the cross-check found and removed [s]
    recorded: bool  # True if the recorded velocity explained clearly more


def filtered_fit(
    signals: Sequence[PlainSignals],
    robot: Robot,
    mode: str,
    slowest: Array,
    models: Sequence[str],
    inertial: Array,
    delay: Array,
    other: Array,
) -> SecondLook:
    """Return a plain fit of a robot's torques, without rows below the speeds `slowest`.

    The load of friction is that of links with the inertial parameters `inertial`, (10 n,). `delay` is the stated delay
    of each torque, and `other` the delay that the identification removed [s]. If these rows do not separate `other`
    from their own delay, the spread of the values contains the difference.
    """
    columns = inertia_columns(robot, mode)
    every = Columns(robot, columns, slowest, models, inertial)
    sources = [(False, list(signals))]
    if all(each.recorded is not None for each in signals):
        swapped = [replace(each, velocity=np.asarray(each.recorded)) for each in signals]
        sources.append((True, swapped))
    tried = []
    for recorded, each in sources:
        blocks = every.blocks(each, *SETTINGS[0], delay[:, None] + _DELAYS)
        own, left = own_delays(blocks, _DELAYS)
        tried.append((recorded, each, own, left))
    recorded, chosen, own, left = tried[0]
    if len(tried) > 1 and left and tried[1][3].keys() >= left.keys():
        ratio = [np.log(tried[1][3][joint] / left[joint]) for joint in left]
        if np.mean(ratio) < np.log(BETTER):
            recorded, chosen, own, left = tried[1]
    shift = delay + np.array([own.get(joint, 0.0) for joint in range(robot.n)])
    moved = shift != delay
    if moved.any():
        fine = np.where(moved[:, None], _FINE, 0.0 * _FINE)
        blocks = every.blocks(chosen, *SETTINGS[0], shift[:, None] + fine)
        near, _ = own_delays(blocks, _FINE, 1.0)
        shift = shift + np.array([near.get(j, 0.0) if moved[j] else 0.0 for j in range(robot.n)])
    found = [every.blocks(chosen, *setting, shift[:, None]) for setting in SETTINGS]
    values, errors = solved(found[0], robot.n)
    both = every.blocks(chosen, *SETTINGS[0], np.column_stack([shift, other]))
    found.append({joint: as_good(block) for joint, block in both.items()})
    others = [solved(each, robot.n)[0] for each in found[1:]]
    spread = {
        label: max((abs(each[label] - value) for each in others if label in each), default=0.0)
        for label, value in values.items()
    }
    return SecondLook(
        values=values,
        errors=errors,
        spread=spread,
        torque={joint: block.targets[:, 0] for joint, block in found[0].items()},
        matrix={joint: (block.labels, block.matrix) for joint, block in found[0].items()},
        size={joint: block.size for joint, block in found[0].items()},
        delay=shift - delay,
        recorded=recorded,
    )
