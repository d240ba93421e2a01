"""Fixtures that several test modules share."""

import signal
from pathlib import Path

import pytest
from emps_files import TABLE, WITHOUT_EMPS, folder_of_emps, with_table
from hypothesis import HealthCheck, settings
from lanes import QUICK, Lane

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


def pytest_configure(config: pytest.Config) -> None:
    """Measure the tests of the quick lane."""
    if config.getoption("markexpr") == QUICK:
        config.pluginmanager.register(Lane())
