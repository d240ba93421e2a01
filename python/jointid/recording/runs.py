"""Files with several runs: the column that identifies the runs, and the call that loads one."""

import math
import re
from collections.abc import Mapping, Sequence
from itertools import pairwise

import numpy as np

from jointid.base.advice import Action
from jointid.base.errors import InputError
from jointid.recording.contents import Contents, Rows
from jointid.recording.signals import SHORTEST, FloatArray

_RUN = r"(?i)run|trial|test|experiment|episode|file|log"
_MOST = 8  # columns that are examined: each costs time in a long file


def shifts_of_runs(time: FloatArray, runs: Sequence[Rows]) -> FloatArray:
    """Return the time shift of each row, so that each run begins after the previous one with a pause between.

    Parameters
    ----------
    time : ndarray, shape (n,)
        Time in each run, starting at the run's own zero.
    runs : sequence of ndarray
        The rows of each run.
    """
    pause = max(float(time[run[-1]] - time[run[0]]) for run in runs)
    shift = np.zeros(len(time))
    for before, run in pairwise(runs):
        shift[run] = time[before[-1]] + shift[before[-1]] + pause - time[run[0]]
    return shift


def one_run(contents: Contents) -> tuple[Action, ...]:
    """Return the calls that load one run or all runs, if a column identifies the runs of a file.

    Parameters
    ----------
    contents : Contents
        Contents of a file in which time goes back.

    Returns
    -------
    tuple of Action
        Empty if no column divides the rows into runs of increasing time.
    """
    signals = {column.index for column in contents.found.values()}
    headers = contents.table.headers
    others = [
        (column, header)
        for column, header in enumerate(headers)
        if column not in signals and headers.count(header) == 1
    ]
    others.sort(key=lambda other: not re.search(_RUN, other[1]))  # likely ones first
    for column, header in others[:_MOST]:
        try:
            runs = contents.rows_of(column)
        except InputError:  # a damaged column, or one of another length, is of no use here
            continue
        long = [value for value, rows in runs.items() if len(rows) >= SHORTEST]
        if long and len(runs) > 1 and _increase(contents, runs):
            where = {header: _value(long[0])}
            one = Action("call", {"where": where}, function="load", text="one run")
            every = Action("call", {"by": header}, function="load_runs", text="all runs")
            return (one, every) if len(long) == len(runs) else (one,)
    return ()


def _increase(contents: Contents, runs: Mapping[str, Rows]) -> bool:
    """Return whether time increases within each run."""
    time = contents.found["time"].to_si(contents.values["time"])
    return all(bool((np.diff(time[rows]) > 0.0).all()) for rows in runs.values())


def _value(text: str) -> float | str:
    try:
        number = float(text)
    except ValueError:
        return text
    if not math.isfinite(number):
        return text
    return int(number) if number.is_integer() else number
