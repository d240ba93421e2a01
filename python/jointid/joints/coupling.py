"""Share of a joint's residual that the other joints explain, on held-out data, with the signal that explains it."""

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

_MOST = 4  # largest number of groups of signals, one after the other
_LEAST, _LEAST_OF_ALL = 0.1, 0.05  # of the residual that is left, and of the whole residual
# Of the residual that is left, if the coupling is known from the other joint. Then no block or shift has to agree,
# and the share of the whole residual may be smaller.
_LEAST_EXPECTED = 0.05
_SURE = 2.0  # standard errors of the mean fall of the blocks' squared residuals
_SHIFTS = 24  # number of time shifts of the other joints' motion: one of 25 is the best by chance
_ALIKE, _NEARLY = 0.9, 0.6  # of the best score: nearly as good, and not much worse
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
        Explained share of the sum of squares that neither the joint's own motion nor earlier shares explain, on
        held-out data.
    scale : float
        Duration of the window sums with the largest share [s].
    alike : tuple of str
        Other joints that explain nearly as much, because they move alike.
    own_too : bool
        Whether the joint's own motion, beyond the model, explains much of it as well.
    certain : bool
        Whether it is significant alone. Otherwise it is reported only because this joint explains a certain share of
        the other joint's residual: a coupling acts on both.
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
    """Return the shares of an estimate's residual that the other joints explain, the largest first.

    The residual and its derivatives by the joint's own parameters are those of the estimate's windows. Functions of the
    joint's own motion are added, so that their effect is not attributed to another joint. Then the group of another
    joint's signals is added that reduces the squared residual most. This is repeated while two conditions hold:
    held-out blocks of time show that the reduction is not chance, and the same signals shifted in time explain less.

    The limit of this test: a shift breaks the timing of joints that start and stop together, and this favors the
    unshifted signals. For 135 simulated independent joints with such motion, 10 couplings were reported, 7 of them as
    certain.

    Parameters
    ----------
    estimate : Estimate
        An estimate from `identify`, not one that was read from a file.
    name : str
        Name of the joint.
    recordings : mapping of str to Recording
        Recordings of all joints, on one clock.
    expected : collection of str
        Joints with a residual that this joint explains in part.
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
    """Groups of columns, chosen one after the other by their reduction of the held-out blocks' squared residuals."""

    fit: Fitted
    matrix: Array
    scaled: list[tuple[int, Folds]]
    base: list[int]
    own: list[list[int]]
    others: dict[Group, list[int]]

    def shares(self, expected: Collection[str]) -> tuple[Share, ...]:
        """Return the shares of the best groups, one after the other, while a group is better than none.

        A group of the joint's own motion is preferred if another joint's group is hardly better.
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
        """Return whether the residual falls by enough, in most blocks, and by more than chance allows.

        Shifts of the other joints' signals in time show the effect of chance. The group must be better than itself at
        every shift, and better than the best of all groups at all shifts except one.
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
    """Return the group with the highest score; a torque only if no other group of its joint scores nearly as much."""
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
