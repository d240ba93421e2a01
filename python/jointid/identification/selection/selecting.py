"""`select_model`: choose the simplest usual model that predicts the held-out torque."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from jointid.balance.held_out import in_errors, preferred
from jointid.base.errors import InputError
from jointid.estimate import selection as values
from jointid.estimate.selection import Selection
from jointid.identification.search.stated_bounds import known_parameters
from jointid.identification.selection.candidate_models import Candidate, candidates
from jointid.identification.selection.columns import ShapedColumns
from jointid.identification.selection.held_out_scores import Entry, entry_of, held_out
from jointid.problem.block_sums import BlockSums
from jointid.problem.problem import Problem
from jointid.problem.terms import Request
from jointid.problem.windows import Windows

Array = NDArray[np.float64]

# A simpler model is chosen unless its held-out errors exceed those of the best model by more than this number of
# standard errors of the difference. This error is much smaller than that of a score, because both models predict the
# same blocks. With 1, 9 of 40 simulated joints without gravity get gravity; with 2, none does.
_MARGIN = 2.0


def select_model(
    problem: Problem,
    request: Request,
    parameters: Mapping[str, Any] | None,
    windows: Windows,
    unfit: Mapping[str, str] | None = None,
) -> tuple[Problem, Selection]:
    """Choose the model of a problem when the caller names none.

    Parameters
    ----------
    problem : Problem
        Problem with any choice of terms.
    request : Request
        Request of the call.
    parameters, windows
        Arguments of the call, as in `identify`.
    unfit : mapping of str to str, optional
        Models that must not be chosen, by text, with the reason. Default: none.

    Returns
    -------
    problem : Problem
        Problem with the terms of the chosen model.
    selection : Selection

    Raises
    ------
    InputError
        Invalid input.
    """
    rivals = candidates(problem.recordings, problem.joint, request, parameters)
    entries: list[Entry] = []
    energy = 0.0
    if len(rivals) > 1:
        # All candidates predict the torque, for any choice of residual.
        widest = replace(problem, choice=replace(rivals[-1].choice, residual="torque"))
        try:
            penalty = widest.penalty(None if windows == "cumulative" else windows)
        except InputError:
            # Fewer windows than parameters; or the simplest model has the same fault and raises it later.
            pass
        else:
            blocks = held_out(penalty.window_count)
            if len(blocks) > 1:
                names = tuple(penalty.names)
                known = known_parameters(names, problem.joint, parameters)
                columns = ShapedColumns.of(penalty, known, problem.peak_speed, problem.threads)
                sums = BlockSums.of(columns.matrix, blocks, problem.threads)
                for rival in rivals:
                    own = columns
                    if _weighs(rival) and problem.joint is not None:
                        joint = problem.joint.replace(model=rival.model)
                        own = columns.stated(known_parameters(names, joint, parameters))
                    entries.append(_unless(unfit or {}, entry_of(rival, own, sums)))
                energy = float(sums.products[:, -1, -1].sum())
    winner, selection = _judged(entries, energy) if entries else _alone(rivals[0])
    return _with(problem, winner), selection


def simplest_model(
    problem: Problem, request: Request, parameters: Mapping[str, Any] | None
) -> Problem:
    """Return the problem with the simplest candidate model; arguments as in `select_model`."""
    return _with(problem, candidates(problem.recordings, problem.joint, request, parameters)[0])


def _with(problem: Problem, candidate: Candidate) -> Problem:
    joint = problem.joint
    if joint is not None:
        model = candidate.model.replace(per_recording=joint.model.per_recording)
        joint = joint.replace(model=model)
    return replace(problem, joint=joint, choice=candidate.choice)


def _unless(unfit: Mapping[str, str], entry: Entry) -> Entry:
    reason = unfit.get(str(entry.candidate.choice.model.resolved))
    return replace(entry, refused=reason) if reason else entry


def _weighs(candidate: Candidate) -> bool:
    """Return whether a candidate uses the described weight of the joint's link."""
    return candidate.model.gravity == "known"


def _alone(candidate: Candidate) -> tuple[Candidate, Selection]:
    text = str(candidate.choice.model.resolved)
    alone = values.Candidate(model=text, parameters=0, score=0.0, excess=0.0)
    return candidate, Selection(model=text, runner_up=None, candidates=(alone,), blocks=0)


def _judged(entries: Sequence[Entry], energy: float) -> tuple[Candidate, Selection]:
    """Return the candidate with the fewest parameters that is not significantly worse than the best."""
    able = [each for each in entries if not each.refused] or list(entries[:1])
    first, chosen = preferred(
        [float(each.missed.sum()) for each in able],
        [each.parameters for each in able],
        lambda each, best: excess(able[each].missed, able[best].missed) > _MARGIN,
    )
    best, winner = able[first], able[chosen]
    others = [each for each in entries if each is not winner]
    second = min(others, key=lambda each: (bool(each.refused), float(each.missed.sum())))
    made = {
        id(each): values.Candidate(
            model=str(each.candidate.choice.model.resolved),
            parameters=each.parameters,
            score=float(np.sqrt(each.missed.sum() / energy)) if energy > 0.0 else 0.0,
            excess=excess(each.missed, best.missed),
            refused=each.refused,
        )
        for each in entries
    }
    selection = Selection(
        model=made[id(winner)].model,
        runner_up=made[id(second)].model,
        candidates=tuple(made[id(each)] for each in entries),
        blocks=len(best.missed),
    )
    return winner.candidate, selection


def excess(missed: Array, best: Array) -> float:
    """Return the difference between the held-out errors of a model and of the best model, in standard errors.

    This is the larger of two results over the blocks. The difference of logarithms counts because a few slow blocks may
    contain nearly all squares of a wrong model. The difference of squares counts because a residual that both
    models share makes the ratios of quiet blocks arbitrary.
    """
    floor = 1e-30 * float(best.sum() + missed.sum()) + 1e-300
    ratio = np.log((missed + floor) / (best + floor))
    return max(in_errors(ratio), in_errors(missed - best))
