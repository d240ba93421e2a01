"""Prediction of a recording by an estimate."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from jointid.base.argument_checks import require_kind
from jointid.base.errors import InputError
from jointid.estimate.friction_map import shared_value
from jointid.estimate.settings import model_of
from jointid.problem.problem import Problem
from jointid.problem.recordings import listed
from jointid.problem.terms import TermChoice
from jointid.problem.window_table import Prediction, r_squared, relative_residual
from jointid.recording.recording import Recording

if TYPE_CHECKING:
    from jointid.estimate.estimate import Estimate


def predict(estimate: Estimate, recording: Recording) -> Prediction:
    """Predict a recording: see `Estimate.predict`."""
    require_kind("recording", recording, Recording)
    settings = estimate.settings
    choice = TermChoice(
        terms=tuple(settings["terms"]),
        model=model_of(settings),
        # In terms of the reading, too: few windows do not show again how the motion explains it.
        residual="torque" if settings["residual"] == "torque" else "sensor",
        sensor="sensor_gain" in settings["terms"],
        gear_ratio=estimate.joint.gear_ratio,
    )
    if recording.kind != settings["kind"]:
        raise InputError(
            f"the estimate is of a {settings['kind']} joint",
            argument="recording.kind",
            value=recording.kind,
        )
    if choice.sensor and recording.sensor is None:
        raise InputError(
            "the estimate has a torque sensor, the recording has none", argument="recording.sensor"
        )
    problem = Problem(
        recordings=listed(recording),
        joint=estimate.joint,
        choice=choice,
        torque_hold=settings["torque_hold"],
        mask_standstill=settings["mask_standstill"],
    )
    penalty = problem.penalty(settings["windows"])
    values = {name: parameter.value for name, parameter in estimate.parameters.items()}
    theta = np.array([shared_value(values, name) for name in penalty.names])
    table = problem.table(penalty, theta)
    return Prediction(
        windows=table,
        relative=relative_residual(table),
        r_squared=r_squared(table),
    )
