"""Session and emulated drive in two processes on the kernel's CAN: what may happen to them, and 50 kills."""

from __future__ import annotations

import sys
from collections.abc import Callable
from contextlib import ExitStack, closing
from pathlib import Path

import pytest

import jointid as jid
from canlab.kills import KILLS
from canlab.machine import Guest
from canlab.outcome import Outcome
from canlab.scenarios import SCENARIOS

pytestmark = pytest.mark.slow
PATIENCE = 600.0  # [s] for what takes a sixth of that on a machine that is not busy
NUMBERS = [str(number) for number in range(KILLS)]


@pytest.fixture(scope="module")
def guests(
    kernel: None, request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory
) -> dict[str, Outcome]:
    """Outcomes of the tests that were asked for; every other one in a guest each, at the same time."""
    asked = {
        item.callspec.params.get("name")
        for item in request.session.items
        if isinstance(item, pytest.Function)
        and item.path == Path(__file__)  # others have a parameter of that name, too
        and hasattr(item, "callspec")
    }
    every = [name for name in (*SCENARIOS, *NUMBERS) if name in asked]
    outcomes: dict[str, Outcome] = {}
    with ExitStack() as running:
        guests = []
        for names in (every[::2], every[1::2]):  # a scenario takes as long as a kill
            if names:
                folder = tmp_path_factory.mktemp("guest")
                guests.append(running.enter_context(closing(guest(folder, names))))
                outcomes |= {name: Outcome(folder / name) for name in names}
        for each in guests:
            each.wait(PATIENCE)
    return outcomes


def guest(folder: Path, names: list[str]) -> Guest:
    """Play what is named, with the Python and the packages of this process."""
    tests, package = Path(__file__).parents[1], Path(jid.__file__).parents[1]
    environment = {
        "PYTHONPATH": f"{package}:{tests}",
        "PYTHONDONTWRITEBYTECODE": "1",
        "OPENBLAS_NUM_THREADS": "1",
    }
    return Guest(folder, (sys.executable, "-m", "canlab.inside", *names), environment)


def judge(outcome: Outcome, check: Callable[[Outcome], object]) -> None:
    """Check an outcome; a failure shows what the programs in the guest wrote."""
    try:
        assert not outcome.error
        check(outcome)
    except BaseException as failure:
        failure.add_note(outcome.said())
        raise


@pytest.mark.parametrize("name", SCENARIOS)
def test_scenario(name: str, guests: dict[str, Outcome]) -> None:
    judge(guests[name], SCENARIOS[name].check)


def killed(outcome: Outcome) -> None:
    outcome.off_by_the_watchdog()
    outcome.left_by_a_killed_session()


@pytest.mark.parametrize("name", NUMBERS)
def test_a_host_that_is_killed(name: str, guests: dict[str, Outcome]) -> None:
    judge(guests[name], killed)
