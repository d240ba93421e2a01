"""Conversion between a recording and a data frame (pandas, or anything with `columns` and `frame[column]`)."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from types import MappingProxyType
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from jointid.base.errors import InputError
from jointid.base.frames import data_frame
from jointid.recording.extra import PREFIX
from jointid.recording.samples import Samples
from jointid.recording.saved import saved_attributes
from jointid.recording.saving import attributes_text
from jointid.recording.signals import FloatArray, signal_array

if TYPE_CHECKING:
    import pandas as pd


ATTRIBUTE = "jointid_recording"
"""Key in a frame's `attrs` of the recording's attributes, as text."""


def frame_of(recording: Samples) -> pd.DataFrame:
    """Return a recording as a data frame: see `Recording.to_pandas`."""
    table = {name: getattr(recording, name) for name in recording.signals}
    table |= {PREFIX + name: values for name, values in recording.extra.items()}
    frame = data_frame(table, index="time")
    frame.attrs[ATTRIBUTE] = attributes_text(recording)
    return frame


class FrameTable:
    """A data frame as a table of columns.

    Parameters
    ----------
    frame : DataFrame
        The index is also a column if it has a name, or holds dates or durations. An xarray Dataset is
        converted with its `to_dataframe`.

    Raises
    ------
    InputError
        The frame has no columns, or describes a recording that this version cannot read.
    """

    source = "data frame"
    header_place = "data frame"
    saved: Mapping[str, Any] | None
    other_names: Mapping[str, int] = MappingProxyType({})

    def __init__(self, frame: Any) -> None:
        if hasattr(frame, "data_vars"):
            frame = frame.to_dataframe()
        if not hasattr(frame, "columns") or not hasattr(frame, "__getitem__"):
            raise InputError(
                "a data frame with columns is expected",
                argument="df",
                value=frame,
                remedy="pass arrays as time and position of a Recording",
            )
        self._frame = frame
        self.saved = None
        self._labels = list(frame.columns)
        self._index = _named_index(frame)
        self.headers = tuple(map(str, self._labels))
        index = getattr(getattr(frame, "index", None), "dtype", None)
        if self._index is None and getattr(index, "kind", "") == "f":  # times in an unknown unit
            self.header_place = (
                "data frame; its index has no name (rename_axis('time_s') sets the name)"
            )
        if self._index is not None:
            self.headers = (self._index[0], *self.headers)
        text = getattr(frame, "attrs", {}).get(ATTRIBUTE)
        if isinstance(text, str):
            self.saved = saved_attributes(text, f"{self.source}, attrs")

    def numbers(self, columns: Sequence[int]) -> list[FloatArray]:
        """Return columns as arrays of shape (n,), or raise `InputError`."""
        return [
            signal_array("", self._column(k), f"{self.source}, column {self.headers[k]!r}")
            for k in columns
        ]

    def raw(self, column: int) -> npt.NDArray[Any]:
        """Return the values of a column as the frame has them; dates with a zone in UTC."""
        values = self._column(column)
        zone = getattr(getattr(values, "dt", None), "tz", None)
        if zone is not None:
            return np.asarray(values.dt.tz_convert(None))
        if getattr(values, "tz", None) is not None:  # an index of dates with a zone
            return np.asarray(values.tz_convert(None))
        return np.asarray(values)

    def text(self, column: int) -> list[str]:
        """Return the values of a column as text."""
        return [str(value) for value in np.asarray(self._column(column)).tolist()]

    def place(self, column: int, row: int) -> str:
        """Return the place of a value: row and column."""
        return f"{self.source}, row {row}, column {self.headers[column]!r}"

    def _column(self, number: int) -> Any:
        if self._index is not None:
            if number == 0:
                return self._index[1]
            number -= 1
        return self._frame[self._labels[number]]


def _named_index(frame: Any) -> tuple[str, Any] | None:
    """Return name and values of a frame's index if it can be a column; None otherwise."""
    index = getattr(frame, "index", None)
    if index is None or callable(index) or getattr(index, "nlevels", 1) != 1:
        return None
    clock = getattr(getattr(index, "dtype", None), "kind", "") in ("m", "M") or hasattr(index, "tz")
    name = index.name if index.name is not None else "time" if clock else None
    if name is None or str(name) in map(str, frame.columns):
        return None
    return str(name), index
