"""Prediction of a recording by an estimate."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from jointid import _core
from jointid.base.argument_checks import require_kind
from jointid.base.errors import InputError
from jointid.base.values import dataclass
from jointid.estimate.friction_map import shared_value
from jointid.estimate.record import EstimateRecord
from jointid.estimate.settings import model_of
from jointid.joint.joint import Joint
from jointid.problem.problem import Problem
from jointid.problem.recordings import listed
from jointid.problem.settings import Settings
from jointid.problem.terms import TermChoice
from jointid.problem.window_table import Prediction, r_squared, relative_residual
from jointid.recording.corrections import mended
from jointid.recording.recording import Recording
from jointid.recording.shifting import shifted

Array = NDArray[np.float64]


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class FittedModel:
    """The parts of a fit that a prediction needs, with or without statistical inference.

    Attributes
    ----------
    settings : mapping
        Same as `Estimate.settings`; without the recordings for a fit without inference.
    joint : Joint or None
        The joint. None: a joint without a gear and without known values.
    values : mapping of str to float
        Values of all parameters.
    """

    settings: Mapping[str, Any]
    joint: Joint | None
    values: Mapping[str, float]

    @classmethod
    def of(cls, estimate: EstimateRecord) -> FittedModel:
        """Return the parts of an estimate."""
        values = {name: parameter.value for name, parameter in estimate.parameters.items()}
        return cls(settings=estimate.settings, joint=estimate.joint, values=values)


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class PredictedTorque:
    """The drive's torque in each window, and its residual after a prediction from motion and reading.

    Attributes
    ----------
    start, stop : ndarray
        Start and end of the windows [s].
    torque, residual : ndarray
        Integrals [N·m·s]; the residual is the torque minus the prediction.
    """

    start: Array
    stop: Array
    torque: Array
    residual: Array


def predict(estimate: EstimateRecord, recording: Recording) -> Prediction:
    """Predict a recording: see `Estimate.predict`."""
    fitted = FittedModel.of(estimate)
    problem = _posed(fitted, recording)
    penalty = problem.penalty(fitted.settings["windows"])
    theta = _values_in(fitted, penalty)
    table = problem.table(penalty, theta)
    return Prediction(
        windows=table,
        relative=relative_residual(table),
        r_squared=r_squared(table),
    )


class TorquePredictor:
    """Predictions of the drive's torque by several fits; fits with the same problem share its windows."""

    def __init__(self) -> None:
        self._last: tuple[Problem, Any, _core.Penalty] | None = None

    def predicted(self, fitted: FittedModel, recording: Recording) -> PredictedTorque:
        """Return a fit's prediction of the drive's torque, independent of the residual of the fit.

        Raises
        ------
        InputError
            Same errors as `Estimate.predict`.
        """
        problem, windows = _posed(fitted, recording), fitted.settings["windows"]
        if self._last is None or self._last[:2] != (problem, windows):
            self._last = (problem, windows, problem.penalty(windows))
        return _predicted_torque(fitted, recording, self._last[2])


def _predicted_torque(
    fitted: FittedModel, recording: Recording, penalty: _core.Penalty
) -> PredictedTorque:
    theta = _values_in(fitted, penalty)
    residual = np.asarray(penalty.residuals(theta))
    if penalty.residual == _core.Residual.sensor:
        residual = residual * theta[penalty.names.index("sensor_gain")]
    bounds = np.asarray(penalty.windows)
    return PredictedTorque(
        start=recording.time[bounds[:, 0]],
        stop=recording.time[bounds[:, 1]],
        torque=np.asarray(penalty.target),
        residual=residual,
    )


def _posed(fitted: FittedModel, recording: Recording) -> Problem:
    """Return the problem of a recording with the fit's settings."""
    require_kind("recording", recording, Recording)
    settings = fitted.settings
    choice = TermChoice(
        terms=tuple(settings["terms"]),
        model=model_of(settings),
        # Use the reading itself: few windows cannot show again how the motion explains it.
        residual="torque" if settings["residual"] == "torque" else "sensor",
        sensor="sensor_gain" in settings["terms"],
        gear_ratio=1.0 if fitted.joint is None else fitted.joint.gear_ratio,
    )
    if recording.kind != settings["kind"]:
        raise InputError(
            f"the estimate describes a {settings['kind']} joint",
            argument="recording.kind",
            value=recording.kind,
        )
    if choice.sensor and recording.sensor is None:
        raise InputError(
            "the estimate has a torque sensor, but the recording has none",
            argument="recording.sensor",
        )
    shift = settings.get("shift", {})
    if recording.velocity_derived:
        shift = {name: delay for name, delay in shift.items() if name != "velocity"}
    return Problem(
        recordings=tuple(shifted(mended(run)[0], shift) for run in listed(recording)),
        joint=fitted.joint,
        choice=choice,
        settings=Settings.of({**settings, "model": choice.model, "terms": None, "shift": shift}),
    )


def _values_in(fitted: FittedModel, penalty: _core.Penalty) -> Array:
    """Return the fitted values in the order of a penalty's names."""
    return np.array([shared_value(fitted.values, name) for name in penalty.names])
