"""Fixtures that several test modules share."""

import os
import signal
from itertools import chain
from pathlib import Path

import pytest
from emps_files import TABLE, WITHOUT_EMPS, folder_of_emps, with_table
from hypothesis import HealthCheck, settings
from slowest_files import phases, place_of, slowest_files

# How long an example takes says how busy the machine is.
settings.register_profile("jointid", deadline=None, suppress_health_check=[HealthCheck.too_slow])
settings.load_profile("jointid")

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
    """Folder of the recordings, measured by others or simulated, that may be shared."""
    folder = repo / "tests" / "data"
    if not folder.is_dir():
        pytest.skip("tests/data comes with the repository, not with the sdist")
    return folder


@pytest.fixture(scope="session")
def emps(repo: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Folder of EMPS: ``DATA_EMPS.mat`` as its authors publish it, and the same as ``emps_train.csv.gz``."""
    folder = folder_of_emps(repo)
    if folder is None:
        pytest.skip(WITHOUT_EMPS)
    if (folder / TABLE).is_file():
        return folder
    return with_table(folder, tmp_path_factory.mktemp("emps"))


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Let the longest files start first."""
    items.sort(key=lambda item: place_of(item.path, Path(__file__).resolve().parent))


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
