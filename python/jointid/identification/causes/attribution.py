"""Attribution: find the candidates that explain the held-out residual of a fit, and their effect on the values."""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from jointid.base.values import dataclass
from jointid.identification.causes.attributed import Attributed
from jointid.identification.causes.candidates import Candidate
from jointid.identification.causes.events import LocalEvent, local_event
from jointid.identification.causes.fitted_balance import FittedBalance
from jointid.identification.causes.folds import Folds, summed
from jointid.identification.causes.slow_passages import SlowRows, slow_rows
from jointid.identification.causes.whole_recording import WholeRecording
from jointid.problem.inner_products import inner

Array = NDArray[np.float64]

SCALES = (1, 4, 16, 64)
_MOST = 3  # largest number of causes
_SHARE = 0.12  # smallest explained share of the residual at one scale
_SHARE_OF_ALL = 0.05  # smallest explained share of the residual before any cause was found
_SURE = 3.0  # mean improvement of a block over its error
_FEWEST = 5  # smallest number of blocks with most of the residual
_LEFT = 0.2  # smallest share of a column's squares in the fast windows that determines its value
_GONE = 0.3  # largest remaining share of the residual without the windows at the torque limit
_ALIKE = 1.1  # ratio of residuals that blocks cannot distinguish
_HARDLY = 0.9  # share of the best candidate's log improvement, from which another one is similar


@dataclass(frozen=True, slots=True, eq=False)
class Score:
    """Reduction of the held-out residual by some columns."""

    total: float  # mean logarithm of the residual's reduction over the scales
    share: float
    factor: int
    sure: bool


def attribute(
    fit: FittedBalance, tried: list[Candidate], whole: FittedBalance | None = None
) -> tuple[Attributed, ...] | None:
    """Return the candidates that explain the residual, one after the other.

    Parameters
    ----------
    whole : FittedBalance, optional
        Fit of the whole recording if `fit` has only stretches of it. The stretches decide which candidates explain the
        residual. Events, sizes and shifts come from the whole recording. Default: `fit` is complete.

    Returns
    -------
    tuple of Attributed or None
        None if an event or slow motion stands out in the whole recording, which the stretches may not show.
    """
    count = fit.jacobian.shape[1]
    places, at = [], count
    for each in tried:
        places.append(list(range(at, at + each.columns.shape[1])))
        at += each.columns.shape[1]
    matrix = np.column_stack([fit.jacobian, *(each.columns for each in tried), fit.residual])
    base, reached = list(range(count)), np.zeros(count)
    everywhere = None if whole is None else WholeRecording(whole, fit)
    if _of_the_limit(fit, matrix[:, base], matrix[:, -1]):
        return ()
    scaled = at_scales(fit, matrix)
    before = {factor: folds.total(base) for factor, folds in scaled}
    found: list[Attributed] = []
    taken: set[str] = set()
    slow_event = False
    while len(found) < _MOST:
        scores = {
            index: score_of(scaled[:1] if each.finest else scaled, base, places[index], before)
            for index, each in enumerate(tried)
            if _family(each) not in taken
        }
        sure = {index: score for index, score in scores.items() if score.sure}
        best = max((score.share for score in sure.values()), default=0.0)
        event = None
        if everywhere is not None:
            event = everywhere.event()
        elif "disturbance" not in taken:
            event = local_event(fit, matrix[:, base], matrix[:, -1])
        if event is not None and event.stands_out(best):
            if everywhere is not None:
                return None
            taken.add("disturbance")
            slow_event = event.slow
            matrix = np.where(event.rows[:, None], 0.0, matrix)
            scaled = at_scales(fit, matrix)
            found.append(_of_event(fit, matrix, base, event, reached))
            reached = reached + found[-1].shifts
            continue
        if not sure:
            slow = None if found else slow_rows(fit, matrix[:, base], matrix[:, -1])
            if slow is not None and everywhere is not None:
                return None
            if slow is not None:
                found.append(_of_slow_rows(fit, matrix, slow))
            break
        winner = _parsimonious(sure, tried)
        base = base + places[winner]
        taken.add(_family(tried[winner]))
        found.append(_attributed(fit, matrix, base, tried, winner, scores, reached))
        reached = reached + found[-1].shifts
        if everywhere is not None:
            found[-1] = everywhere.attributed(found[-1])
    # If low-speed friction is wrong, an event during slow motion is probably part of it.
    if slow_event and any(_family(each.candidate) == "slow_motion" for each in found):
        found.sort(key=lambda each: each.candidate.name == "disturbance")
    return tuple(found)


def shares(fit: FittedBalance, tried: list[Candidate]) -> list[float]:
    """Return the share of the residual that each candidate explains alone; only significant candidates count."""
    base = list(range(fit.jacobian.shape[1]))
    found = []
    for each in tried:
        scaled = at_scales(fit, np.column_stack([fit.jacobian, each.columns, fit.residual]))
        before = {factor: folds.total(base) for factor, folds in scaled}
        own = list(range(len(base), len(base) + each.columns.shape[1]))
        score = score_of(scaled, base, own, before)
        found += [score.share] if score.sure else []
    return found


def _of_the_limit(fit: FittedBalance, base: Array, residual: Array) -> bool:
    """Return whether leaving out the windows at the torque limit removes most of the residual."""
    kept = fit.trusted
    if kept.all():
        return False
    steps = fit.solve(base[kept], residual[kept]) - fit.start
    all_rows = fit.solve(base, residual) - fit.start
    before = residual + base @ all_rows
    after = residual[kept] + base[kept] @ steps
    return float(np.sum(after**2)) < _GONE * float(np.sum(before**2))


def _of_event(
    fit: FittedBalance, matrix: Array, base: list[int], event: LocalEvent, reached: Array
) -> Attributed:
    """Return the event as a cause, with the shifts when it is left out."""
    steps = fit.solve(matrix[:, base], matrix[:, -1])
    return Attributed(
        candidate=Candidate(name="disturbance", columns=np.zeros((0, 1)), detail=event.text),
        share=event.share,
        factor=1,
        coefficients=np.array([event.torque]),
        shifts=steps[: len(reached)] - reached,
    )


def _of_slow_rows(fit: FittedBalance, matrix: Array, slow: SlowRows) -> Attributed:
    """Return slow motion as a cause, with the shifts of the parameters that are known without it."""
    kept = np.where(slow.rows[:, None], 0.0, matrix)
    number = ("speed", slow.speed, "/s")
    return Attributed(
        candidate=Candidate(
            name="slow_motion",
            columns=np.zeros((0, 1)),
            detail=f"below {slow.speed:.2g} @/s",
            numbers=(number,),
        ),
        share=slow.share,
        factor=1,
        coefficients=np.zeros(0),
        shifts=_without_slow(fit, kept, matrix),
    )


def _without_slow(fit: FittedBalance, kept: Array, matrix: Array) -> Array:
    """Return the steps without the slow windows; 0 for parameters that only these windows determine."""
    count = len(fit.start)
    left = np.einsum("ni,ni->i", kept[:, :count], kept[:, :count])
    whole = np.einsum("ni,ni->i", matrix[:, :count], matrix[:, :count])
    known = np.flatnonzero(left > _LEFT * whole)
    steps = np.zeros(count)
    # `solve` cannot be used, because it adds the start values to the first columns.
    size = np.sqrt(left[known])
    scaled = kept[:, known] / size
    square = np.einsum("ni,nj->ij", scaled, scaled) + 1e-12 * np.eye(len(known))
    steps[known] = np.linalg.solve(square, -np.einsum("ni,n->i", scaled, kept[:, -1])) / size
    return steps


def _family(candidate: Candidate) -> str:
    return candidate.family or candidate.name


def at_scales(fit: FittedBalance, matrix: Array) -> list[tuple[int, Folds]]:
    """Return the folds of a matrix for sums of 1, 4, 16 and 64 windows; its last column is the residual."""
    scaled = []
    for factor in SCALES:
        rows, _ = summed(matrix, fit.neighbours, factor)
        folds = Folds.of_rows(rows)
        if folds is not None and len(rows) > 3 * fit.jacobian.shape[1] + 20:
            scaled.append((factor, folds))
    return scaled


def score_of(
    scaled: list[tuple[int, Folds]], base: list[int], columns: list[int], whole: dict[int, float]
) -> Score:
    """Return how much `columns` explain in addition to `base`, with the share at the best scale.

    Parameters
    ----------
    scaled : list
        Folds from `at_scales`.
    base, columns : list of int
        Columns that are always fitted, and columns to score.
    whole : dict
        Squared residual before any cause was found, by scale.
    """
    total, best, at, sure = 0.0, 0.0, 1, False
    for factor, folds in scaled:
        more = [*base, *columns]
        before, after = folds.total(base), folds.total(more)
        ratio = after / max(before, 1e-300)
        total -= math.log(min(max(ratio, 1e-6), 1.5))
        if 1.0 - ratio > best:
            best, at = 1.0 - ratio, factor
        enough = before - after > _SHARE_OF_ALL * whole.get(factor, math.inf)
        sure = sure or (
            enough and 1.0 - ratio > _SHARE and _steady(folds.misfit(base), folds.misfit(more))
        )
    return Score(total / max(1, len(scaled)), best, at, sure)


def _steady(before: Array, after: Array) -> bool:
    """Return whether the residual decreases in most blocks, not by chance in one.

    The logarithms of the ratios count all blocks equally. The differences count blocks by their residual. A cause at
    reversals has no effect in blocks without a reversal. The blocks with a large residual must then all decrease.
    """
    if any(errors > _SURE for errors in _each_steadiness(before, after)):
        return True
    loud = before > 0.2 * before.mean()
    half = after.sum() < 0.5 * before.sum()
    return bool(half and loud.sum() >= _FEWEST and np.mean(after[loud] < 0.7 * before[loud]) > 0.8)


def steadiness(before: Array, after: Array) -> float:
    """Return the mean decrease of the blocks' residual over its standard error; the larger of two measures."""
    return max(_each_steadiness(before, after))


def _each_steadiness(before: Array, after: Array) -> Iterator[float]:
    """Yield both measures one after the other, because the first usually decides."""
    floor = 1e-12 * before.sum()
    yield _errors_from_none(np.log((before + floor) / (after + floor)))
    yield _errors_from_none(before - after)


def _errors_from_none(values: Array) -> float:
    count = len(values)
    mean = float(values.sum()) / count
    beside = values - mean
    error = math.sqrt(inner(beside, beside) / (count - 1) / count)
    return mean / max(error, 1e-300)


def _parsimonious(scores: dict[int, Score], tried: list[Candidate]) -> int:
    """Return the candidate with the fewest columns among those nearly as good as the best."""
    top = max(score.total for score in scores.values())
    near = [index for index, score in scores.items() if score.total > top - np.log(_ALIKE)]
    return min(near, key=lambda index: (tried[index].columns.shape[1], -scores[index].total))


def _attributed(
    fit: FittedBalance,
    matrix: Array,
    base: list[int],
    tried: list[Candidate],
    winner: int,
    scores: dict[int, Score],
    reached: Array,
) -> Attributed:
    """Return the chosen candidate with its coefficients, and the shifts with all causes so far in the model."""
    count, own = fit.jacobian.shape[1], tried[winner].columns.shape[1]
    solution = fit.solve(matrix[:, base], matrix[:, -1])
    score = scores[winner]
    alike: dict[str, float] = {}
    for index, other in scores.items():
        family = _family(tried[index])
        if family != _family(tried[winner]) and other.sure and other.total > _HARDLY * score.total:
            alike[family] = max(alike.get(family, 0.0), other.total)
    return Attributed(
        candidate=tried[winner],
        share=score.share,
        factor=score.factor,
        coefficients=-solution[-own:],
        shifts=solution[:count] - reached,
        alike=tuple(sorted(alike, key=lambda name: -alike[name]))[:2],
    )
