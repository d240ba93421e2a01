"""Block bootstrap of a robot's estimate: it resamples stretches of time, with all joints in each."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from jointid.balance.resampling import Cells, draws
from jointid.base.argument_checks import whole_number
from jointid.base.errors import InputError
from jointid.estimate.bootstrap import Bootstrap
from jointid.estimate.statistics import ParameterEstimate
from jointid.identification.inference.bootstrap import drawn_parameter

Array = NDArray[np.float64]


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class RobotDraws:
    """Sums of the fit over quarters of blocks, which the bootstrap resamples. It keeps no recording."""

    cells: Cells
    block: float  # length [s]
    lower: Array  # lower bounds of the parameters, in the order of `RobotEstimate.parameters`
    upper: Array  # upper bounds of the parameters, in the same order
    values: Array
    labels: tuple[tuple[int | None, str], ...]

    def __reduce__(self) -> tuple[Callable[[], None], tuple[()]]:
        """Omit the sums from a pickled estimate."""
        return _nothing, ()


def bootstrapped(
    source: RobotDraws | None,
    every: Mapping[str, ParameterEstimate],
    joints: Sequence[str],
    count: int,
    seed: int,
) -> Bootstrap:
    """Return the block bootstrap of all parameters of joints with these names; see `RobotEstimate.bootstrap`."""
    count = whole_number("n", count, 20, 1_000_000)
    seed = whole_number("seed", seed, 0, 2**64 - 1)
    if source is None:
        raise InputError(
            "this estimate was read from a file, and the file does not hold the recordings",
            argument="bootstrap",
            remedy="identify again, and call bootstrap on the new estimate",
        )
    below, above = source.lower - source.values, source.upper - source.values
    moved = draws(source.cells, below, above, count, seed)
    freedom = max(1, source.cells.blocks - 1)
    wider = np.clip(_widening(source) * moved, below, above)
    names = [name if joint is None else f"{joints[joint]}.{name}" for joint, name in source.labels]
    return Bootstrap(
        parameters={
            name: replace(
                drawn_parameter(every[name], wider[:, i], (below[i], above[i]), freedom), name=name
            )
            for i, name in enumerate(names)
        },
        samples=source.values + moved,
        block=source.block,
        blocks=source.cells.blocks,
        seed=seed,
    )


def _widening(source: RobotDraws) -> float:
    """Return the factor by which errors from so few blocks are larger than the draws show.

    A fit absorbs a part of each block's error, in proportion to its parameters per block. This is the correction of
    MacKinnon and White (1985, HC1), with a block as one observation and the parameters of one joint.
    """
    joints = [joint for joint, _ in source.labels if joint is not None]
    blocks, each = source.cells.blocks, len(joints) / max(1, len(set(joints)))
    return float(np.sqrt(blocks / max(blocks - each, 0.5 * blocks, 1.0)))


def _nothing() -> None:
    return None
