"""An HDF5 file as a table of columns."""

from collections import Counter
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy.typing as npt

from jointid.base.errors import InputError
from jointid.base.unpacking import Room
from jointid.recording.headers import parsed
from jointid.recording.hierarchies import hdf5_chunks
from jointid.recording.hierarchies.datasets import Vector, values_of, vectors_of
from jointid.recording.hierarchies.groups import chosen_vectors
from jointid.recording.hierarchies.hdf5_file import opened
from jointid.recording.signals import FloatArray, signal_array
from jointid.recording.table import MOST_COLUMNS


class Hdf5Table:
    """An HDF5 file as a table of columns; only the columns used are read.

    A column is a vector (n, n x 1 or 1 x n) or a field of a table. Its name is that of its dataset or field, or the
    whole path if this name is not unique. The columns of a matrix are ``NAME(:,1)``, ``NAME(:,2)`` as in other MATLAB
    files, or ``joint_1.NAME``, ``joint_2.NAME``. A matrix that is wider than long has one row per joint.

    Parameters
    ----------
    path : Path
    group : str or None
        Only this group is read, with the datasets of its parent groups. Default: the whole file.

    Raises
    ------
    InputError
        The file is damaged or not an HDF5 file, or it has no vectors, no such group, or several groups alike.
    ModuleNotFoundError
        h5py is not installed.
    """

    saved: Mapping[str, Any] | None = None

    def __init__(self, path: Path, group: str | None) -> None:
        self._path = path
        self._room = Room(path)
        self._taken: set[str] = set()
        self.source = self.header_place = str(path)
        with opened(path) as file:
            vectors, left_out = vectors_of(file, self._room)
        if len(vectors) > MOST_COLUMNS:
            raise InputError(
                f"the file has more than {MOST_COLUMNS} columns; at most {MOST_COLUMNS} are read",
                place=str(path),
            )
        if not vectors:
            raise InputError(
                f"no vectors of numbers are found{_not_read(left_out)}",
                place=str(path),
                remedy="save time and position as vectors",
            )
        self._vectors = chosen_vectors(str(path), vectors, group)
        groups: dict[str, set[str]] = {}  # name → groups that hold a vector of this name
        for vector in self._vectors:
            groups.setdefault(vector.last, set()).add(vector.group)
        names = [_name(vector, groups[vector.last]) for vector in self._vectors]
        count = Counter(names)
        self.headers = tuple(
            _with_unit(name if count[name] == 1 else _full(vector, "/"), vector.unit)
            for name, vector in zip(names, self._vectors, strict=True)
        )
        self.other_names = {
            other: k
            for k, vector in enumerate(self._vectors)
            for other in dict.fromkeys(
                (
                    *(_full(vector, "/"), "/" + _full(vector, "/"), _full(vector, "."), names[k]),
                    *(_as_of_a_joint(vector) if count[names[k]] == 1 else ()),
                )
            )
            if count[other] <= 1
        }
        parts = [_part(vector) for vector in self._vectors]
        often = Counter(parts)
        self.other_names |= {part: k for k, part in enumerate(parts) if part and often[part] == 1}
        self.notes = {"not_read": left_out} if left_out else {}

    def numbers(self, columns: Sequence[int]) -> list[FloatArray]:
        """Return columns as arrays of shape (n,), or raise `InputError`."""
        return [
            signal_array("", values, f"{self.source}, dataset {self.headers[column]!r}")
            for column, values in zip(columns, self._read(columns), strict=True)
        ]

    def raw(self, column: int) -> npt.NDArray[Any]:
        """Return the values of a column as the file has them."""
        (values,) = self._read([column])
        return values

    def text(self, column: int) -> list[str]:
        """Return the values of a column as text."""
        return [f"{value:g}" for value in self.numbers([column])[0].tolist()]

    def place(self, column: int, row: int) -> str:
        """Return the place of a value: file, dataset and 0-based index."""
        return f"{self.source}, dataset {self.headers[column]!r}, index {row}"

    def _read(self, columns: Sequence[int]) -> list[npt.NDArray[Any]]:
        with opened(self._path) as file:
            for dataset in {self._vectors[column].path for column in columns} - self._taken:
                hdf5_chunks.take(file[dataset], self._room)
                self._taken.add(dataset)
            return [values_of(file, self._vectors[column]) for column in columns]


def _not_read(left_out: Sequence[str]) -> str:
    return f"; objects such as {left_out[0]} are not read" if left_out else ""


def _name(vector: Vector, groups: set[str]) -> str:
    """Return a vector's name, with the column number for a matrix, as in other MATLAB files."""
    if vector.name or vector.part is None:
        return _joint_group(vector, groups) + vector.last
    return f"{vector.last}(:,{vector.part + 1})"


def _as_of_a_joint(vector: Vector) -> tuple[str, ...]:
    """Return the other names of a matrix's column: the joint's number, then the signal."""
    if vector.name or vector.part is None:
        return ()
    name = f"joint_{vector.part + 1}.{vector.last}"
    return name, _with_unit(name, vector.unit)


def _joint_group(vector: Vector, groups: set[str]) -> str:
    """Return the group as prefix of the name if each of several groups holds one joint."""
    return f"{vector.group.rpartition('/')[2]}." if len(groups) > 1 and vector.group else ""


def _full(vector: Vector, separator: str) -> str:
    name = separator.join([*vector.path.split("/"), *vector.field])
    return name if vector.part is None else f"{name}(:,{vector.part + 1})"


def _part(vector: Vector) -> str:
    """Return the name of a column of a matrix without its groups."""
    return "" if vector.part is None else f"{vector.last}(:,{vector.part + 1})"


def _with_unit(name: str, unit: str) -> str:
    return f"{name} [{unit}]" if unit and parsed(name)[1] is None else name
