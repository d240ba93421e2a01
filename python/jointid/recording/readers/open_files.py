"""Reading recordings from open files and buffers, through a temporary file."""

from __future__ import annotations

import functools
import os
from collections.abc import Callable
from pathlib import Path
from typing import IO, Any, ParamSpec, TypeVar

from jointid.base.errors import InputError

P = ParamSpec("P")
Read = TypeVar("Read")

Source = str | os.PathLike[str] | IO[str] | IO[bytes]
"""Source of a recording: a path, or an open file or buffer."""

_NAME = "recording"  # name of a buffer's file
_TEXT = ".csv"
# First bytes of a file → its ending; any other file is text.
_BEGINNINGS = (
    (b"\x1f\x8b", ".csv.gz"),
    (b"PK", ".npz"),
    (b"PAR1", ".parquet"),
    (b"MATLAB 5", ".mat"),
    (b"MATLAB 7", ".mat"),
    (b"\x89HDF", ".h5"),
    (b"\x89MCAP", ".mcap"),
    (b"#ROSBAG", ".bag"),
    (b"SQLite", ".db3"),
    (b"{", ".json"),
    (b"[{", ".json"),
)


def reads_open_files(function: Callable[P, Read]) -> Callable[P, Read]:
    """Let a function that reads a file by path also accept an open file.

    The rest of the open file is read. Its name, if any, determines the format and the recording's name.
    Without a name the first bytes determine the format.

    Parameters
    ----------
    function : callable
        Function with a path as first argument.
    """

    @functools.wraps(function)
    def either(*args: Any, **options: Any) -> Any:
        path = args[0] if args else options.get("path")
        if not is_open(path):
            return function(*args, **options)
        from tempfile import TemporaryDirectory

        content = _content(path)
        with TemporaryDirectory() as folder:
            file = Path(folder) / _file_name(path, content)
            file.write_bytes(content)
            rest = {name: value for name, value in options.items() if name != "path"}
            try:
                return function(file, *args[1:], **rest)  # type: ignore[arg-type]
            except InputError as error:  # the temporary folder means nothing to the user
                error.place = error.place.replace(f"{file.parent}{os.sep}", "")
                raise

    return either


def is_open(source: object) -> bool:
    """Return whether the source is an open file or buffer."""
    return callable(getattr(source, "read", None))


def _content(source: Any) -> bytes:
    read = source.read()
    if isinstance(read, str):
        return read.encode()
    if isinstance(read, bytes):
        return read
    raise InputError("a file that is open for reading is expected", argument="path", value=source)


def _file_name(source: Any, content: bytes) -> str:
    """Return the name of an open file, or a name with the ending of its format."""
    name = getattr(source, "name", None)
    if isinstance(name, str) and name and not name.startswith("<"):
        return Path(name).name
    ending = next((each for begin, each in _BEGINNINGS if content.startswith(begin)), _TEXT)
    return f"{_NAME}{ending}"
