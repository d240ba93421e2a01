"""An HDF5 file that is open, with its damage as one sentence and without garbage collection."""

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
    """Pause it; where several threads do, it goes on when the first one ends."""
    resume = gc.isenabled()
    try:
        gc.disable()
        yield
    finally:
        if resume:
            gc.enable()


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
        The file is no HDF5 file, or is damaged: whatever is raised inside the block, as HDF5 documents no errors
        for damaged bytes.
    OSError
        The file cannot be read.
    ModuleNotFoundError
        h5py is not installed.
    """
    import h5py

    path.open("rb").close()  # h5py would say less of a file that cannot be read
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
