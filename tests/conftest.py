"""Fixtures that several test modules share."""

import signal
from pathlib import Path

import pytest

# What a shell starts in the background ignores Ctrl-C, and its children do. Tests that interrupt a long simulation
# would then wait until memory is full.
if signal.getsignal(signal.SIGINT) is signal.SIG_IGN:
    signal.signal(signal.SIGINT, signal.default_int_handler)


@pytest.fixture(scope="session")
def repo() -> Path:
    """Root of the repository."""
    return Path(__file__).resolve().parents[1]


@pytest.fixture(scope="session")
def shared_data(repo: Path) -> Path:
    """Folder of the recordings that lie beside a developer's checkout."""
    folder = repo.parent / "shared" / "data"
    if not folder.is_dir():
        pytest.skip("../shared/data is not beside this checkout")
    return folder
