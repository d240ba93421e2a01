"""The model that nobody named, chosen where delays are taken away; and the rule that its fit obeys."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

from jointid.estimate.delays import Delay
from jointid.estimate.estimate import Estimate
from jointid.estimate.selection import Selection
from jointid.identification.refinements.refinements import without_delays
from jointid.identification.selection.selecting import select_model, simplest_model
from jointid.identification.warnings.model_too_rich import MODEL_TOO_RICH
from jointid.problem.problem import Problem
from jointid.problem.settings import Settings
from jointid.problem.terms import Request

# A delay leaves a misfit that a richer model fits in part; a model whose rival misses so much more has no need of that.
_CLOSE = 2.0


def chosen_without_delays(
    problem: Problem,
    request: Request,
    settings: Settings,
    unfit: Mapping[str, str],
) -> tuple[Problem, dict[str, Delay], Selection]:
    """Choose a model, and take the delays of its signals away.

    Where the race is close it is run again without the delays, and the second winner counts.

    Parameters
    ----------
    problem : Problem
        Problem of the unchanged recordings, with any choice of terms.
    request : Request
        As in `select_model`.
    settings : Settings
    unfit : mapping of str to str
        Models that cannot win, and why.

    Returns
    -------
    problem : Problem
        With the terms of the chosen model, without delays.
    delays : dict of str to Delay
    selection : Selection

    Raises
    ------
    InputError
        Input that cannot be used.
    """
    parameters, windows, shift = settings.parameters, settings.windows, settings.shift
    # First: with the wrong model, delays of a fraction of a sample are lost in its misfit.
    chosen, selection = select_model(problem, request, parameters, windows, unfit)
    moved, delays = without_delays(chosen, shift)
    if not _close(selection):
        return moved, delays, selection
    aligned = moved
    if not moved.shift:
        # A richer model may have fitted the delay itself.
        simple = simplest_model(problem, request, parameters)
        aligned, _ = without_delays(simple, shift)
        if not aligned.shift:
            return moved, delays, selection
    other, again = select_model(aligned, request, parameters, windows, unfit)
    if again.model == selection.model:
        return moved, delays, again if aligned is moved else selection
    moved, delays = without_delays(replace(problem, joint=other.joint, choice=other.choice), shift)
    return moved, delays, again


def _close(selection: Selection) -> bool:
    """Whether a simpler model than the winner misses hardly more."""
    winner = selection[selection.model]
    return any(
        each.parameters < winner.parameters and each.score < _CLOSE * winner.score
        for each in selection.candidates
    )


def unfit_in(estimate: Estimate) -> str:
    """Return why the model that was chosen cannot win after all, as its fit shows; empty if it can."""
    selection = estimate.selection
    if selection is None or estimate.status != "converged":
        return ""
    for finding in estimate.findings:
        simpler = any(action.kind == "call" for action in finding.advice)
        if finding.code == MODEL_TOO_RICH.code and simpler:
            return finding.cause.partition(": ")[2]
    return ""
