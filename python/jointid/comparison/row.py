"""A row of a comparison of models: one model with its residuals on held-out parts."""

from __future__ import annotations

from jointid.base.values import dataclass
from jointid.joint.model import Model


@dataclass(frozen=True, slots=True, kw_only=True)
class ComparedModel:
    """One model of a comparison.

    Attributes
    ----------
    model : str
        Text of the model, e.g. "coulomb_viscous:asymmetric".
    spec : Model
    parameters : int
        Number of free parameters, including shape parameters.
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
        Reason why the model is chosen or not.
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
