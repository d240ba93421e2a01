"""Input of the block bootstrap of a robot's estimate: sums of the fit over quarters of blocks."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from jointid.balance.resampling import cells_of
from jointid.balance.segments import segment_length
from jointid.robot.balance.balance import Balance
from jointid.robot.balance.fit import Fit
from jointid.robot.balance.solving import PriorRows
from jointid.robot.result.bootstrap import RobotDraws


def draws_of(balance: Balance, fit: Fit, prior: PriorRows) -> RobotDraws:
    """Return the sums of a fit; priors of further parameters come after its own."""
    rows = balance.rows
    weight = 1.0 / fit.scatter[rows.joint]
    length = segment_length(rows.start, rows.stop, rows.piece)
    cells = cells_of(
        fit.jacobian * weight[:, None],
        -fit.residual * weight,
        recording=rows.piece,
        begin=rows.start,
        end=rows.stop,
        length=length,
    )
    prior = prior.padded(fit.values.size - prior.matrix.shape[1])
    missed = prior.matrix @ fit.values - prior.target
    lower, upper = np.array(fit.bounds).T
    return RobotDraws(
        cells=replace(
            cells,
            sure_square=prior.matrix.T @ prior.matrix,
            sure_gradient=prior.matrix.T @ missed,
        ),
        block=length,
        lower=lower,
        upper=upper,
        values=fit.values,
        labels=fit.labels,
    )
