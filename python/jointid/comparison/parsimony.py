"""Which of the compared models wins: the one-standard-error rule, told in sentences."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from jointid.comparison.result import ComparedModel
from jointid.estimate.estimate import Estimate


def judge(rows: Sequence[ComparedModel]) -> tuple[tuple[ComparedModel, ...], int, str]:
    """Choose by the one-standard-error rule.

    Returns
    -------
    rows : tuple of ComparedModel
        Each with its reason.
    winner : int
        Its index.
    reason : str
    """
    entrants = [row for row in rows if row.eligible] or list(rows)
    best = min(entrants, key=lambda row: row.score)
    limit = best.score + best.stderr
    near = [row for row in entrants if row.score <= limit]
    winner = min(near, key=lambda row: (row.parameters, row.score))
    told = f"{100.0 * best.score:.3g} ± {100.0 * best.stderr:.2g} %"
    judged = []
    for row in rows:
        reason = row.reason
        if row is winner:
            reason = "; ".join(part for part in (reason, "winner") if part)
        elif row.eligible and row.score > limit:
            reason = f"misses by more than one standard error over the best, {told}"
        elif row.eligible:
            instead = f"{row.parameters} parameters instead of {winner.parameters}"
            if row.parameters == winner.parameters:
                instead = "as many parameters"
            reason = f"not clearly better than the winner, with {instead}"
        judged.append(replace(row, reason=reason))
    count = f"{winner.parameters} parameter{'s' * (winner.parameters != 1)}"
    if winner is best:
        sentence = f"{winner.model} ({count}) predicts held-out motion best, {told}"
        if any(row.parameters < winner.parameters for row in entrants):
            sentence += ", and no simpler model comes within one standard error"
    else:
        sentence = (
            f"{winner.model} ({count}) is the simplest model within one standard error of the best, "
            f"{best.model} with {told}: it has {100.0 * winner.score:.3g} %"
        )
    refused = [row.model for row in rows if not row.eligible]
    if len(refused) == len(rows):
        sentence += (
            "; but the data carry none of the models, so mind the warnings of the winner's estimate"
        )
    elif refused:
        sentence += f"; the data do not carry {', '.join(refused)}"
    return tuple(judged), list(rows).index(winner), sentence


def refusal(estimate: Estimate) -> str | None:
    """Why the data do not carry a model, or None when they do."""
    for warning in estimate.warnings:
        if warning.code == "model_too_rich":
            return f"not eligible: {warning.cause}"
    ended = [p for p in estimate.parameters.values() if p.at_bound is not None]
    if ended:
        told = ", ".join(
            f"{p.name} at its {'lower' if p.at_bound == 'min' else 'upper'} bound" for p in ended
        )
        return f"not eligible: {told}"
    return None
