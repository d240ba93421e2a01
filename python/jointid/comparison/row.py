"""A row of a comparison of models: one model with its residuals on held-out parts."""

from __future__ import annotations

from jointid.base.values import dataclass
from jointid.joint.model import Model


@dataclass(frozen=True, slots=True, kw_only=True)
class ComparedModel:
    """One row of a comparison.

    Attributes
    ----------
    model : str
        The model's text, e.g. "coulomb_viscous:asymmetric".
    spec : Model
    parameters : int
        Number of free parameters, shape parameters included.
    score : float
        Relative residual of held-out windows: mean over the folds.
    stderr : float
        Its standard error over the folds.
    fold_scores : tuple of float
    penalty : float
        Penalty of the fit to all data [unit of a window integral, squared].
    eligible : bool
        Whether the data support the model; otherwise it cannot be chosen.
    reason : str
        Why it is chosen or not.
    """

    model: str
    spec: Model
    parameters: int
    score: float
    stderr: float
    fold_scores: tuple[float, ...]
    penalty: float
    eligible: bool
    reason: str
