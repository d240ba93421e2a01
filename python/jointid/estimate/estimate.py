"""What an identification found, and how far it can be believed."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from jointid.base.argument_checks import require_kind, require_path
from jointid.base.errors import InputError
from jointid.estimate.statistics import (
    Convergence,
    FrictionCurve,
    ParameterEstimate,
    ResidualStatistics,
    Warned,
)
from jointid.problem.window_table import Prediction, WindowTable

if TYPE_CHECKING:
    from jointid.joint.joint import Joint
    from jointid.recording.recording import Recording

Array = NDArray[np.float64]


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Estimate:
    """The result of `identify`: numbers, their uncertainty, and what to mind.

    Attributes
    ----------
    parameters : mapping of str to ParameterEstimate
        In the order of the torque balance.
    status : str
        "converged", or "stopped" when a callback ended the search early.
    message : str
        How the search ended, in a sentence.
    penalty : float
        Sum of squared window residuals, by the direct sum.
    correlation : ndarray, shape (p, p)
        Of the free parameters, in the order of `free`; offsets centred at the mean reading.
    condition : float
        Condition number of the scaled regressor.
    weakest : tuple of str
        Parameters in the direction that the data determine least.
    covariance : ndarray, shape (p, p)
        Of the free parameters.
    residuals : ResidualStatistics
    windows : WindowTable
    convergence : Convergence or None
        None without a genetic search.
    warnings : tuple of Warned
    joint : Joint
        The joint with the estimated values, ready to be used or saved.
    settings : mapping
        Everything needed to repeat the run: method, residual, terms, options, seed, versions, fingerprints.
    seconds : float
        Wall time.
    """

    parameters: Mapping[str, ParameterEstimate]
    free: tuple[str, ...]
    status: str
    message: str
    penalty: float
    correlation: Array
    condition: float
    weakest: tuple[str, ...]
    covariance: Array
    residuals: ResidualStatistics
    windows: WindowTable
    convergence: Convergence | None
    warnings: tuple[Warned, ...]
    joint: Joint
    settings: Mapping[str, Any]
    seconds: float = field(repr=False)

    def __repr__(self) -> str:
        values = ", ".join(f"{p.name}={p.value:.6g}" for p in self.parameters.values())
        return f"Estimate({values}; {len(self.warnings)} warnings)"

    def friction(self, velocity: ArrayLike, *, load: float = 0.0) -> FrictionCurve:
        """Friction at given velocities, with a pointwise 95 % band.

        Parameters
        ----------
        velocity : array_like, shape (n,)
            [rad/s or m/s]
        load : float
            Torque that the drive transmits [N·m or N], for the term `load_friction`; its sign does not
            matter. Default 0: friction without load, which is also what `windows.friction` shows.
        """
        from jointid.estimate.friction_map import friction_curve

        return friction_curve(self, np.atleast_1d(np.asarray(velocity, dtype=np.float64)), load)

    def predict(self, recording: Recording) -> Prediction:
        """Hold the estimate against a recording: window integrals measured and predicted.

        Raises
        ------
        InputError
            When the recording lacks a signal that the estimate's terms need.
        """
        from jointid.estimate.prediction import predict

        return predict(self, recording)

    def report(self) -> str:
        """The estimate as text: parameters, quality of the fit, warnings."""
        from jointid.estimate.tables import text_report

        return text_report(self)

    def _repr_html_(self) -> str:
        from jointid.estimate.tables import html_summary

        return html_summary(self)

    def to_json(self) -> str:
        """Everything, as JSON with a schema version; `Estimate.from_json` reads it back."""
        from jointid.estimate.json import write_estimate

        return write_estimate(self)

    @classmethod
    def from_json(cls, text: str) -> Estimate:
        """Read what `to_json` wrote.

        Raises
        ------
        InputError
            Not JSON, not an estimate, or a newer schema.
        """
        from jointid.estimate.json import read_estimate

        require_kind("text", text, str)
        return read_estimate(text)

    def save(self, path: str | Path) -> None:
        """Save to a joint file (.toml: values go into its parameter table, comments stay) or to .json.

        The file is written whole or not at all.

        Raises
        ------
        InputError
            Another extension, or an existing joint file that cannot be read.
        """
        from jointid.base.files import write_whole

        path = require_path("path", path)
        if path.suffix == ".toml":
            self.joint.save(path)
        elif path.suffix == ".json":
            write_whole(path, self.to_json().encode())
        else:
            raise InputError(
                f"{path}: an estimate is saved as .toml (joint file) or .json, not '{path.suffix}'"
            )
