"""Writing a recording: .csv, .csv.gz and .npz, which `load` reads back bit for bit."""

import io
import os
from collections.abc import Callable

import numpy as np

from jointid.base.argument_checks import require_path
from jointid.base.errors import InputError
from jointid.base.file_endings import ending_of
from jointid.base.files import write_whole
from jointid.recording.extra import PREFIX
from jointid.recording.samples import Samples
from jointid.recording.saved import ATTRIBUTES, CSV_MARK, NPZ_MEMBER, SCHEMA
from jointid.recording.signals import header_unit


def save_recording(recording: Samples, path: str | os.PathLike[str]) -> None:
    """Write a recording to a file: see `Recording.save`."""
    target = require_path("path", path)
    writer = _WRITERS[ending_of(target, ENDINGS)]
    if target.is_dir():
        raise InputError("this is a folder; a file name is expected", place=str(target))
    write_whole(target, writer(recording))


def attributes_text(recording: Samples) -> str:
    """Return the recording's attributes that are not columns, as JSON; `saved_attributes` reads them."""
    attributes = {name: getattr(recording, name) for name in ATTRIBUTES}
    for name in ("metadata", "truth"):  # JSON needs a dict, not a read-only view
        attributes[name] = None if attributes[name] is None else dict(attributes[name])
    import json

    return json.dumps({"schema": SCHEMA, **attributes})


def _csv(recording: Samples) -> bytes:
    names = recording.signals
    headers = [f"{name}_{header_unit(name, recording.kind)}" for name in names]
    headers += [PREFIX + name for name in recording.extra]
    columns = [getattr(recording, name).tolist() for name in names]
    columns += [values.tolist() for values in recording.extra.values()]
    rows = (",".join(map(repr, row)) for row in zip(*columns, strict=True))
    lines = [CSV_MARK + attributes_text(recording), ",".join(headers), *rows, ""]
    return "\n".join(lines).encode("ascii")


def _npz(recording: Samples) -> bytes:
    arrays = {name: getattr(recording, name) for name in recording.signals}
    arrays |= {PREFIX + name: values for name, values in recording.extra.items()}
    arrays[NPZ_MEMBER] = np.array(attributes_text(recording))
    stream = io.BytesIO()
    np.savez_compressed(stream, allow_pickle=False, **arrays)
    return stream.getvalue()


def _compressed_csv(recording: Samples) -> bytes:
    # No time stamp inside: the same recording gives the same file.
    import gzip

    return gzip.compress(_csv(recording), compresslevel=6, mtime=0)


_WRITERS: dict[str, Callable[[Samples], bytes]] = {
    ".csv": _csv,
    ".csv.gz": _compressed_csv,
    ".npz": _npz,
}
ENDINGS = tuple(_WRITERS)  # endings of the files that can be written
