"""Choice of a model when the caller names none, with delays removed."""

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

# A richer model partly fits the residual of a delay. The choice is close if a simpler model has an error below this
# multiple of the chosen model's error.
_CLOSE = 2.0


def chosen_without_delays(
    problem: Problem,
    request: Request,
    settings: Settings,
    unfit: Mapping[str, str],
) -> tuple[Problem, dict[str, Delay], Selection]:
    """Choose a model and remove the delays of its signals.

    If the choice is close, it is repeated without the delays. The second choice counts.

    Parameters
    ----------
    problem : Problem
        Problem with the unchanged recordings and any choice of terms.
    request : Request
        Request of the call, as in `select_model`.
    settings : Settings
    unfit : mapping of str to str
        Models that must not be chosen, with the reason.

    Returns
    -------
    problem : Problem
        Problem with the terms of the chosen model, without delays.
    delays : dict of str to Delay
    selection : Selection

    Raises
    ------
    InputError
        Invalid input.
    """
    parameters, windows, shift = settings.parameters, settings.windows, settings.shift
    # The model comes first: the residual of a wrong model hides delays of a fraction of a sample.
    chosen, selection = select_model(problem, request, parameters, windows, unfit)
    moved, delays = without_delays(chosen, shift)
    if not _close(selection):
        return moved, delays, selection
    aligned = moved
    if not moved.shift:
        # The richer model may have fitted the delay.
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
    """Return whether a simpler model predicts almost as well as the chosen one."""
    winner = selection[selection.model]
    return any(
        each.parameters < winner.parameters and each.score < _CLOSE * winner.score
        for each in selection.candidates
    )


def unfit_in(estimate: Estimate) -> str:
    """Return why the fit rules out the chosen model; empty if it does not."""
    selection = estimate.selection
    if selection is None or estimate.status != "converged":
        return ""
    for finding in estimate.findings:
        simpler = any(action.kind == "call" for action in finding.advice)
        if finding.code == MODEL_TOO_RICH.code and simpler:
            return finding.cause.partition(": ")[2]
    return ""
