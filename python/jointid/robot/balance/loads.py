"""Columns of friction in proportion to the links' torque; the links' inertias give these columns."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from jointid.robot.balance.balance import Balance
from jointid.robot.balance.inertia import within
from jointid.robot.links.models import LOAD, is_loaded
from jointid.robot.links.parameters import CONSTANT

Array = NDArray[np.float64]


def loaded(balance: Balance, models: Sequence[str], links: Array) -> Balance:
    """Return a balance with the columns of friction under load, for the joints that have it.

    `links` are the inertial parameters, (10 n,), in the span of the balance's basis. Within a window, the mean of the
    torque is the load, and the mean of the direction is its sign.
    """
    concerned = [joint for joint, model in enumerate(models) if is_loaded(model)]
    if not concerned:
        return balance
    torque = balance.inertia @ within(balance.basis, links)
    matrix = balance.matrix.copy()
    for joint in concerned:
        mine = balance.places[joint]
        turned = matrix[mine, balance.labels.index((joint, CONSTANT.name))]
        load = np.abs(torque[mine]) / balance.rows.duration[mine]
        matrix[mine, balance.labels.index((joint, LOAD.name))] = load * turned
    return replace(balance, matrix=matrix)
