"""The list of file formats. A new format is one file beside this one, and one line in `MODULES`."""

from importlib import import_module
from pathlib import Path

from jointid.base.error_text import alternatives
from jointid.base.file_endings import ending_of
from jointid.recording.readers.reader import Reader

# Each module defines `READER`; messages and help list the endings in this order.
MODULES = (
    "csv_reader",
    "npz_reader",
    "mat_reader",
    "parquet_reader",
    "mcap_reader",
    "rosbag_reader",
    "hdf5_reader",
)

READERS: tuple[Reader, ...] = tuple(
    import_module(f"jointid.recording.readers.{module}").READER for module in MODULES
)


def endings() -> tuple[str, ...]:
    """Return the endings of all files that can be read."""
    return tuple(ending for reader in READERS for ending in reader.endings)


def endings_text() -> str:
    """Return the endings as alternatives in a sentence: ``".csv, .csv.gz or .npz"``."""
    return alternatives(endings())


def reader_of(path: Path) -> Reader:
    """Return the reader for a file, by the ending of its name.

    Raises
    ------
    InputError
        No reader reads such files.
    """
    if path.is_dir():
        inside = [each.name.lower() for each in path.iterdir()]
        for reader in READERS:
            if reader.folder and _is_whole(inside, reader.folder):
                return reader
    ending = ending_of(path, endings())
    return next(reader for reader in READERS if ending in reader.endings)


def _is_whole(names: list[str], endings: tuple[str, ...]) -> bool:
    """Whether a folder with these files is a recording: it says so, or there is nothing else in it."""
    if not any(name.endswith(endings) for name in names):
        return False
    return "metadata.yaml" in names or all(name.endswith(endings) for name in names)
