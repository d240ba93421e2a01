"""Both sides of what makes an attribution name a cause: enough of the misfit, surely, and more than its rivals."""

from __future__ import annotations

import math
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from jointid.identification.causes import attribution, changes, events, fitted, residual_test
from jointid.identification.causes.attribution import Score, score_of
from jointid.identification.causes.candidates import Candidate
from jointid.identification.causes.events import LocalEvent, local_event
from jointid.identification.causes.families import against_delay
from jointid.identification.causes.fitted import Fitted
from jointid.identification.causes.folds import Folds
from jointid.identification.causes.slow_passages import slow_rows


def _folds(before: Any, after: Any) -> Any:
    """Misfits of the blocks with the columns of the base, [0], and with more."""
    known = {1: np.asarray(before, dtype=float), 2: np.asarray(after, dtype=float)}
    return SimpleNamespace(
        misfit=lambda columns: known[len(columns)],
        total=lambda columns: float(known[len(columns)].sum()),
    )


def _score(*scales: tuple[int, float], whole: float = 20.0) -> Score:
    """Of columns that take this share of 20 blocks' misfit at each scale, alike in all of them."""
    scaled = [(factor, _folds(np.ones(20), np.full(20, 1.0 - share))) for factor, share in scales]
    return score_of(scaled, [0], [1], {factor: whole for factor, _ in scales})


@pytest.mark.parametrize(
    ("share", "whole", "sure"),
    [(0.119, 20.0, False), (0.121, 20.0, True), (0.2, 79.0, True), (0.2, 81.0, False)],
)
def test_a_cause_takes_an_eighth_of_what_is_left_and_a_twentieth_of_all(
    share: float, whole: float, sure: bool
) -> None:
    assert _score((1, share), whole=whole).sure == sure


def test_a_score_is_of_all_scales_and_its_share_of_the_best() -> None:
    score = _score((1, 0.1), (4, 0.3), (16, -3.0))
    assert score.share == pytest.approx(0.3)
    assert (score.factor, score.sure) == (4, True)
    # Worse than nothing counts as one and a half times as bad.
    assert score.total == pytest.approx(-np.mean(np.log([0.9, 0.7, 1.5])))


@pytest.mark.parametrize(("errors", "sure"), [(2.97, False), (3.03, True)])
def test_the_misfit_of_blocks_falls_by_three_errors(errors: float, sure: bool) -> None:
    fall = 1e-5 * (1.0 + math.sqrt(19.0) / errors * np.tile([1.0, -1.0], 10))
    assert attribution._steady(np.ones(20), 1.0 - fall) == sure


def test_one_steady_way_to_count_is_enough() -> None:
    """Blocks alike, though one holds most of the misfit; or by misfit, though quiet blocks get worse."""
    before = np.concatenate([[100.0], np.ones(19)])
    assert attribution._steady(before, 0.8 * before)
    before = np.concatenate([np.full(5, 1e-6), np.ones(15)])
    assert attribution._steady(before, np.concatenate([np.full(5, 1e-3), np.full(15, 0.9)]))


def _loud(count: int, *falls: float, last: float = 1.0) -> tuple[Any, Any]:
    """Blocks of which only some hold the misfit; the others get worse."""
    before = np.full(20, 1e-6)
    before[:count] = 1.0
    before[count - 1] = last
    after = 2.0 * before
    after[:count] = before[:count] * np.resize(falls, count)
    return before, after


@pytest.mark.parametrize(
    ("blocks", "sure"),
    [
        (_loud(5, 0.1), True),
        (_loud(4, 0.1), False),  # too few to be more than luck
        (_loud(5, 0.49), True),
        (_loud(5, 0.51), False),  # half of the misfit is left
        (_loud(5, 0.1, 0.1, 0.1, 0.1, 0.69), True),
        (_loud(5, 0.1, 0.1, 0.1, 0.1, 0.71), False),  # one of five does not fall
        (_loud(6, 0.1, 0.1, 0.1, 0.1, 0.1, 0.71), True),
        (_loud(5, 0.1, last=0.0404 * 1.02), True),  # a fifth of the mean is loud
        (_loud(5, 0.1, last=0.0404 * 0.98), False),
    ],
)
def test_a_cause_of_a_few_blocks_lets_the_loud_ones_fall_together(
    blocks: tuple[Any, Any], sure: bool
) -> None:
    assert attribution.steadiness(*blocks) < 3.0
    assert attribution._steady(*blocks) == sure


def _candidate(columns: int, name: str = "drift", family: str = "") -> Candidate:
    return Candidate(name=name, columns=np.ones((10, columns)), family=family)


@pytest.mark.parametrize(("ratio", "winner"), [(1.09, 1), (1.11, 0)])
def test_of_two_that_are_alike_the_plainer_wins(ratio: float, winner: int) -> None:
    tried = [_candidate(2), _candidate(1)]
    scores = {0: Score(1.0, 0.5, 1, True), 1: Score(1.0 - math.log(ratio), 0.5, 1, True)}
    assert attribution._parsimonious(scores, tried) == winner


@pytest.mark.parametrize(
    ("share", "sure", "family", "named"),
    [
        (0.905, True, "", True),
        (0.895, True, "", False),
        (0.905, False, "", False),
        (0.905, True, "one", False),  # recordings hardly separate causes of one family
    ],
)
def test_a_rival_that_explains_nearly_as_much_is_named(
    share: float, sure: bool, family: str, named: bool
) -> None:
    fit: Any = SimpleNamespace(
        jacobian=np.zeros((10, 1)), solve=lambda columns, _: np.arange(1.0, 1 + columns.shape[1])
    )
    tried = [_candidate(1, "gravity", "one"), _candidate(1, "drift", family)]
    scores = {0: Score(1.0, 0.5, 4, True), 1: Score(share, 0.4, 1, sure)}
    matrix = np.ones((10, 4))
    found = attribution._attributed(fit, matrix, [0, 1], tried, 0, scores, np.array([0.25]))
    assert found.alike == (("drift",) if named else ())
    assert (found.share, found.factor) == (0.5, 4)
    assert found.coefficients.tolist() == [-2.0]
    assert found.shifts.tolist() == [0.75]


def _fit(speed: Any, **given: Any) -> Any:
    """A fit of one parameter that the misfit does not move."""
    count = len(speed)
    usual = {
        "start": np.zeros(1),
        "solve": lambda *_: np.zeros(1),
        "duration": np.ones(count),
        "integral": lambda _: np.asarray(speed, dtype=float),
        "integral_of_each": lambda _: np.asarray(speed, dtype=float),
        "run": np.zeros(count, dtype=int),
        "neighbours": np.zeros(count, dtype=int),
        "spans": np.column_stack([np.arange(count), np.arange(count) + 1.0]),
        "runs": (SimpleNamespace(time=np.arange(count + 1.0)),),
    }
    return SimpleNamespace(**(usual | given))


@pytest.mark.parametrize(("left", "gone"), [(0.303, False), (0.297, True)])
def test_a_misfit_of_the_limit_is_gone_without_its_windows(left: float, gone: bool) -> None:
    kept = np.arange(100) >= 10
    residual = np.where(kept, math.sqrt(left / 90.0), math.sqrt((1.0 - left) / 10.0))
    fit = _fit(np.ones(100), trusted=kept)
    assert attribution._of_the_limit(fit, np.zeros((100, 1)), residual) == gone
    fit = _fit(np.ones(100), trusted=np.ones(100, dtype=bool))
    assert not attribution._of_the_limit(fit, np.zeros((100, 1)), residual)


@pytest.mark.parametrize(("left", "known"), [(0.198, False), (0.202, True)])
def test_a_value_that_only_slow_windows_show_does_not_move(left: float, known: bool) -> None:
    matrix = np.ones((1000, 2))
    kept = np.where(np.arange(1000)[:, None] < 1000 * left, matrix, 0.0)
    (step,) = attribution._without_slow(_fit(np.ones(1000)), kept, matrix)
    assert step == (pytest.approx(-1.0) if known else 0.0)


# --- Stretches of time, and slow motion ---


def _event(stretches: int, share: float) -> LocalEvent:
    rows = np.zeros(1, dtype=bool)
    return LocalEvent(rows=rows, share=share, torque=1.0, text="", stretches=stretches, slow=False)


@pytest.mark.parametrize(
    ("stretches", "share", "other", "stands_out"),
    [
        (1, 0.651, 0.5, True),  # 0.5 and three tenths of the rest
        (1, 0.649, 0.5, False),
        (2, 0.9, 0.299, True),
        (2, 0.9, 0.301, False),
    ],
)
def test_an_event_says_more_than_a_cause_at_all_times(
    stretches: int, share: float, other: float, stands_out: bool
) -> None:
    assert _event(stretches, share).stands_out(other) == stands_out


def _power(count: int, *held: float) -> Any:
    """Squares of a residual, of which single windows hold these shares and the others the rest, alike."""
    power = np.full(count, (1.0 - sum(held)) / (count - len(held)))
    for number, share in enumerate(held):
        power[5 + 20 * number] = share
    return power


@pytest.mark.parametrize(
    ("held", "stretches"),
    [
        ((0.597,), 1),  # with what its neighbours hold 0.605
        ((0.59,), 0),
        ((0.4, 0.405), 2),
        ((0.3, 0.25, 0.26), 3),
        ((0.3, 0.25, 0.2), 0),
        ((0.26, 0.25, 0.24, 0.24), 0),  # four are no event
    ],
)
def test_an_event_holds_most_of_the_misfit(held: tuple[float, ...], stretches: int) -> None:
    residual = np.sqrt(_power(100, *held))
    found = local_event(_fit(np.ones(100)), np.zeros((100, 1)), residual)
    assert (0 if found is None else found.stretches) == stretches


@pytest.mark.parametrize(("count", "found"), [(59, False), (60, True)])
def test_an_event_needs_a_time_around_it(count: int, found: bool) -> None:
    residual = np.sqrt(_power(count, 0.9))
    event = local_event(_fit(np.ones(count)), np.zeros((count, 1)), residual)
    assert (event is not None) == found


@pytest.mark.parametrize(("slow", "named"), [(0.51, True), (0.49, False)])
def test_an_event_is_slow_where_most_of_it_is(slow: float, named: bool) -> None:
    power = np.zeros(100)
    power[19], power[20] = slow, 1.0 - slow
    assert events._is_slow(_fit(np.arange(100)), power) == named


@pytest.mark.parametrize(
    ("passages", "named"),
    [
        ((0.43, 0.3, 0.121), True),
        ((0.43, 0.3, 0.119), False),  # of all the misfit 0.849
        ((0.599, 0.2, 0.1), True),
        ((0.601, 0.2, 0.1), False),  # one passage is an event
        ((0.5, 0.4, 0.0201), True),
        ((0.5, 0.4, 0.0199), False),  # two passages are too few
    ],
)
def test_slow_motion_is_amiss_in_several_passages(passages: tuple[float, ...], named: bool) -> None:
    speed, power = np.ones(100), np.full(100, (1.0 - sum(passages)) / 80.0)
    for number in range(4):
        slow = slice(25 * number, 25 * number + 5)
        speed[slow] = 0.1
        power[slow] = (*passages, 0.0)[number] / 5.0
    found = slow_rows(_fit(speed), np.zeros((100, 1)), np.sqrt(power))
    assert (found is not None) == named


# --- Whether there is anything to explain ---


@pytest.mark.parametrize(("rows", "enough"), [(19, False), (20, True)])
def test_folds_need_five_blocks_of_four_rows(rows: int, enough: bool) -> None:
    assert (Folds.of(np.ones((rows, 1)), np.ones(rows)) is not None) == enough


@pytest.mark.parametrize(
    ("count", "factor", "correlation", "alike"),
    [
        (10_000, 1, 0.099, False),
        (10_000, 1, 0.101, True),
        (400, 1, 0.199, False),  # four errors by chance
        (400, 1, 0.201, True),
        (1600, 4, 0.199, False),
        (1600, 4, 0.201, True),
    ],
)
def test_neighbours_that_are_alike_are_suspicious(
    count: int, factor: int, correlation: float, alike: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(residual_test, "correlations", lambda *_: {factor: correlation})
    assert residual_test.correlated(np.ones(count), np.zeros(count, dtype=np.int64)) == alike


@pytest.mark.parametrize(("count", "scales"), [(39, []), (40, [1]), (156, [1]), (157, [1, 4])])
def test_forty_sums_tell_noise_from_structure(count: int, scales: list[int]) -> None:
    run = np.zeros(count, dtype=np.int64)
    assert list(residual_test.correlations(np.ones(count), run)) == scales
    assert residual_test.testable(run) == bool(scales)


@pytest.mark.parametrize(
    ("count", "times", "said"), [(200, 2.99, False), (200, 3.01, True), (199, 9.0, False)]
)
def test_slow_motion_three_times_as_loud_is_suspicious(
    count: int, times: float, said: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(residual_test, "correlated", lambda *_: False)
    slow = np.arange(count) < 0.2 * count
    velocity, duration = np.where(slow, 0.1, -1.0), np.where(slow, 2.0, 1.0)
    residual = np.where(slow, math.sqrt(2.0 * times), 1.0)  # noise grows with the root of the time
    run = np.zeros(count, dtype=np.int64)
    assert residual_test.suspicious(residual, run, duration, velocity) == said


def test_the_end_of_a_recording_is_no_neighbour_of_the_next() -> None:
    residual = np.zeros(80)
    residual[39:41] = 1.0
    assert residual_test.correlations(residual, np.zeros(80, dtype=np.int64)) == {1: 0.5}
    assert residual_test.correlations(residual, np.arange(80) // 40) == {1: 0.0}


@pytest.mark.parametrize(("samples", "limit"), [(5, False), (6, True)])
@pytest.mark.parametrize("side", [1.0, -1.0])
def test_a_torque_rests_on_its_limit(samples: int, limit: bool, side: float) -> None:
    torque = np.linspace(-0.9, 0.9, 1000)
    torque[100 : 100 + samples] = side
    assert fitted._on_a_limit(torque).sum() == (samples if limit else 0)


@pytest.mark.parametrize(("resting", "kept"), [(49, 51), (50, 100)])
def test_windows_on_a_limit_are_left_out_unless_most_are(resting: int, kept: int) -> None:
    fit = _fit(np.arange(100) < resting)
    recording = SimpleNamespace(torque=np.zeros(101))
    fit.problem = SimpleNamespace(joint=None, recordings=(recording,))
    assert Fitted.trusted.func(fit).sum() == kept  # type: ignore[attr-defined]


# --- What is said of it ---


@pytest.mark.parametrize(
    ("early", "held"), [(0.301, True), (0.299, False), (0.699, True), (0.701, False)]
)
def test_a_torque_that_is_half_a_sample_early_is_held(early: float, held: bool) -> None:
    late: Any = SimpleNamespace(
        candidate=_candidate(1, "delay"), coefficients=np.array([-early * 1e-3])
    )
    late.candidate = SimpleNamespace(name="delay", detail="torque")
    fit: Any = SimpleNamespace(sample_period=1e-3, torque_held=False)
    assert ("torque_hold" in against_delay(fit, late)[0].arguments) == held


@pytest.mark.parametrize(
    ("share", "error", "bound", "said"),
    [
        (9.9, 0.5, None, False),
        (10.1, 0.5, None, True),
        (-10.1, 0.5, None, True),
        (0.1, 1.01, None, True),
        (0.1, 0.99, None, False),
        (0.1, 0.5, "min", True),
    ],
)
def test_a_change_of_a_value_near_zero_is_said_from_and_to(
    share: float, error: float, bound: str | None, said: bool
) -> None:
    p: Any = SimpleNamespace(shown_value=1.0, at_bound=bound, unit="N·m")
    words = changes.from_to({"a": p}, {"a": 0.5}, {"a": share}, {"a": error})
    assert words == ({"a": "from 1 to 1.5 N·m"} if said else {})
    after = changes.from_to({"a": p}, {"a": 0.5}, {"a": share}, {"a": error}, before=True)
    assert after == ({"a": "from 0.5 to 1 N·m"} if said else {})


@pytest.mark.parametrize(
    ("count", "most", "length"), [(200_000, 60_000, 1024), (1025, 1024, 1024), (300, 256, 256)]
)
def test_stretches_lie_evenly_over_the_whole_from_its_first_window_to_its_last(
    count: int, most: int, length: int
) -> None:
    chosen = fitted._stretches(count, most)
    stretches = chosen.reshape(-1, length)
    assert len(stretches) == most // length
    np.testing.assert_array_equal(np.diff(stretches, axis=1), 1)
    first = stretches[:, 0]
    assert first[0] == 0
    if len(stretches) > 1:
        assert chosen[-1] == count - 1
        between = np.diff(first)
        assert between.min() >= length  # no window twice
        assert between.max() - between.min() <= 1
