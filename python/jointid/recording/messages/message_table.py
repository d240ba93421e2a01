"""The messages of a topic as a table: one row per stamp, one column per joint and signal."""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from jointid.base.advice import Action
from jointid.base.errors import InputError
from jointid.recording.messages.collecting import Collected
from jointid.recording.messages.joints import Column, is_joint_kind, unit_of
from jointid.recording.messages.publishers import jump_between_publishers
from jointid.recording.messages.rows import Rows, rows_of
from jointid.recording.messages.topic import Topic
from jointid.recording.signals import FloatArray

_NANO = 1e9
TIME, LOG_TIME = 0, 1  # the first two columns


class MessageTable:
    """The messages of one topic as a table of columns.

    Columns are ``time [s]``, ``log_time [s]``, ``JOINT.position [rad]`` and so on. With a single joint, its
    name is omitted. Times are seconds since the first.

    Parameters
    ----------
    path : Path
    topic : Topic
    collected : Collected
        The topic's messages, at least one.
    kind : {"revolute", "prismatic"}
        Kind of the joints; messages do not state it.
    incomplete : str
        Reason why the file ends early; empty if it is complete.
    """

    saved: Mapping[str, Any] | None = None

    def __init__(
        self, path: Path, topic: Topic, collected: Collected, *, kind: str, incomplete: str
    ) -> None:
        self.source = f"{path}, topic {topic.name}"
        self.header_place = self.source
        self._blocks = collected.blocks
        self._rows, stamps, self._logged = rows_of(collected)
        self._time = _seconds(stamps)  # computed once for all joints of a robot
        columns = list(dict.fromkeys(c for block in self._blocks for c in block.columns))
        self._columns = [column for column in columns if self._holds_numbers(column)]
        joints = dict.fromkeys(joint for joint, _ in self._columns if joint)
        named = is_joint_kind(topic.kind)
        self.headers = (
            "time [s]",
            "log_time [s]",
            *(_header(c, kind, alone=len(joints) < 2, named=named) for c in self._columns),
        )
        self.other_names = {
            f"{joint}.{signal}" if joint else signal: k
            for k, (joint, signal) in enumerate(self._columns, start=2)
        }
        self._shown: npt.NDArray[np.intp] | None = None  # rows of the last numbers
        self.notes = _notes(topic, collected, self._rows, incomplete) | {
            "first_stamp_ns": int(stamps.min())
        }

    def numbers(self, columns: Sequence[int]) -> list[FloatArray]:
        """Return columns as arrays of shape (n,).

        If messages hold different joints, only rows with at least one of these columns are returned. Without a
        time among the columns, the rows are those of the last call with a time.

        Raises
        ------
        InputError
            Such a row lacks one of the columns, or two nodes published the same joint.
        """
        kept = self._rows_with(columns)
        self._shown = kept
        found = []
        for column in columns:
            values = self._values(column)
            values = values if kept is None else values[kept]
            self._check_publisher(column, values)
            values.flags.writeable = False
            found.append(values)
        return found

    def text(self, column: int) -> list[str]:
        """Return the values of a column as text, in the same rows as the last numbers."""
        values = self._values(column)
        values = values if self._shown is None else values[self._shown]
        return [f"{value:g}" for value in values.tolist()]

    def place(self, column: int, row: int) -> str:
        """Return the place of a value: file, topic, message and column."""
        if self._shown is not None:
            row = int(self._shown[row])
        message = self._rows.message(row)
        return f"{self.source}, message {message}, column {self.headers[column]!r}"

    def _values(self, column: int) -> FloatArray:
        if column in (TIME, LOG_TIME):
            return self._time if column == TIME else _seconds(self._logged)
        values = np.full(len(self._time), np.nan)
        wanted = self._columns[column - 2]
        for block in self._blocks:
            if wanted in block.columns:
                rows = self._rows.of(block.messages)
                kept = rows >= 0
                values[rows[kept]] = block.values[block.columns.index(wanted)][kept]
        return values

    def _rows_with(self, columns: Sequence[int]) -> npt.NDArray[np.intp] | None:
        """Return the rows with at least one of these columns; None for all rows."""
        numbers = [column for column in columns if column > LOG_TIME]
        wanted = {self._columns[column - 2] for column in numbers}
        if all(wanted.issubset(block.columns) for block in self._blocks):
            return None if len(numbers) < len(columns) else self._shown
        there = np.array([self._present(column) for column in numbers])
        alone = len(numbers) == len(columns)  # their time was read before
        if not alone:
            kept = np.flatnonzero(there.any(axis=0))
        else:
            kept = np.arange(len(self._time)) if self._shown is None else self._shown
        lacking = ~there[:, kept]
        if lacking.any():
            row = int(np.argmax(lacking.any(axis=0)))
            missing = numbers[int(np.argmax(lacking[:, row]))]
            raise self._without(missing, int(kept[row]), wanted)
        return kept

    def _check_publisher(self, column: int, values: FloatArray) -> None:
        """Refuse positions of two publishers: the messages do not name their publisher."""
        if column <= LOG_TIME or self._columns[column - 2][1] != "position":
            return
        jump = jump_between_publishers(values)
        if jump is not None:
            raise InputError(
                f"the position jumps back and forth by {jump:.3g} between messages, as if two nodes published the "
                "same joint on one topic",
                place=f"{self.source}, column {self.headers[column]!r}",
                remedy="log only one node, or each node on its own topic",
            )

    def _present(self, column: int) -> npt.NDArray[np.bool_]:
        """Return for each row whether its messages hold a column."""
        present = np.zeros(len(self._time), dtype=np.bool_)
        for block in self._blocks:
            if self._columns[column - 2] in block.columns:
                rows = self._rows.of(block.messages)
                present[rows[rows >= 0]] = True
        return present

    def _without(self, missing: int, row: int, wanted: set[Column]) -> InputError:
        self._shown = None
        _, signal = self._columns[missing - 2]
        remedy: tuple[str | Action, ...] = ()
        if len({joint for joint, _ in wanted}) > 1:
            remedy = ("load one joint at a time: the joints are logged at different times",)
        elif signal != "position":
            named = {"effort": "torque"}.get(signal, signal)
            remedy = (
                Action("call", {"columns": {named: None}}, function="load", text="without it"),
                "log this signal in all messages",
            )
        return InputError(
            "messages at this time do not hold this signal",
            place=self.place(missing, row),
            remedy=remedy,
        )

    def _holds_numbers(self, column: Column) -> bool:
        """Whether any value is a number: drivers fill unmeasured values with NaN."""
        return any(
            bool(np.isfinite(block.values[block.columns.index(column)]).any())
            for block in self._blocks
            if column in block.columns
        )


def _seconds(times: npt.NDArray[np.int64]) -> FloatArray:
    """Return seconds since the first; exact to a nanosecond over 100 days."""
    return np.asarray((times - times.min()) / _NANO)


def _header(column: Column, kind: str, *, alone: bool, named: bool) -> str:
    joint, signal = column
    if not named or not joint:
        return signal
    unit = unit_of(signal, kind)
    name = signal if alone else f"{joint}.{signal}"
    return f"{name} [{unit}]" if unit else name


def _notes(topic: Topic, collected: Collected, rows: Rows, incomplete: str) -> dict[str, Any]:
    notes: dict[str, Any] = {
        "topic": topic.name,
        "stamps": "log time" if collected.stamps is None else "header",
    }
    if rows.repeated:
        notes["repeated_messages"] = rows.repeated
    if rows.reordered:
        notes["reordered_messages"] = rows.reordered
    if collected.not_compared:
        notes["topics_not_compared"] = collected.not_compared
    if incomplete:
        notes["incomplete"] = incomplete
    return notes


def no_messages(path: Path, topic: Topic, incomplete: str) -> InputError:
    """Return the error for a topic without messages."""
    reason = f"; {incomplete}" if incomplete else ""
    return InputError(f"it has no messages{reason}", place=f"{path}, topic {topic.name}")
