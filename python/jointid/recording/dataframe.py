"""Reading a data frame: pandas, or anything with `columns` and `frame[column]`."""

from collections.abc import Mapping, Sequence
from types import MappingProxyType
from typing import Any

import numpy as np
import numpy.typing as npt

from jointid.base.errors import InputError
from jointid.recording.signals import FloatArray, signal_array


class FrameTable:
    """A data frame as a table of columns.

    Parameters
    ----------
    frame : DataFrame

    Raises
    ------
    InputError
        It has no columns.
    """

    source = "data frame"
    header_place = "data frame"
    saved: Mapping[str, Any] | None = None
    other_names: Mapping[str, int] = MappingProxyType({})

    def __init__(self, frame: Any) -> None:
        if not hasattr(frame, "columns") or not hasattr(frame, "__getitem__"):
            raise InputError(
                "a data frame with columns is expected",
                argument="df",
                value=frame,
                remedy="pass arrays as time and position of a Recording",
            )
        self._frame = frame
        self._labels = list(frame.columns)
        self.headers = tuple(map(str, self._labels))

    def numbers(self, columns: Sequence[int]) -> list[FloatArray]:
        """Return columns as arrays of shape (n,), or raise `InputError`."""
        return [
            signal_array(
                "", self._frame[self._labels[k]], f"{self.source}, column {self.headers[k]!r}"
            )
            for k in columns
        ]

    def raw(self, column: int) -> npt.NDArray[Any]:
        """Return the values of a column as the frame has them; of dates with a zone those of UTC."""
        values = self._frame[self._labels[column]]
        zone = getattr(getattr(values, "dt", None), "tz", None)
        return np.asarray(values if zone is None else values.dt.tz_convert(None))

    def text(self, column: int) -> list[str]:
        """Return the values of a column as text."""
        return [str(value) for value in np.asarray(self._frame[self._labels[column]]).tolist()]

    def place(self, column: int, row: int) -> str:
        """Return row and column of a value."""
        return f"{self.source}, row {row}, column {self.headers[column]!r}"
