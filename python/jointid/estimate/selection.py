"""The automatic choice of a model: candidates, scores, and reason."""

from __future__ import annotations

from jointid.base.schema import ListOf, Number, OrNull, Record, Text
from jointid.base.values import dataclass


@dataclass(frozen=True, slots=True, kw_only=True)
class Candidate:
    """A candidate model.

    Attributes
    ----------
    model : str
        Text of the model, e.g. "stribeck:gravity=free".
    parameters : int
        Number of free parameters, shape parameters included.
    score : float
        Norm of the residuals over the norm of the torque, in held-out windows. The torque is predicted from the
        motion, and from the sensor's reading if there is one.
    excess : float
        Mean squared residual of the held-out windows minus that of the best candidate, in standard errors of
        this difference; 0 for the best candidate.
    refused : str
        Reason why it could not be chosen; empty if it could.
    """

    model: str
    parameters: int
    score: float
    excess: float
    refused: str = ""


@dataclass(frozen=True, slots=True, kw_only=True)
class Selection:
    """Choice of a model by its prediction of held-out parts of the recordings.

    Attributes
    ----------
    model : str
        Text of the chosen model.
    runner_up : str or None
        Text of the second best model; None if there was no other model.
    candidates : tuple of Candidate
        Candidates, simplest first.
    blocks : int
        Number of parts of the recordings. Each part was held out once.

    Examples
    --------
    >>> jid.identify(recording).selection.model
    'stribeck'
    """

    model: str
    runner_up: str | None
    candidates: tuple[Candidate, ...]
    blocks: int

    def __getitem__(self, model: str) -> Candidate:
        """Return the candidate with this text.

        Raises
        ------
        KeyError
            There is no such candidate.
        """
        for each in self.candidates:
            if each.model == model:
                return each
        raise KeyError(model)

    @property
    def sentence(self) -> str:
        """Chosen model and reason in one line, with the second best model and both scores."""
        chosen = self[self.model]
        if self.runner_up is None:
            return f"{self.model}: no other model could be compared"
        other = self[self.runner_up]
        text = (
            f"{self.model} has a residual of {_percent(chosen.score)} of the held-out torque, "
            f"{other.model} has {_percent(other.score)}"
        )
        if other.refused:
            return f"{text} ({other.refused})"
        if other.score < chosen.score:
            return f"{text}; the difference may be chance"
        return text


def _percent(share: float) -> str:
    return f"{100.0 * share:.3g} %"


SELECTION = Record(
    {
        "model": Text(),
        "runner_up": OrNull(Text()),
        "candidates": ListOf(
            Record(
                {
                    "model": Text(),
                    "parameters": Number(low=0, high=2**31, whole=True),
                    "score": Number(low=0.0, infinite=True),
                    "excess": Number(infinite=True),
                    "refused": Text(),
                }
            ),
            shortest=1,
        ),
        "blocks": Number(low=0, high=2**31, whole=True),
    }
)
