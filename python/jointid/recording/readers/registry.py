"""The list of file formats. A new format is one file in this folder and one line in `MODULES`."""

import json
import shlex
from collections.abc import Iterator
from importlib import import_module
from pathlib import Path

from jointid.base.error_text import alternatives
from jointid.base.errors import InputError
from jointid.base.file_endings import no_ending
from jointid.recording.readers.reader import Reader

# Each module defines `READER`; messages and help list the endings in this order.
MODULES = (
    "csv_reader",
    "npz_reader",
    "mat_reader",
    "parquet_reader",
    "lerobot_reader",
    "mcap_reader",
    "rosbag_reader",
    "hdf5_reader",
    "json_reader",
    "wpilog_reader",
)

_PICKLES = (".pt", ".pth")


def readers() -> Iterator[Reader]:
    """Yield the readers in order; each module is imported when needed."""
    for module in MODULES:
        reader: Reader = import_module(f"jointid.recording.readers.{module}").READER
        yield reader


def endings() -> tuple[str, ...]:
    """Return the endings of all files that can be read."""
    return tuple(ending for reader in readers() for ending in reader.endings)


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
        for reader in readers():
            if reader.marker and (path / reader.marker).is_file():
                return reader
        inside = [each.name.lower() for each in path.iterdir()]
        for reader in readers():
            if reader.folder and _is_whole(inside, reader.folder):
                return reader
    name = path.name.lower()
    for reader in readers():
        if name.endswith(reader.endings):  # endings of two readers never overlap
            return reader
    if name.endswith(_PICKLES):
        raise InputError(
            "this is a PyTorch pickle; jointid never reads pickles, because they may run code",
            place=str(path),
            remedy=f"convert it with {_conversion(path)}",
        )
    raise no_ending(path, endings())


def _conversion(path: Path) -> str:
    """Return the command that writes a dictionary of tensors as .npz."""
    code = (
        f"import numpy, torch; d = torch.load({json.dumps(str(path))}, weights_only=True); "
        f"numpy.savez({json.dumps(str(path.with_suffix('.npz')))}, **{{k: v.cpu().numpy() for k, v in d.items()}})"
    )
    return f"python -c {shlex.quote(code)}"


def _is_whole(names: list[str], endings: tuple[str, ...]) -> bool:
    """Whether a folder with these files is one recording: it has the marker, or no other files."""
    if not any(name.endswith(endings) for name in names):
        return False
    return "metadata.yaml" in names or all(name.endswith(endings) for name in names)
