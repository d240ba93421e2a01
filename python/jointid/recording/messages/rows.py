"""Assignment of messages to rows of a table: one row per stamp, in the order of stamps."""

from bisect import bisect_right
from collections.abc import Sequence

import numpy as np
import numpy.typing as npt

from jointid.base.values import dataclass
from jointid.recording.messages.collecting import Collected

_LATE = (
    1_000_000_000  # ns: a message with a stamp that goes back further than this begins another run
)
Integers = npt.NDArray[np.int64]
# Row numbers, columns, and values of each row.
_Part = tuple[Integers, npt.NDArray[np.intp], npt.NDArray[np.float64]]
_CELLS = 8_000_000  # cells of a table: 72 MB


@dataclass(frozen=True, eq=False)
class Rows:
    """The rows of a topic's messages.

    Attributes
    ----------
    row : ndarray of int, shape (messages,), optional
        Row of each message, -1 for a repeated message. None: message k is row k.
    repeated : int
        Number of messages left out because they repeat another one.
    reordered : int
        Number of messages that come after one with a later stamp.
    """

    row: Integers | None
    repeated: int
    reordered: int

    def of(self, messages: Integers) -> Integers:
        """Return the rows of messages."""
        return messages if self.row is None else self.row[messages]

    def message(self, row: int) -> int:
        """Return the first message of a row."""
        return row if self.row is None else int(np.flatnonzero(self.row == row)[0])


def rows_of(collected: Collected) -> tuple[Rows, Integers, Integers]:
    """Return the rows of messages, and the stamp and log time of each row [ns].

    Messages with stamps that go back by less than 1 s are put in order. Larger steps back stay, and are refused
    later. Messages with equal stamps become one row if they hold different joints, and are left out if they repeat
    all values.

    Parameters
    ----------
    collected : Collected
        At least one message.
    """
    logged = collected.log_times
    stamps = logged if collected.stamps is None else collected.stamps
    if (stamps[1:] > stamps[:-1]).all():
        return Rows(None, 0, 0), stamps, logged
    behind = np.maximum.accumulate(stamps) - stamps
    late = (behind > 0) & (behind < _LATE)
    reordered = int(np.count_nonzero(late)) if not (behind >= _LATE).any() else 0
    order = np.argsort(stamps, kind="stable") if reordered else np.arange(len(stamps))
    ordered = stamps[order]
    equal = np.concatenate([[False], ordered[1:] == ordered[:-1]])
    row = np.empty(len(stamps), dtype=np.int64)
    repeated = 0
    if equal.any():
        joined, dropped = _joined(collected, order, equal)
        row[order] = np.cumsum(~joined) - 1
        row[order[dropped]] = -1
        repeated = int(np.count_nonzero(dropped))
        first = order[~joined]
    else:
        row[order] = np.arange(len(stamps))
        first = order
    return Rows(row, repeated, reordered), stamps[first], logged[first]


def _joined(
    collected: Collected, order: npt.NDArray[np.intp], equal: npt.NDArray[np.bool_]
) -> tuple[npt.NDArray[np.bool_], npt.NDArray[np.bool_]]:
    """Return masks of the messages, in order, that join the previous row, and of those that only repeat it."""
    shared = np.flatnonzero(equal | np.append(equal[1:], False))
    place = np.full(len(order), -1, dtype=np.int64)  # message → line of the table
    place[order[shared]] = np.arange(len(shared))
    numbers = {
        column: number
        for number, column in enumerate(
            dict.fromkeys(c for block in collected.blocks for c in block.columns)
        )
    }
    parts: list[_Part] = []
    for block in collected.blocks:
        lines = place[block.messages]
        if (used := lines >= 0).any():
            where = np.array([numbers[column] for column in block.columns], dtype=np.intp)
            parts.append((lines[used], where, block.values[:, used].T))
    joined, dropped = np.zeros_like(equal), np.zeros_like(equal)
    most = max(1, _CELLS // max(1, len(numbers)))  # lines of a table
    starts = [*np.flatnonzero(~equal[shared]).tolist(), len(shared)]
    first = 0
    while first < len(starts) - 1:
        last = max(first + 1, bisect_right(starts, starts[first] + most) - 1)
        start, end = starts[first], starts[last]
        if end - start <= most:  # a larger group has one stamp: no robot has this number of joints
            there, values = _table(parts, start, end, len(numbers))
            for k in range(first, last):
                lines_of = slice(starts[k], starts[k + 1])
                _join_group(shared, lines_of, start, there, values, joined, dropped)
        first = last
    return joined, dropped


def _table(
    parts: Sequence[_Part], start: int, end: int, count: int
) -> tuple[npt.NDArray[np.bool_], npt.NDArray[np.float64]]:
    """Return for these lines the mask of present columns, and the values."""
    there = np.zeros((end - start, count), dtype=np.bool_)
    values = np.zeros((end - start, count))
    for lines, where, given in parts:
        inside = (lines >= start) & (lines < end)
        if inside.any():
            cells = np.ix_(lines[inside] - start, where)
            there[cells] = True
            values[cells] = given[inside]
    return there, values


def _join_group(
    shared: npt.NDArray[np.intp],
    lines: slice,
    start: int,
    there: npt.NDArray[np.bool_],
    values: npt.NDArray[np.float64],
    joined: npt.NDArray[np.bool_],
    dropped: npt.NDArray[np.bool_],
) -> None:
    """Decide whether the messages with one stamp join: all of them agree, or none joins."""
    first = lines.start - start
    seen, known = there[first].copy(), values[first].copy()
    repeats = []
    for line in range(first + 1, lines.stop - start):
        both = seen & there[line]
        if not np.array_equal(known[both], values[line][both], equal_nan=True):
            return
        repeats.append(bool(both.sum() == there[line].sum()))
        known[there[line]] = values[line][there[line]]
        seen |= there[line]
    positions = shared[lines.start + 1 : lines.stop]
    joined[positions] = True
    dropped[positions] = repeats
