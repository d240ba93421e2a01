"""The contents of a table: a recording's signals in SI units, from all or some rows."""

from collections.abc import Callable, Collection, Mapping, Sequence
from dataclasses import field
from typing import Any

import numpy as np
import numpy.typing as npt

from jointid.base.advice import Action
from jointid.base.argument_checks import require_mapping
from jointid.base.errors import InputError
from jointid.base.values import dataclass
from jointid.recording.attributes import check_kind, check_torque_hold
from jointid.recording.clock import clock_of, repeats
from jointid.recording.column_lookup import column_index
from jointid.recording.columns import Column
from jointid.recording.damaged_rows import DROP, checked_rows, few, sound_rows
from jointid.recording.even_rows import EVENLY
from jointid.recording.extra import UNITS_KEY, ExtraColumn, extra_columns
from jointid.recording.matching import match_columns
from jointid.recording.plausibility import too_large
from jointid.recording.reading import MOTION, read_values, with_remedy
from jointid.recording.sides import READ_FROM
from jointid.recording.signals import FloatArray, check_signals
from jointid.recording.table import Table
from jointid.recording.truncated import unrecorded

Rows = npt.NDArray[np.intp]
_FACTOR_SAID = frozenset({"position", "torque", "motor_torque", "sensor"})
"""Signals with a factor to SI that findings need, to propose the other sign or to know that degrees were converted."""


@dataclass(frozen=True, kw_only=True)
class Contents:
    """The columns of a table that hold signals, as numbers.

    Attributes
    ----------
    table : Table
    found : mapping of str to Column
        Signal → its column.
    values : mapping of str to ndarray, each of shape (rows of the table,)
        Signal → values of its column, in the column's own unit.
    saved : mapping of str to object
        Attributes of a saved recording, as arguments of `Recording`.
    kind : str
        ``"revolute"`` or ``"prismatic"``.
    extra : mapping of str to (ExtraColumn, ndarray)
        Name of an extra signal → its column and values, in the column's own unit. Default: none.
    left_out : sequence of mapping of str to str
        Columns that match a signal but are not read, as in `Match`. Default: none.
    notes : mapping of str to object
        Further metadata entries of the recording. Default: none.
    """

    table: Table
    found: Mapping[str, Column]
    values: Mapping[str, FloatArray]
    saved: Mapping[str, Any]
    kind: str
    extra: Mapping[str, tuple[ExtraColumn, FloatArray]] = field(default_factory=dict)
    left_out: Sequence[Mapping[str, str]] = ()
    notes: Mapping[str, Any] = field(default_factory=dict)

    def fields(
        self,
        rows: Rows | None = None,
        *,
        time_remedy: Callable[[], tuple[str | Action, ...]] = tuple,
    ) -> dict[str, Any]:
        """Return the arguments of `Recording` from all or some rows of the table.

        Parameters
        ----------
        rows : ndarray of int, optional
            Rows to use. Default: all.
        time_remedy : callable
            Returns remedies for time stamps that go back. Default: none.

        Raises
        ------
        InputError
            A signal is not finite or too short, or time does not increase.
        """
        signals, extra = self._in_si(rows)
        clock = None
        if (
            self.table.saved is None
            and len({len(values) for values in (*signals.values(), *extra.values())}) == 1
        ):
            clock = clock_of(signals["time"], self._beside(signals, extra))
            if clock.kept is not None:
                rows = clock.kept if rows is None else rows[clock.kept]
                signals, extra = self._in_si(rows)
            signals["time"] = clock.time

        def place(signal: str, index: int) -> str:
            row = index if rows is None else int(rows[index])
            own = signal.removeprefix("extra.")
            column = self.found[signal] if own == signal else self.extra[own][0]
            return self.table.place(column.index, row)

        every = signals | {f"extra.{name}": values for name, values in extra.items()}
        try:
            check_signals(every, place=place, source=self.table.source, time_remedy=time_remedy)
        except InputError as error:
            advised = _with_drop(error, every) if "finite" in error.reason else error
            if "increase" in error.reason and (np.diff(signals["time"]) >= 0.0).all():
                advised = _with_rate(error)
            if error.argument in MOTION and self.table.saved is None:
                advised = with_remedy(advised, error.argument)
            raise advised from None
        if self.table.saved is None and (large := too_large(signals)) is not None:
            signal, index = large
            damaged = InputError(
                "this value is impossible for a joint: the number is damaged, or marks a missing value",
                argument=signal,
                value=float(signals[signal][index]),
                place=place(signal, index),
            )
            raise _with_drop(damaged, every)
        fields = {**self.saved, **signals, "kind": self.kind}
        if extra:
            fields["extra"] = extra
        if self.table.saved is None:
            fields["metadata"] = {**self._metadata(), **(clock.notes if clock else {})}
        elif isinstance(saved := fields.get("metadata"), Mapping):  # its columns are in SI
            of_file = ("scale", READ_FROM)
            fields["metadata"] = {name: each for name, each in saved.items() if name not in of_file}
        units = {name: column.shown for name, (column, _) in self.extra.items() if column.shown}
        if units and isinstance(fields.get("metadata", {}), Mapping):
            fields["metadata"] = {**fields.get("metadata", {}), UNITS_KEY: units}
        return fields

    def sound_rows(self, rows: Rows | None = None) -> tuple[Rows, int]:
        """Return the rows without damaged values, among all or some rows, and the number of damaged rows.

        Raises
        ------
        InputError
            More than a tenth of the rows is damaged, or columns differ in length.
        """
        signals, extra = self._in_si(rows)
        every = signals | {f"extra.{name}": values for name, values in extra.items()}
        if len({len(values) for values in every.values()}) > 1:
            check_signals(every, source=self.table.source)
        sound = sound_rows(every)
        kept = checked_rows(sound, self.table.source)
        return (kept if rows is None else rows[kept]), len(sound) - len(kept)

    def once(self, rows: Rows | None) -> Rows | None:
        """Return the rows that do not repeat the stamp and all values of an earlier row; None if no row does."""
        signals, extra = self._in_si(rows)
        kept = repeats(signals["time"], self._beside(signals, extra))
        return kept if kept is None or rows is None else rows[kept]

    def _beside(
        self, signals: Mapping[str, FloatArray], extra: Mapping[str, FloatArray]
    ) -> list[FloatArray]:
        return [*(signals[name] for name in signals if name != "time"), *extra.values()]

    def _in_si(self, rows: Rows | None) -> tuple[dict[str, FloatArray], dict[str, FloatArray]]:
        """Return the signals, and the extra signals by name."""
        signals = {
            signal: column.to_si(values if rows is None else values[rows])
            for (signal, column), values in zip(
                self.found.items(), self.values.values(), strict=True
            )
        }
        extra = {
            name: column.to_si(values if rows is None else values[rows])
            for name, (column, values) in self.extra.items()
        }
        return signals, extra

    def rows_of(self, by: str | int) -> dict[str, Rows]:
        """Return value → rows with this value in a column, in the order of first appearance."""
        column = column_index(self.table, by, "by")
        cells = self.table.text(column)
        self._check_length(self.table.headers[column], len(cells))
        # Not as a NumPy array: each cell would take the length of the longest text.
        numbers = {cell: number for number, cell in enumerate(dict.fromkeys(cells))}
        inverse = np.array([numbers[cell] for cell in cells], dtype=np.int64)
        grouped = np.split(np.argsort(inverse, kind="stable"), np.cumsum(np.bincount(inverse))[:-1])
        return dict(zip(numbers, grouped, strict=True))

    def rows_where(self, where: Mapping[str, float | str]) -> Rows:
        """Return the rows that have the stated value in each of these columns."""
        kept = np.ones(len(self.values["time"]), dtype=np.bool_)
        for header, wanted in require_mapping("where", where, "{'run': 1}").items():
            column = column_index(self.table, header, "where")
            if isinstance(wanted, str):
                cells = self.table.text(column)
                matches = np.array([cell == wanted for cell in cells], dtype=np.bool_)
                present = list(dict.fromkeys(cells))
            elif isinstance(wanted, int | float | np.number):
                (numbers,) = self.table.numbers([column])
                matches = numbers == float(wanted)
                present = [f"{value:g}" for value in dict.fromkeys(numbers.tolist())]
            else:
                raise InputError(
                    "a number or text is expected",
                    argument=f"where.{header}",
                    value=wanted,
                    place=self.table.source,
                )
            self._check_length(header, len(matches))
            if not matches.any():
                shown = ", ".join(present[:8]) + (", ..." if len(present) > 8 else "")
                raise InputError(
                    f"no row has this value; the column holds {shown}",
                    argument=f"where.{header}",
                    value=wanted,
                    place=self.table.source,
                )
            kept &= matches
        if not kept.any():
            raise InputError(
                "no row has all of these values together",
                argument="where",
                value=dict(where),
                place=self.table.source,
            )
        return np.flatnonzero(kept)

    def _check_length(self, header: str, length: int) -> None:
        if length != len(self.values["time"]):
            raise InputError(
                f"{header!r} has {length} samples, but time has {len(self.values['time'])}; a "
                "column that selects rows must have as many samples as time",
                place=self.table.source,
            )

    def _metadata(self) -> dict[str, Any]:
        # A sensor's raw reading has no SI unit, so none is assumed.
        assumed = [
            signal
            for signal, column in self.found.items()
            if column.unit is None and column.scale is None and signal != "sensor"
        ]
        scaled = {signal: column.scale for signal, column in self.found.items() if column.scale}
        for signal in _FACTOR_SAID & self.found.keys():
            unit = self.found[signal].unit
            if unit is not None and unit.factor != 1.0:
                scaled[signal] = unit.factor
        notes = dict(getattr(self.table, "notes", {}))  # how the file was read
        left_out = [dict(each) for each in (*self.left_out, *notes.pop("left_out", ()))]
        overridden = {
            signal: each.overridden for signal, each in self.found.items() if each.overridden
        }
        metadata = {"assumed_units": assumed, "scale": scaled, "left_out": left_out}
        metadata["overridden_units"] = overridden
        metadata |= {**notes, **self.notes}
        return {name: value for name, value in metadata.items() if value}


def _with_drop(error: InputError, signals: Mapping[str, FloatArray]) -> InputError:
    """Return the error of a value; if such rows are few, it advises to leave them out."""
    advice: str | Action = DROP if few(sound_rows(signals)) else "check the column and its unit"
    return InputError(
        error.reason,
        argument=error.argument,
        value=error.value,
        place=error.place,
        remedy=(*error.remedy, advice),
    )


def _with_rate(error: InputError) -> InputError:
    """Return the error of equal stamps with advice to state the sample period."""
    return InputError(
        error.reason,
        argument=error.argument,
        value=error.value,
        place=error.place,
        remedy=(EVENLY, *error.remedy),
    )


def read_contents(
    table: Table,
    *,
    columns: Mapping[str, str | int | None] | None = None,
    units: Mapping[str, str] | None = None,
    scale: Mapping[str, float] | None = None,
    extra: Collection[str] | Mapping[str, str | int] | None = None,
    kind: str | None = None,
    torque_hold: str | None = None,
) -> Contents:
    """Return the contents of a table; the parameters are those of `load`.

    Raises
    ------
    InputError
        As `load`.
    """
    if kind is not None:
        check_kind(kind)
    check_torque_hold(torque_hold)
    saved = dict(table.saved or {})
    saved_kind = saved.get("kind")
    if kind is not None and saved_kind not in (None, kind):
        raise InputError(
            f"the recording was saved as {saved_kind}",
            argument="kind",
            value=kind,
            place=table.source,
            remedy="leave it out",
        )
    for name, given, example in (
        ("units", units, "{'position': 'deg'}"),
        ("scale", scale, "{'position': 0.001}"),
    ):
        if given is not None:
            require_mapping(name, given, example)
    own = extra_columns(table, extra, units, scale)
    match = match_columns(
        table,
        columns=columns,
        units={name: unit for name, unit in units.items() if name not in own} if units else units,
        scale={name: each for name, each in scale.items() if name not in own} if scale else scale,
        kind=kind or saved_kind,
    )
    found = match.found
    read = {table.headers[column.index] for column in own.values()}
    left_out = [each for each in match.left_out if each["column"] not in read]
    notes: dict[str, Any] = {"stated_units": dict(units)} if units else {}
    values = read_values(table, found, left_out, notes)
    for missing in unrecorded(saved, values):
        found = {signal: column for signal, column in found.items() if signal != missing}
        del values[missing]
    arrays = table.numbers([column.index for column in own.values()]) if own else []
    if columns and "velocity" in columns:
        saved.pop("velocity_derived", None)
    if torque_hold is not None:
        saved["torque_hold"] = torque_hold
    return Contents(
        table=table,
        found=found,
        values=values,
        saved=saved,
        extra={name: (own[name], values) for name, values in zip(own, arrays, strict=True)},
        kind=match.kind,
        left_out=left_out,
        notes=notes,
    )
