"""Choice among compared models, and the reason for each of them."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from jointid.balance.held_out import in_errors, one_error, preferred
from jointid.base.values import dataclass
from jointid.estimate.wording import percent_with_error


@dataclass(frozen=True, slots=True, kw_only=True)
class Entrant:
    """A candidate with its scores, the relative residuals of the held-out parts."""

    name: str
    parameters: int
    score: float
    stderr: float
    parts: tuple[float, ...]
    eligible: bool = True


@dataclass(frozen=True, slots=True, kw_only=True)
class Judgement:
    """The chosen candidate, the reason for each candidate, and the reason of the choice, in a sentence."""

    winner: int
    reasons: tuple[str, ...]
    sentence: str


def judged(entrants: Sequence[Entrant], paired: bool = False) -> Judgement:
    """Choose by the one-standard-error rule: the fewest parameters among those not clearly worse than the best.

    With `paired`, the error is that of the difference from the best, part by part. Otherwise it is that of the best
    score.
    """
    able = [place for place, each in enumerate(entrants) if each.eligible]
    able = able or list(range(len(entrants)))

    def worse(each: int, best: int) -> bool:
        one, other = entrants[each], entrants[best]
        limit = one_error(len(other.parts))
        if paired:
            return in_errors(np.array(one.parts) - np.array(other.parts)) > limit
        return one.score > other.score + other.stderr * limit

    first, chosen = preferred(
        [entrants[each].score for each in able],
        [entrants[each].parameters for each in able],
        lambda each, best: worse(able[each], able[best]),
    )
    best, winner = able[first], able[chosen]
    reasons = []
    for place, each in enumerate(entrants):
        more = each.parameters - entrants[winner].parameters
        if place == winner:
            reason = "chosen"
        elif not each.eligible:
            reason = ""
        elif place != best and worse(place, best):
            reason = "worse than the best model by more than one standard error"
        else:
            count = (
                f"{more} more parameter{'s' * (more != 1)}"
                if more
                else "the same number of parameters"
            )
            reason = f"not significantly better than the chosen model, with {count}"
        reasons.append(reason)
    sentence = _sentence([entrants[each] for each in able], entrants[winner], entrants[best])
    return Judgement(winner=winner, reasons=tuple(reasons), sentence=sentence)


def _sentence(able: Sequence[Entrant], winner: Entrant, best: Entrant) -> str:
    count = f"{winner.parameters} parameter{'s' * (winner.parameters != 1)}"
    score = percent_with_error(best.score, best.stderr)
    if winner is not best:
        return (
            f"{winner.name} ({count}) is the simplest model within one standard error of the best model, "
            f"{best.name} (residual {score}); the residual of {winner.name} is {100.0 * winner.score:.3g} %"
        )
    simpler = any(each.parameters < winner.parameters for each in able)
    rest = ", and no simpler model is within one standard error of this residual" if simpler else ""
    return (
        f"{winner.name} ({count}) predicts held-out motion best, with a residual of {score}{rest}"
    )
