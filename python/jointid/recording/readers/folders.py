"""The recordings of a folder."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

from jointid.base.errors import InputError


def files_of(paths: Sequence[Any]) -> list[Any]:
    """Return the files, and those of folders in the order of their names; a folder that is one recording is itself.

    A folder without recordings stays, so that what reads it says what is wrong.
    """
    found: list[Any] = []
    for path in paths:
        inside = _inside(path) if isinstance(path, str | Path) and Path(path).is_dir() else []
        found += inside or [path]
    return found


def _inside(path: str | Path) -> list[Path]:
    """Return the recordings that stand in a folder; none where the folder is a recording."""
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
    # A .json file beside other recordings is an estimate, or a logger's settings.
    return [each for each in inside if each.suffix != ".json"] or inside
