"""Fixtures that several test modules share."""

import os
import signal
from itertools import chain
from pathlib import Path

import pytest
from slowest_files import phases, slowest_files

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


def pytest_terminal_summary(terminalreporter: pytest.TerminalReporter) -> None:
    """In CI, say what takes its time."""
    if not os.environ.get("CI"):
        return
    reports = chain.from_iterable(terminalreporter.stats.values())
    parts = [
        (each.nodeid, each.duration) for each in reports if isinstance(each, pytest.TestReport)
    ]
    if before := phases():
        terminalreporter.section("phases of CI before these tests")
        terminalreporter.write_line("\n".join(before))
    terminalreporter.section("slowest files")
    terminalreporter.write_line("\n".join(slowest_files(parts)))
