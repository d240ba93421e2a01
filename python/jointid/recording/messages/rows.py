"""Which row of a table each message belongs to: rows in the order of their stamps, one for each stamp."""

from collections.abc import Sequence

import numpy as np
import numpy.typing as npt

from jointid.base.values import dataclass
from jointid.recording.messages.collecting import Collected
from jointid.recording.messages.joints import Column

_LATE = (
    1_000_000_000  # ns: a message that comes later than this after a younger one begins another run
)
Integers = npt.NDArray[np.int64]
_Part = tuple[npt.NDArray[np.intp], npt.NDArray[np.float64]]  # columns and values of a message


@dataclass(frozen=True, eq=False)
class Rows:
    """The rows of a topic's messages.

    Attributes
    ----------
    row : ndarray of int, shape (messages,), optional
        The row of each message, -1 for a repeated one. None: its own number.
    repeated : int
        Messages left out because they repeat another one.
    reordered : int
        Messages that stand behind a younger one.
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

    Messages that stand a little behind a younger one (less than 1 s) are put in order; what goes back further is
    left as it is, and refused later. Messages with equal stamps become one row if they hold
    different joints, and are left out if they repeat all values.

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
    """Return which messages, in order, join the row of the one before, and which of them only repeat."""
    group = np.cumsum(~equal) - 1  # of equal stamps
    shared = np.flatnonzero(equal | np.append(equal[1:], False))
    place = np.full(len(order), -1, dtype=np.int64)  # message → line of the small table
    place[order[shared]] = np.arange(len(shared))
    numbers: dict[Column, int] = {}
    # Of each line its columns and values: a table of all would be mostly empty where many joints share a stamp.
    parts: list[list[_Part]] = [[] for _ in shared]
    for block in collected.blocks:
        last = {numbers.setdefault(c, len(numbers)): k for k, c in enumerate(block.columns)}
        where = np.array(list(last), dtype=np.intp)
        values = block.values[list(last.values())]
        lines = place[block.messages]
        for k in np.flatnonzero(lines >= 0):
            parts[lines[k]].append((where, values[:, k]))
    count = len(numbers)
    joined, dropped = np.zeros_like(equal), np.zeros_like(equal)
    start = 0
    for line in range(1, len(shared) + 1):
        if line < len(shared) and group[shared[line]] == group[shared[start]]:
            continue
        _join_group(shared, slice(start, line), parts, count, joined, dropped)
        start = line
    return joined, dropped


def _join_group(
    shared: npt.NDArray[np.intp],
    lines: slice,
    parts: Sequence[Sequence[_Part]],
    count: int,
    joined: npt.NDArray[np.bool_],
    dropped: npt.NDArray[np.bool_],
) -> None:
    """Decide on the messages of one stamp: all of them agree and join, or none does."""
    known = np.zeros(count)
    seen = np.zeros(count, dtype=np.bool_)
    repeats = []
    for line in range(lines.start, lines.stop):
        new = False
        for where, values in parts[line]:
            both = seen[where]
            if not np.array_equal(known[where][both], values[both], equal_nan=True):
                return
            new = new or not both.all()
            known[where] = values
            seen[where] = True
        repeats.append(not new)
    positions = shared[lines.start + 1 : lines.stop]
    joined[positions] = True
    dropped[positions] = repeats[1:]
