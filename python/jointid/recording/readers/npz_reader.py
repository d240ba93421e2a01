"""Reading .npz files: arrays by name, never pickles."""

import io
import tokenize
import zlib
from collections.abc import Mapping, Sequence
from pathlib import Path
from types import MappingProxyType
from typing import Any

import numpy as np
import numpy.typing as npt

from jointid.base.error_text import reason_of
from jointid.base.errors import InputError
from jointid.base.unpacking import Room
from jointid.recording.readers.reader import Reader
from jointid.recording.saved import NPZ_MEMBER, saved_attributes
from jointid.recording.signals import FloatArray, signal_array


def _damages() -> tuple[type[Exception], ...]:
    """Return the exceptions of zipfile, zlib and numpy for damaged, encrypted or absurdly large members."""
    import zipfile

    return (
        *(ValueError, OSError, EOFError, KeyError, RuntimeError, MemoryError, OverflowError),
        *(zipfile.BadZipFile, zlib.error, NotImplementedError),
    )


_CELL = 60  # bytes of a cell as text


class NpzTable:
    """A .npz file as a table of columns.

    Parameters
    ----------
    path : Path

    Raises
    ------
    InputError
        The file is not an archive of arrays.
    """

    other_names: Mapping[str, int] = MappingProxyType({})

    def __init__(self, path: Path) -> None:
        import zipfile

        self.source = str(path)
        self.header_place = self.source
        self._room = Room(path)
        content = io.BytesIO(path.read_bytes())
        if not zipfile.is_zipfile(content):
            raise InputError(
                "the file is not a .npz archive, or is truncated; numpy.savez writes such archives",
                place=str(path),
            )
        content.seek(0)
        try:
            archive = np.load(content, allow_pickle=False)
        except _damages() as error:
            raise InputError(
                f"the archive is damaged ({reason_of(error)})", place=str(path)
            ) from None
        self._archive: Mapping[str, Any] = archive
        # These methods unpack no more of a member than the archive's index states; other methods have no limit.
        for each in archive.zip.infolist():
            if each.compress_type not in (zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED):
                raise InputError(
                    "its compression method differs from the method of numpy.savez_compressed",
                    place=self._place(each.filename.removesuffix(".npy")),
                )
        self._sizes = {
            each.filename.removesuffix(".npy"): each.file_size for each in archive.zip.infolist()
        }
        self._taken: set[str] = set()
        self.saved: Mapping[str, Any] | None = None
        if NPZ_MEMBER in archive.files:
            text = self._member(NPZ_MEMBER)
            self.saved = saved_attributes(str(text), self._place(NPZ_MEMBER))
        self.headers = tuple(name for name in archive.files if name != NPZ_MEMBER)
        if not self.headers:
            raise InputError(
                "the archive is empty; arrays time and position are expected", place=str(path)
            )

    def numbers(self, columns: Sequence[int]) -> list[FloatArray]:
        """Return members as arrays of shape (n,), or raise `InputError`."""
        names = [self.headers[column] for column in columns]
        return [signal_array("", self._member(name), self._place(name)) for name in names]

    def raw(self, column: int) -> npt.NDArray[Any]:
        """Return the values of a column as the file has them."""
        return self._member(self.headers[column])

    def list_widths(self) -> dict[int, int]:
        """Return column → width, for matrices of numbers with one row per sample."""
        shapes = {column: self._shape(name) for column, name in enumerate(self.headers)}
        return {
            k: shape[1]
            for k, shape in shapes.items()
            if len(shape) == 2 and shape[0] > shape[1] > 0
        }

    def lists(self, column: int, width: int) -> FloatArray:
        """Return a matrix of shape (n, width), or raise `InputError`."""
        name = self.headers[column]
        values = np.ravel(self._member(name))
        return signal_array("", values, self._place(name)).reshape(-1, width)

    def _shape(self, name: str) -> tuple[int, ...]:
        """Return the shape of a member by unpacking its beginning only; () if it cannot be read."""
        try:
            with self._archive.zip.open(f"{name}.npy") as member:  # type: ignore[attr-defined]
                version = np.lib.format.read_magic(member)
                read = np.lib.format.read_array_header_1_0
                shape, _, _ = (read if version == (1, 0) else np.lib.format.read_array_header_2_0)(
                    member
                )
        except (SyntaxError, TypeError, tokenize.TokenError):
            return ()
        except _damages():
            return ()
        return tuple(shape)

    def text(self, column: int) -> list[str]:
        """Return the values of a member as text."""
        cells = np.ravel(self._member(self.headers[column]))
        self._room.take(_CELL * cells.size)
        return [str(value) for value in cells.tolist()]

    def place(self, column: int, row: int) -> str:
        """Return the place of a value: file, member and index."""
        return f"{self._place(self.headers[column])}, index {row}"

    def _place(self, name: str) -> str:
        return f"{self.source}, member {name!r}"

    def _member(self, name: str) -> npt.NDArray[Any]:
        if name not in self._taken:  # a column may be read more than once
            self._room.take(self._sizes.get(name, 0))
        try:
            value = self._archive[name]
        except (SyntaxError, TypeError, tokenize.TokenError):  # numpy parses it as Python
            raise InputError("its header is damaged", place=self._place(name)) from None
        except _damages() as error:
            if "allow_pickle" in str(error):
                raise InputError(
                    "it holds Python objects (a pickle); jointid never reads pickles",
                    place=self._place(name),
                    remedy="save it as an array of floats",
                ) from None
            raise InputError(
                f"it cannot be read ({reason_of(error)})", place=self._place(name)
            ) from None
        if not isinstance(value, np.ndarray):
            raise InputError("it is not an array", place=self._place(name))
        if name not in self._taken:  # count the memory as float64, after the conversion
            self._taken.add(name)
            self._room.take(max(0, 8 * value.size - self._sizes.get(name, 0)))
        return value


READER = Reader(endings=(".npz",), open=NpzTable)
