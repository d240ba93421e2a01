"""How much of a joint's residual the other joints explain, out of sample, and by what."""

from __future__ import annotations

import itertools
from collections.abc import Collection, Mapping
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from jointid.base.values import dataclass
from jointid.estimate.estimate import Estimate
from jointid.identification.causes.attribution import Score, at_scales, score_of, steadiness
from jointid.identification.causes.fitted import Fitted
from jointid.identification.causes.folds import Folds
from jointid.identification.follow_up import EstimateSource
from jointid.identification.gain import penalty_as_fitted
from jointid.joints.signals import TORQUE, Group, other_groups, own_groups
from jointid.recording.recording import Recording

Array = NDArray[np.float64]

_MOST = 4  # groups of signals, one after the other
_LEAST, _LEAST_OF_ALL = 0.1, 0.05  # of what is left of the residual, and of all of it
# Of what is left, where the coupling is known from the other side: no block or shift has to agree, and of all of the
# residual it may be less.
_LEAST_EXPECTED = 0.05
_SURE = 2.0  # errors of the mean fall of the blocks' misfit
_SHIFTS = 24  # of the other joints' motion in time: by chance, one of 25 is the best
_ALIKE, _NEARLY = 0.9, 0.6  # of the best score: hardly worse, and not much
_WINDOWS = 20_000


@dataclass(frozen=True, slots=True, kw_only=True)
class Share:
    """Part of a joint's residual that another joint explains.

    Attributes
    ----------
    joint : str
        The other joint.
    by : str
        "speed" (its rate and direction: friction), "acceleration" (its momentum: inertia), "position"
        (gravity) or "torque".
    share : float
        Of the residual's sum of squares that neither the joint's own motion nor earlier shares explain, on held-out
        data.
    scale : float
        Length of the sums of windows with the largest share [s].
    alike : tuple of str
        Other joints that explain nearly as much, because they move alike.
    own_too : bool
        Whether the joint's own motion, beyond the model, explains much of it as well.
    certain : bool
        Whether it is significant alone. Otherwise it is reported only because the other joint's residual has a certain
        share of this joint: a coupling acts on both.
    """

    joint: str
    by: str
    share: float
    scale: float
    alike: tuple[str, ...] = ()
    own_too: bool = False
    certain: bool = True


def shares_of_others(
    estimate: Estimate,
    name: str,
    recordings: Mapping[str, Recording],
    expected: Collection[str] = (),
) -> tuple[Share, ...]:
    """Return what the other joints explain of an estimate's residual, the largest part first.

    The residual and the derivatives by the joint's own parameters are those of the estimate's windows. To them
    come functions of the joint's own motion, so that nothing that these explain is credited to another joint.
    Then the group of another joint's signals that takes most from the misfit is added, and the next, as long as
    held-out blocks of time say that it is no chance, and the same signals shifted in time explain less.

    A shift breaks the timing of joints that start and stop together, which makes it too easy to explain more: of 135
    simulated independent joints that move so, 10 were said to owe something to another one, 7 of them as certain.

    Parameters
    ----------
    estimate : Estimate
        Just identified, not read from a file.
    name : str
        The joint's.
    recordings : mapping of str to Recording
        Of all joints, on one clock.
    expected : collection of str
        Joints whose residuals owe something to this one.
    """
    fit = _fitted(estimate)
    if fit is None:
        return ()
    run, clock = fit.problem.recordings[0], recordings[name].time
    rows = np.clip(np.searchsorted(clock, run.time), 0, len(clock) - 1)
    groups = [
        group
        for other, recording in recordings.items()
        if other != name
        for group in other_groups(fit, recording, other, rows)
    ]
    if not groups:
        return ()
    owned = own_groups(fit)
    columns = [fit.jacobian, *owned, *(group.columns for group in groups)]
    matrix = np.column_stack([*columns, fit.residual])
    scaled = at_scales(fit, matrix)
    if not scaled:
        return ()
    edges = np.cumsum([0, *(each.shape[1] for each in columns)])
    places = [list(range(low, high)) for low, high in itertools.pairwise(edges.tolist())]
    search = _Search(
        fit=fit,
        matrix=matrix,
        scaled=scaled,
        base=places[0],
        own=places[1 : 1 + len(owned)],
        others=dict(zip(groups, places[1 + len(owned) :], strict=True)),
    )
    return search.shares(expected)


@dataclass(frozen=True, kw_only=True, eq=False)
class _Search:
    """Groups of columns, taken one after the other by what they take from the misfit of held-out blocks."""

    fit: Fitted
    matrix: Array
    scaled: list[tuple[int, Folds]]
    base: list[int]
    own: list[list[int]]
    others: dict[Group, list[int]]

    def shares(self, expected: Collection[str]) -> tuple[Share, ...]:
        """Take the best group of all, as long as one is better than none.

        A group of the own motion is preferred to another joint's that is hardly better.
        """
        base, own, others = self.base, list(self.own), dict(self.others)
        whole = _misfits(self.scaled, base)
        found: list[Share] = []
        while others and len(found) < _MOST:
            scores = self._scores(base, others)
            best = _best(scores)
            mine = [score_of(self.scaled, base, each, whole).total for each in own]
            if mine and max(mine) > max(0.0, _ALIKE * scores[best].total):
                base = [*base, *own.pop(int(np.argmax(mine)))]
                continue
            if not self._is_certain(base, others, best, scores[best]):
                break
            own_too = bool(mine) and max(mine) > _NEARLY * scores[best].total
            found.append(replace(self._share(base, whole, best, scores), own_too=own_too))
            if found[-1].share < _LEAST_OF_ALL:
                return tuple(found[:-1])
            base = [*base, *others.pop(best)]
        named = {share.joint for share in found}
        for joint in sorted(set(expected) - named):
            scores = self._scores(base, {g: at for g, at in others.items() if g.joint == joint})
            if scores and scores[_best(scores)].share > _LEAST_EXPECTED:
                share = self._share(base, whole, _best(scores), scores)
                found.append(replace(share, certain=False))
        return tuple(found)

    def _scores(self, base: list[int], others: Mapping[Group, list[int]]) -> dict[Group, Score]:
        whole = _misfits(self.scaled, base)
        return {group: score_of(self.scaled, base, at, whole) for group, at in others.items()}

    def _share(
        self, base: list[int], whole: dict[int, float], best: Group, scores: dict[Group, Score]
    ) -> Share:
        score = scores[best]
        left = _misfits(self.scaled, base)[score.factor]
        alike = {
            group.joint
            for group, other in scores.items()
            if group.joint != best.joint and other.total > _ALIKE * score.total
        }
        return Share(
            joint=best.joint,
            by=best.by,
            share=min(1.0, left / max(whole[score.factor], 1e-300)) * score.share,
            scale=score.factor * self.fit.group * float(self.fit.penalty.window_duration),
            alike=tuple(sorted(alike)),
        )

    def _is_certain(
        self, base: list[int], others: Mapping[Group, list[int]], best: Group, score: Score
    ) -> bool:
        """Whether the misfit falls by enough, in most blocks, and more than it does by chance.

        What happens by chance is seen when the other joints' signals are shifted in time: the group then has to
        explain less at every shift, and the best of all groups at all shifts but one.
        """
        if score.share < _LEAST:
            return False
        folds = dict(self.scaled)[score.factor]
        before, after = folds.misfit(base), folds.misfit([*base, *others[best]])
        if steadiness(before, after) < _SURE:
            return False
        columns = sorted(column for place in others.values() for column in place)
        known, rows = list(range(len(base))), len(self.matrix)
        at = {column: len(base) + k for k, column in enumerate(columns)}
        places = {group: [at[column] for column in place] for group, place in others.items()}
        worse = 0
        for offset in (np.linspace(0.06, 0.94, _SHIFTS) * rows).astype(int):
            moved = np.roll(self.matrix[:, columns], offset, axis=0)
            shifted = np.column_stack([self.matrix[:, base], moved, self.matrix[:, -1]])
            scaled = at_scales(self.fit, shifted)
            whole = _misfits(scaled, known)
            if score_of(scaled, known, places[best], whole).total >= score.total:
                return False
            worse += any(
                score_of(scaled, known, place, whole).total >= score.total
                for place in places.values()
            )
            if worse > 1:
                return False
        return True


def _best(scores: Mapping[Group, Score]) -> Group:
    """The group with the highest score; a torque only if nothing else of its joint says nearly as much."""
    best = max(scores, key=lambda group: scores[group].total)
    if best.by != TORQUE:
        return best
    same = [group for group in scores if group.joint == best.joint and group.by != TORQUE]
    other = max(same, key=lambda group: scores[group].total, default=best)
    return other if scores[other].total > _ALIKE * scores[best].total else best


def _misfits(scaled: list[tuple[int, Folds]], base: list[int]) -> dict[int, float]:
    return {factor: float(folds.misfit(base).sum()) for factor, folds in scaled}


def _fitted(estimate: Estimate) -> Fitted | None:
    source = estimate.follow_up
    if not isinstance(source, EstimateSource):
        return None
    problem = source.problem
    penalty = penalty_as_fitted(problem, source.windows, source.domain)
    values = estimate.parameters
    names = list(penalty.names)
    free = tuple(
        k for k, each in enumerate(names) if values[each].vary and values[each].at_bound is None
    )
    best = np.array([values[each].value for each in names])
    return Fitted.of(problem, penalty, best, free, most=_WINDOWS)
