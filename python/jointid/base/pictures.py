"""Writing a picture completely or not at all."""

from __future__ import annotations

import io
from pathlib import Path
from typing import Any

from jointid.base.files import write_whole


def write_picture(figure: Any, path: Path, **options: Any) -> None:
    """Write a matplotlib figure to a file; on failure an existing file is unchanged.

    Parameters
    ----------
    figure : matplotlib.figure.Figure
    path : Path
        File name; its ending chooses the format.
    **options
        Options of `Figure.savefig`.

    Raises
    ------
    InputError, OSError
        Same errors as `write_whole`.
    """
    content = io.BytesIO()
    figure.savefig(content, format=path.suffix[1:].lower(), **options)
    write_whole(path, content.getvalue())
