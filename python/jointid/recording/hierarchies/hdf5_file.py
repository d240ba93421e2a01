"""Opening an HDF5 file: damage becomes one clear error, and garbage collection is paused."""

from __future__ import annotations

import gc
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from jointid.base.error_text import reason_of
from jointid.base.errors import InputError


@contextmanager
def _without_garbage_collection() -> Iterator[None]:
    """Pause garbage collection; with several threads it resumes when the first one ends."""
    resume = gc.isenabled()
    try:
        gc.disable()
        yield
    finally:
        if resume:
            gc.enable()


@contextmanager
def opened(path: Path) -> Iterator[Any]:
    """Open an HDF5 file for reading.

    Garbage collection is paused while the file is open. Before version 3.12, Python may collect garbage while
    h5py converts a library error to an exception. If the garbage holds an HDF5 object, closing it deletes the
    error's text before h5py reads it.

    Parameters
    ----------
    path : Path

    Yields
    ------
    h5py.File

    Raises
    ------
    InputError
        The file is not an HDF5 file, or is damaged. Any exception inside the block counts as damage, because HDF5
        documents no errors for damaged bytes.
    OSError
        The file cannot be read.
    ModuleNotFoundError
        h5py is not installed.
    """
    import h5py

    path.open("rb").close()  # for an unreadable file this error says more than h5py's
    try:
        with _without_garbage_collection():
            if not h5py.is_hdf5(path):
                raise InputError("the file is not an HDF5 file, or is truncated", place=str(path))
            with h5py.File(path, "r", locking=False) as file:
                yield file
    except InputError:
        raise
    except Exception as error:
        raise InputError(f"the file is damaged ({reason_of(error)})", place=str(path)) from None
