"""Files for the tests of loading."""

import gzip
import io
import math
import re
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from jointid.base.errors import InputError
from jointid.recording.readers.loading import load

N = 10
# What a reason must not contain: the command line shows it too.
_PYTHON = re.compile(r"\b(columns|units|scale|where|kind|name|path|by)=|\bjid\.|\bjointid\.")
ROWS = [[k * 0.01, math.sin(k), 0.5 * k, -1.25] for k in range(N)]


def lines(header: str, rows: list[list[float]] | None = None) -> list[str]:
    """Header and rows, with as many cells as the header."""
    width = header.count(",") + 1
    return [header, *(",".join(map(repr, row[:width])) for row in rows or ROWS)]


def written(path: Path, text: list[str] | str | bytes) -> Path:
    content = "\n".join(text) if isinstance(text, list) else text
    raw = content.encode() if isinstance(content, str) else content
    path.parent.mkdir(exist_ok=True)
    path.write_bytes(gzip.compress(raw) if path.suffix == ".gz" else raw)
    return path


def column(number: int) -> list[float]:
    return [row[number] for row in ROWS]


def npz(path: Path, **arrays: Any) -> Path:
    np.savez(path, **arrays)
    return path


def mat(path: Path, variables: Mapping[str, Any], **options: Any) -> Path:
    from scipy.io import savemat

    stream = io.BytesIO()
    savemat(stream, dict(variables), **options)  # type: ignore[arg-type]
    return written(path, stream.getvalue())


GOOD = lines("time_s,position_rad,velocity_rad_s,torque_Nm")


def with_line(number: int, text: str) -> list[str]:
    """Return the good file with another text on a 1-based line."""
    return [*GOOD[: number - 1], text, *GOOD[number:]]


def headed(header: str) -> list[str]:
    return [header, *GOOD[1:]]


def marked(attributes: str) -> list[str]:
    return [f"# jointid recording {attributes}", *GOOD]


def refusal(path: Path, **arguments: Any) -> str:
    with pytest.raises(InputError) as caught:
        load(path, **arguments)
    assert not _PYTHON.search(caught.value.reason), caught.value.reason
    return str(caught.value)


def refused(path: Path, load: Callable[[Path], object] = load) -> str:
    """Return the one sentence that another way of loading says, which names the file."""
    with pytest.raises(InputError) as caught:
        load(path)
    assert "\n" not in str(caught.value)
    assert path.name in str(caught.value)
    return str(caught.value)


def assert_one_sentence(message: str, path: Path) -> None:
    assert message.startswith(str(path)), message
    rest = message.removeprefix(str(path))
    assert "\n" not in rest
    assert not rest.removesuffix("=...").endswith(".")
    assert ". " not in rest.replace("...", "")
