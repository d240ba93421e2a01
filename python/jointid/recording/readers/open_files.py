"""Recordings from open files and buffers: they are read as the file that they would be."""

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
"""What holds a recording: a path, or an open file or buffer."""

_NAME = "recording"  # of a buffer
_TEXT = ".csv"
# The first bytes of a file → its ending; what begins otherwise is a text.
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
    """Let a function that reads a file by its path take an open file, too.

    What is left of the open file is read. Its name, if it has one, tells the format and names the recording;
    without one the first bytes tell the format.

    Parameters
    ----------
    function : callable
        Its first argument is a path.
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
            except InputError as error:  # nobody knows the folder
                error.place = error.place.replace(f"{file.parent}{os.sep}", "")
                raise

    return either


def is_open(source: object) -> bool:
    """Return whether it is an open file or buffer."""
    return callable(getattr(source, "read", None))


def _content(source: Any) -> bytes:
    read = source.read()
    if isinstance(read, str):
        return read.encode()
    if isinstance(read, bytes):
        return read
    raise InputError("a file is expected that is open for reading", argument="path", value=source)


def _file_name(source: Any, content: bytes) -> str:
    """The name that an open file has, or would have."""
    name = getattr(source, "name", None)
    if isinstance(name, str) and name and not name.startswith("<"):
        return Path(name).name
    ending = next((each for begin, each in _BEGINNINGS if content.startswith(begin)), _TEXT)
    return f"{_NAME}{ending}"
