"""Reading HDF5 files with h5py, which the extra `hdf5` installs."""

from pathlib import Path

from jointid.recording.readers.reader import Reader
from jointid.recording.table import Table


def _opened(path: Path, *, part: str | None = None, kind: str | None = None) -> Table:  # noqa: ARG001
    from jointid.recording.hierarchies.hdf5_table import Hdf5Table

    return Hdf5Table(path, part)


READER = Reader(endings=(".h5", ".hdf5"), open=_opened, package="h5py", part="group")
