"""An estimate held against a recording that it may never have seen."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from jointid.base.argument_checks import require_kind
from jointid.base.errors import InputError
from jointid.joint.model import Model
from jointid.problem.problem import Problem
from jointid.problem.recordings import listed
from jointid.problem.terms import TermChoice
from jointid.problem.window_table import Prediction, r_squared, relative_residual
from jointid.recording.recording import Recording

if TYPE_CHECKING:
    from jointid.estimate.estimate import Estimate


def predict(estimate: Estimate, recording: Recording) -> Prediction:
    """Hold an estimate against a recording: see `Estimate.predict`."""
    require_kind("recording", recording, Recording)
    settings = estimate.settings
    choice = TermChoice(
        terms=tuple(settings["terms"]),
        model=Model.parse(settings["model"]),
        residual=settings["residual"],
        sensor="sensor_gain" in settings["terms"],
        gear_ratio=estimate.joint.gear_ratio,
    )
    if recording.kind != settings["kind"]:
        raise InputError(
            f"the estimate is of a {settings['kind']} joint, the recording is {recording.kind}"
        )
    if choice.sensor and recording.sensor is None:
        raise InputError(
            "the estimate has a torque sensor, but the recording has no signal 'sensor'"
        )
    problem = Problem(
        recordings=listed(recording),
        joint=estimate.joint,
        choice=choice,
        torque_hold=settings["torque_hold"],
        mask_standstill=settings["mask_standstill"],
    )
    penalty = problem.penalty(settings["windows"])
    theta = np.array([_predicting(estimate, name) for name in penalty.names])
    table = problem.table(penalty, theta)
    return Prediction(
        windows=table,
        relative=relative_residual(table),
        r_squared=r_squared(table),
    )


def _predicting(estimate: Estimate, name: str) -> float:
    """A parameter's value; of one that each recording had for itself, the mean."""
    if name in estimate.parameters:
        return estimate.parameters[name].value
    own = [p.value for key, p in estimate.parameters.items() if key.startswith(f"{name}[")]
    return float(np.mean(own))
