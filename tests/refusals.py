"""What is said of a file that is not read."""

from collections.abc import Callable
from pathlib import Path

import pytest

import jointid as jid


def refused(path: Path, load: Callable[[Path], object] = jid.load) -> str:
    """Return the one sentence, which names the file."""
    with pytest.raises(jid.InputError) as caught:
        load(path)
    assert "\n" not in str(caught.value)
    assert path.name in str(caught.value)
    return str(caught.value)
