"""Session and emulated drive in two processes on the kernel's CAN, and what may happen to them there."""

from __future__ import annotations

import os
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest
from canlab.machine import REQUIRED, Guest, missing
from canlab.outcome import Outcome
from canlab.scenarios import SCENARIOS

import jointid as jid

PATIENCE = 240.0  # [s] for what takes a fifth of that
Outcomes = dict[str, Outcome]


@pytest.fixture(scope="module")
def outcomes(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> Outcomes:
    """Of the scenarios of the tests that were asked for, all played in one guest."""
    lacking = missing()
    if lacking:
        if os.environ.get(REQUIRED):
            pytest.fail(f"{REQUIRED} is set, but {lacking}")
        pytest.skip(lacking)
    callspecs = (getattr(item, "callspec", None) for item in request.session.items)
    asked = {spec.params.get("scenario") for spec in callspecs if spec is not None}
    names = [name for name in SCENARIOS if name in asked]
    folder = tmp_path_factory.mktemp("vcan")
    tests, package = Path(__file__).parents[1], Path(jid.__file__).parents[1]
    environment = {
        "PYTHONPATH": f"{package}:{tests}",
        "PYTHONDONTWRITEBYTECODE": "1",
        "OPENBLAS_NUM_THREADS": "1",
        "HOME": "/run",
    }
    Guest(folder, [sys.executable, "-m", "canlab.inside", *names], environment).wait(PATIENCE)
    return {name: Outcome(folder / name) for name in names}


@pytest.mark.parametrize("scenario", SCENARIOS)
def test_scenario(scenario: str, outcomes: Outcomes) -> None:
    outcome = outcomes[scenario]
    try:
        assert not outcome.error
        SCENARIOS[scenario].check(outcome)
    except Exception as error:
        error.add_note(outcome.said())
        raise
