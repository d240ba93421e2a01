"""The guest's kernel: there, or the tests that need it are skipped, or they fail."""

import os

import pytest

from canlab.machine import REQUIRED, missing


@pytest.fixture(scope="session")
def kernel() -> None:
    """Skip where there is no guest to boot; fail where it must not be missing."""
    lacking = missing()
    if lacking and os.environ.get(REQUIRED):
        pytest.fail(f"{REQUIRED} is set, but {lacking}")
    if lacking:
        pytest.skip(lacking)
