"""Reading MATLAB's .mat files of version 5 to 7: variables by name, structs one level deep."""

from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy.typing as npt

from jointid.base.errors import InputError
from jointid.base.unpacking import Room
from jointid.recording.hierarchies.hdf5_table import Hdf5Table
from jointid.recording.readers.mat_elements import Array, DamageError, Variable, variables_of
from jointid.recording.readers.reader import Reader
from jointid.recording.signals import FloatArray, signal_array
from jointid.recording.table import Table

_HDF5 = b"\x89HDF\r\n\x1a\n"
_HEADER = 128  # bytes before the first variable
_ORDERS = {b"IM": "<", b"MI": ">"}  # the header's last two bytes → byte order
_WIDEST = 256  # columns of a matrix: a wider one is not a table of signals


class MatTable:
    """A .mat file as a table of columns.

    A column is a vector (n x 1 or 1 x n). Its name is that of its variable or struct field, or
    ``struct.field`` if the field's name is not unique. A matrix gives one vector per column,
    ``data(:,1)``, or per row if it is wider than long, ``data(1,:)``.

    Parameters
    ----------
    path : Path

    Raises
    ------
    InputError
        The file has version 4, is damaged, is not a .mat file, or has no vectors.
    """

    saved: Mapping[str, Any] | None = None

    def __init__(self, path: Path) -> None:
        self.source = str(path)
        self.header_place = self.source
        self._room = Room(path)
        self._taken: set[int] = set()
        variables = _variables(path, self._room)
        found = [part for variable in variables for part in _columns(variable)]
        short = Counter(field for _, field, _ in found)
        self._arrays = [array for _, _, array in found]
        self.headers = tuple(field if short[field] == 1 else full for full, field, _ in found)
        self.other_names = {full: k for k, (full, _, _) in enumerate(found)}
        if not found:
            shown = ", ".join(repr(each.name[:40]) for each in variables[:8]) or "nothing"
            raise InputError(
                f"no vectors of numbers are found, only {shown}",
                place=str(path),
                remedy="save time and position as vectors or as fields of a struct, not as tables, "
                "timeseries or nested structs",
            )

    def numbers(self, columns: Sequence[int]) -> list[FloatArray]:
        """Return vectors as arrays of shape (n,), or raise `InputError`."""
        return [
            signal_array("", self._array(k), f"{self.source}, variable {self.headers[k]!r}")
            for k in columns
        ]

    def raw(self, column: int) -> npt.NDArray[Any]:
        """Return the values of a column as the file has them."""
        return self._array(column)

    def text(self, column: int) -> list[str]:
        """Return the values of a vector as text."""
        return [f"{value:g}" for value in self._array(column).tolist()]

    def _array(self, column: int) -> Array:
        array = self._arrays[column]
        if column not in self._taken:  # count the memory as float64, after the conversion
            self._room.take(max(0, 8 * array.size - array.nbytes))
            self._taken.add(column)
        return array

    def place(self, column: int, row: int) -> str:
        """Return the place of a value: file, variable and 0-based index."""
        return f"{self.source}, variable {self.headers[column]!r}, index {row}"


def _variables(path: Path, room: Room) -> list[Variable]:
    content = path.read_bytes()
    order = _ORDERS.get(content[_HEADER - 2 : _HEADER])
    if order is None:
        raise InputError(
            "the file is not a .mat file of version 5 to 7, or is truncated",
            place=str(path),
            remedy="in MATLAB save it with '-v7'",
        )
    try:
        return list(variables_of(content[_HEADER:], order, room))
    except DamageError as error:
        raise InputError(
            f"the .mat file is damaged or truncated ({error})", place=str(path)
        ) from None


def _columns(variable: Variable) -> Iterator[tuple[str, str, Array]]:
    """Yield for each vector in a variable: full name, name without the struct, and values."""
    yield from _vectors("", variable)
    for number, element in enumerate(variable.fields, start=1):
        index = f"({number})" if len(variable.fields) > 1 else ""  # such as several runs
        for field in element:
            yield from _vectors(f"{variable.name}{index}.", field)


def _vectors(struct: str, variable: Variable) -> Iterator[tuple[str, str, Array]]:
    array, name = variable.array, variable.name
    if array is None or array.size < 2:  # a single number is a setting, not a signal
        return
    if min(array.shape) == 1:
        yield struct + name, name, array.ravel()
    elif min(array.shape) <= _WIDEST:
        long = array.shape[0] >= array.shape[1]
        for number, vector in enumerate(array.T if long else array, start=1):
            part = f"{name}(:,{number})" if long else f"{name}({number},:)"
            yield struct + part, part, vector


def _opened(path: Path, *, part: str | None = None, kind: str | None = None) -> Table:  # noqa: ARG001
    with path.open("rb") as stream:
        beginning = stream.read(520)
    if not (_HDF5 in (beginning[:8], beginning[512:]) or beginning.startswith(b"MATLAB 7.3")):
        if part is not None:
            raise InputError(
                "MATLAB files up to version 7 have no groups",
                argument="group",
                value=part,
                place=str(path),
            )
        return MatTable(path)
    try:
        return Hdf5Table(path, part)
    except ModuleNotFoundError as error:
        if error.name != "h5py":
            raise
        raise InputError(
            "a MATLAB 7.3 file (HDF5) needs h5py, which is not installed",
            place=str(path),
            remedy=("pip install h5py", "in MATLAB save it with '-v7'"),
        ) from None


READER = Reader(endings=(".mat",), open=_opened, part="group")
