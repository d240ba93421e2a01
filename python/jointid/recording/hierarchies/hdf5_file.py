"""An HDF5 file that is open, with its damage as one sentence and without garbage collection."""

from __future__ import annotations

import gc
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from threading import Lock
from typing import Any

from jointid.base.error_text import reason_of
from jointid.base.errors import InputError


class _Pause:
    """Garbage collection paused by any number of blocks in any threads, until the last one ends."""

    def __init__(self) -> None:
        self._lock = Lock()
        self._blocks = 0
        self._resume = False

    def __enter__(self) -> None:
        with self._lock:
            if self._blocks == 0:
                self._resume = gc.isenabled()
                gc.disable()
            self._blocks += 1

    def __exit__(self, *_: object) -> None:
        with self._lock:
            self._blocks -= 1
            if self._blocks == 0 and self._resume:
                gc.enable()


_no_garbage_collection = _Pause()


@contextmanager
def opened(path: Path) -> Iterator[Any]:
    """Open an HDF5 file to read it.

    No garbage is collected as long as it is open. When h5py makes an exception of the library's error, Python
    before 3.12 may collect garbage at each object it makes; garbage with an HDF5 object in it is closed then,
    which deletes the error's text before h5py has read it.

    Parameters
    ----------
    path : Path

    Yields
    ------
    h5py.File

    Raises
    ------
    InputError
        The file is damaged: whatever is raised inside the block, as HDF5 documents no errors for damaged bytes.
    ModuleNotFoundError
        h5py is not installed.
    """
    import h5py

    try:
        with _no_garbage_collection, h5py.File(path, "r", locking=False) as file:
            yield file
    except InputError:
        raise
    except Exception as error:
        raise InputError(f"the file is damaged ({reason_of(error)})", place=str(path)) from None
