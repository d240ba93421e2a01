"""Parts of a robot's balance: fit some rows and predict the others."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import fields, replace

import numpy as np
from numpy.typing import NDArray

from jointid.balance.held_out import block_starts, groups_of
from jointid.robot.balance.balance import Balance, Rows
from jointid.robot.balance.fit import Fit
from jointid.robot.balance.loads import loaded
from jointid.robot.balance.shaped_terms import ShapedTerms

Array = NDArray[np.float64]
Flags = NDArray[np.bool_]
Whole = NDArray[np.int64]


def blocks_of(rows: Rows, runs: Sequence[int], count: int) -> Whole:
    """Return the block of each row: equal stretches of one recording, otherwise whole recordings.

    There are at most `count` blocks. `runs` gives the recording of each piece.
    """
    recording = np.asarray(runs)[rows.piece]
    every = np.unique(recording)
    if every.size > 1:
        found = np.empty(recording.size, dtype=np.int64)
        for number, group in enumerate(groups_of(every.size, count)):
            found[np.isin(recording, every[group])] = number
        return found
    # The rows of a window stay together: the windows of all joints begin at the same time.
    begins = block_starts(rows.start, count, np.unique(rows.joint).size)
    return np.searchsorted(begins, rows.start, side="right").astype(np.int64)


def part_of_balance(balance: Balance, kept: Flags) -> Balance:
    """Return some rows of a balance."""
    rows = Rows(**{each.name: getattr(balance.rows, each.name)[kept] for each in fields(Rows)})
    return replace(
        balance,
        rows=rows,
        matrix=balance.matrix[kept],
        inertia=balance.inertia[kept],
        known=balance.known[kept],
        places=tuple(np.flatnonzero(rows.joint == joint) for joint in range(len(balance.places))),
    )


def predicted_torque(fit: Fit, balance: Balance) -> Array:
    """Return the integrals of torque that a fit predicts for a balance; the fit may be from other data."""
    inertial = [
        value
        for value, (joint, name) in zip(fit.values, fit.labels, strict=True)
        if joint is None or name == "inertia_scale"
    ]
    balance = loaded(balance, fit.models, fit.columns.loading(np.array(inertial)))
    places = {balance.labels[place]: place for place in balance.columns_of(fit.models)}
    total = fit.columns.known(balance) + fit.columns.columns(balance) @ np.array(inertial)
    for value, (joint, name) in zip(fit.values, fit.labels, strict=True):
        if joint is not None and (joint, name) in places:
            total = total + value * balance.matrix[:, places[joint, name]]
    values = dict(zip(fit.labels, fit.values.tolist(), strict=True))
    return np.asarray(total + ShapedTerms.of(balance, fit.models).torque(values))
