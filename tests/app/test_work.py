"""How long work of the page may take: first by its samples, then by what was measured, then by its own pace."""

from __future__ import annotations

import time

import pytest

from jointid.app.work import Work


class Clock:
    """A clock that stands until it is moved."""

    def __init__(self) -> None:
        self.now = 100.0

    def __call__(self) -> float:
        return self.now


@pytest.fixture
def clock(monkeypatch: pytest.MonkeyPatch) -> Clock:
    stands = Clock()
    monkeypatch.setattr(time, "monotonic", stands)
    return stands


def test_work_that_reports_no_share_is_shown_by_the_clock(clock: Clock) -> None:
    work = Work()
    work.begin("identifying", samples=1_000_000)
    first = work.expected
    assert first is not None
    clock.now += first / 2
    assert work.shown_share == pytest.approx(0.5)
    clock.now += first
    assert work.shown_share < 1.0
    assert "longer than the expected" in work.text
    work.end(done=True)
    assert work.text == ""
    work.begin("identifying", samples=500_000)
    assert work.expected == pytest.approx(0.75 * first)  # measured: 1.5 times the first guess


def test_work_that_was_cancelled_says_nothing_of_the_next_one(clock: Clock) -> None:
    work = Work()
    work.begin("comparing", samples=1_000_000)
    first = work.expected
    clock.now += 0.1
    work.end(done=False)
    work.begin("comparing", samples=1_000_000)
    assert work.expected == first


def test_work_that_reports_its_share_is_shown_by_its_own_pace(clock: Clock) -> None:
    work = Work()
    work.begin("comparing", samples=1000)
    guess = work.expected
    clock.now += 6.0
    work.progress(0.05, "fit 1 of 20")
    assert work.expected == guess  # too little is done to say more
    work.progress(0.25, "fit 5 of 20")
    assert work.expected == pytest.approx(24.0)
    assert work.shown_share == 0.25
    assert work.text == "comparing, fit 5 of 20: 6 s of about 24 s"


def test_work_of_which_nothing_is_known_shows_its_time_alone(clock: Clock) -> None:
    work = Work()
    work.begin("reading")
    clock.now += 2.0
    assert (work.text, work.shown_share) == ("reading: 2 s", 0.0)
