"""Choice of the winning model by the one-standard-error rule, with the reason for each model."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from jointid.comparison.load_evidence import load_refusal
from jointid.comparison.result import ComparedModel
from jointid.estimate.estimate import Estimate
from jointid.estimate.student import quantile
from jointid.estimate.wording import percent_with_error
from jointid.problem.constant_torque import undivided

_ONE_ERROR = 0.841345  # probability below one standard error of a normal distribution


def judge(rows: Sequence[ComparedModel]) -> tuple[tuple[ComparedModel, ...], int, str]:
    """Choose a model by the one-standard-error rule.

    Returns
    -------
    rows : tuple of ComparedModel
        Each with its reason.
    winner : int
        Its index.
    reason : str
        Why it won, in a sentence.
    """
    entrants = [row for row in rows if row.eligible] or list(rows)
    best = min(entrants, key=lambda row: row.score)
    # Few folds know their own standard error badly: Student's t has the same probability with a larger number.
    limit = best.score + best.stderr * quantile(_ONE_ERROR, max(1, len(best.fold_scores) - 1))
    near = [row for row in entrants if row.score <= limit]
    winner = min(near, key=lambda row: (row.parameters, row.score))
    best_score = percent_with_error(best.score, best.stderr)
    judged = []
    for row in rows:
        reason = row.reason
        if row is winner:
            reason = "; ".join(part for part in (reason, "winner") if part)
        elif row.eligible and row.score > limit:
            reason = "worse than the best by more than one standard error"
        elif row.eligible:
            more = row.parameters - winner.parameters
            count = f"{more} more parameter{'s' * (more != 1)}" if more else "as many parameters"
            reason = f"not significantly better, with {count}"
        judged.append(replace(row, reason=reason))
    count = f"{winner.parameters} parameter{'s' * (winner.parameters != 1)}"
    if winner is best:
        sentence = f"{winner.model} ({count}) predicts held-out motion best, {best_score}"
        if any(row.parameters < winner.parameters for row in entrants):
            sentence += ", and no simpler model is within one standard error of it"
    else:
        sentence = (
            f"{winner.model} ({count}) is the simplest model within one standard error of the best, "
            f"{best.model} with {best_score}; its residual is {100.0 * winner.score:.3g} %"
        )
    refused = [row.model for row in rows if not row.eligible]
    if len(refused) == len(rows):
        sentence += (
            "; but the data support none of the models: see the warnings of the winner's estimate"
        )
    elif refused:
        sentence += f"; the data do not support {', '.join(refused)}"
    return tuple(judged), list(rows).index(winner), sentence


def counted(estimate: Estimate) -> int:
    """Return the number of parameters that the data determine; an offset that nothing divides is none."""
    free = [parameter.name for parameter in estimate.parameters.values() if parameter.vary]
    return len(free) - len(undivided(free))


def refusal(estimate: Estimate) -> str | None:
    """Return why the data do not support a model, or None if they do."""
    for warning in estimate.warnings:
        if warning.code in ("model_too_rich", "load_scale"):
            return f"not eligible: {warning.cause}"
    ended = [p for p in estimate.parameters.values() if p.at_bound is not None]
    if ended:
        bounds = ", ".join(
            f"{p.name} at its {'lower' if p.at_bound == 'min' else 'upper'} bound" for p in ended
        )
        return f"not eligible: {bounds}"
    reason = load_refusal(estimate)
    return None if reason is None else f"not eligible: {reason}"
