"""The recordings of a folder."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

from jointid.base.errors import InputError


def files_of(paths: Sequence[Any]) -> list[Any]:
    """Return the files, with folders replaced by their files in order of name; a folder that is one recording stays.

    A folder without recordings also stays, so that its reader reports the error.
    """
    found: list[Any] = []
    for path in paths:
        inside = _inside(path) if isinstance(path, str | Path) and Path(path).is_dir() else []
        found += inside or [path]
    return found


def _inside(path: str | Path) -> list[Path]:
    """Return the recordings in a folder; none if the folder is one recording."""
    from jointid.recording.readers.registry import endings, reader_of

    folder = Path(path)
    try:
        reader_of(folder)
    except InputError:
        pass
    else:
        return []
    known = endings()
    inside = sorted(
        each
        for each in folder.iterdir()
        if each.name.lower().endswith(known) and not each.name.startswith(".")
    )
    # A .json file next to other recordings is an estimate, or a logger's settings.
    return [each for each in inside if each.suffix != ".json"] or inside
