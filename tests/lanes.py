"""What tests cost, where `-m "not slow"` chooses the quick ones: an unmarked test that is slow is an error there."""

import os
from collections.abc import Callable, Generator, Iterable, Iterator
from itertools import chain
from typing import Any

import pytest

QUICK = "not slow"
SHOWN = 2.0  # s of CPU
ALLOWED = 6.0
_PROPERTY = "cpu_seconds"


def slow_but(cases: Iterable[Any], *quick: str) -> list[Any]:
    """Return the cases of a parametrised test, marked slow but those of these names."""
    return [
        each
        if getattr(each, "__name__", each) in quick
        else pytest.param(each, marks=pytest.mark.slow)
        for each in cases
    ]


def cpu_seconds() -> float:
    """Return what this process has used, and its children that have ended."""
    used = os.times()
    return used.user + used.system + used.children_user + used.children_system


class Lane:
    """Measures each test's setup, call and teardown, in the process that runs it.

    What a fixture of a wider scope takes is not the test's that happens to be first or last: it is listed apart, and
    has no limit. A teardown after which another parent's tests follow counts as such.

    Parameters
    ----------
    clock : callable
        The seconds used so far.
    """

    def __init__(self, clock: Callable[[], float] = cpu_seconds) -> None:
        self._clock = clock
        self._last = 0.0
        self._own = 0.0
        self._shared: dict[str, float] = {}
        self._inside = False  # a fixture of a wider scope
        self._ends = False  # with this test's teardown those of wider scopes may come

    @pytest.hookimpl(wrapper=True)
    def pytest_runtest_protocol(
        self, item: pytest.Item, nextitem: pytest.Item | None
    ) -> Iterator[None]:
        """Begin a test."""
        self._own, self._shared = 0.0, {}
        self._ends = nextitem is None or nextitem.parent is not item.parent
        self._last = self._clock()
        return (yield)

    @pytest.hookimpl(wrapper=True)
    def pytest_fixture_setup(self, fixturedef: pytest.FixtureDef[Any]) -> Iterator[None]:
        """Measure a fixture that several tests share; one that it asks for is part of it."""
        if self._inside or fixturedef.scope == "function":
            return (yield)
        self._inside, begin = True, self._clock()
        try:
            return (yield)
        finally:
            self._inside = False
            self._add(f"fixture {fixturedef.argname}", self._clock() - begin)

    def _add(self, name: str, seconds: float) -> None:
        self._shared[name] = self._shared.get(name, 0.0) + seconds
        self._own -= seconds

    @pytest.hookimpl(wrapper=True)
    def pytest_runtest_makereport(
        self, item: pytest.Item, call: pytest.CallInfo[None]
    ) -> Generator[None, pytest.TestReport, pytest.TestReport]:
        """End a phase: the report of the last one carries what the test took, or fails."""
        now = self._clock()
        spent, self._last = now - self._last, now
        self._own += spent
        if call.when != "teardown":
            return (yield)
        if self._ends:
            self._add("shared teardown", spent)
        parts = {"": self._own, **self._shared}
        item.user_properties.append((_PROPERTY, parts))
        report = yield
        if self._own > ALLOWED and report.passed:
            report.outcome = "failed"
            report.longrepr = (
                f"{item.nodeid} took {self._own:.1f} s of CPU; without the mark `slow` at most {ALLOWED:.0f} s are "
                "allowed: mark it slow, and keep a quick test of the same promise"
            )
        return report

    def pytest_terminal_summary(self, terminalreporter: pytest.TerminalReporter) -> None:
        """List what took long."""
        rows = slowest(chain.from_iterable(terminalreporter.stats.values()))
        if rows:
            terminalreporter.section(f"more than {SHOWN:.0f} s of CPU, and not marked slow")
            terminalreporter.write_line("\n".join(rows))


def slowest(reports: Iterator[Any]) -> list[str]:
    """Return a line for each test, or fixture of a wider scope, that took long; the longest first."""
    costs = [
        (seconds, f"{report.nodeid}{part and f' ({part})'}")
        for report in reports
        if getattr(report, "when", "") == "teardown"
        for name, parts in report.user_properties
        if name == _PROPERTY
        for part, seconds in parts.items()
        if seconds > SHOWN
    ]
    return [f"{seconds:6.1f} s  {name}" for seconds, name in sorted(costs, reverse=True)]
