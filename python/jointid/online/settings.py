"""Settings of an on-line identification, checked before the first sample."""

from __future__ import annotations

import numbers
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from jointid.base.advice import Action
from jointid.base.errors import InputError
from jointid.identification.prepared import require_joint
from jointid.identification.search.stated_bounds import parameter_bounds
from jointid.joint.checks import finite_number, is_number
from jointid.joint.joint import Joint
from jointid.joint.model import AUTO
from jointid.joint.parameters import Parameter
from jointid.problem.problem import Problem
from jointid.problem.recordings import output_torque
from jointid.problem.terms import Request, TermChoice, choose_terms
from jointid.recording.attributes import check_torque_hold
from jointid.recording.recording import Recording


@dataclass(frozen=True, slots=True, kw_only=True)
class Settings:
    """Settings of an on-line identification; see `OnlineIdentifier`.

    Raises
    ------
    InputError
        Values that cannot be used, by themselves or for this joint.
    """

    joint: Joint | None
    window: float
    update: float
    request: Request
    parameters: Mapping[str, float | Mapping[str, object] | Parameter] | None
    windows: float | None
    torque_hold: str | None
    mask_standstill: bool

    def __post_init__(self) -> None:
        require_joint(self.joint)
        if self.joint is not None:
            own = self.joint.model
            model = self.request.model.over(own).replace(per_recording=own.per_recording)
            object.__setattr__(self, "joint", self.joint.replace(model=model))
        for name in ("window", "update", "windows"):
            _check_duration(name, getattr(self, name), optional=name == "windows")
        if self.window < 4.0 * self.update:
            raise InputError(
                f"at least four times update, {self.update:g} s, is expected",
                argument="window",
                value=self.window,
            )
        if isinstance(self.windows, numbers.Integral):
            raise InputError(
                "the duration of a window in seconds is expected, like 0.02",
                argument="windows",
                value=self.windows,
            )
        if not isinstance(self.mask_standstill, bool):
            raise InputError(
                "true or false is expected", argument="mask_standstill", value=self.mask_standstill
            )
        check_torque_hold(self.torque_hold)
        if self.request.residual == "instruments":
            raise InputError(
                "instruments need the whole recording; on line the gain is found by regression",
                argument="residual",
                value="instruments",
                remedy=Action("call", {"residual": "sensor"}),
            )
        self._check_terms()

    def problem(self, recording: Recording, choice: TermChoice) -> Problem:
        """Return the problem for these samples."""
        return Problem(
            recordings=(recording,),
            joint=self.joint,
            choice=choice,
            torque_hold=self.torque_hold,
            mask_standstill=self.mask_standstill,
        )

    def check_signals(self, signals: tuple[str, ...]) -> None:
        """Refuse signals without one that the terms need.

        Raises
        ------
        InputError
            No torque, or no sensor although the joint has one; parameters that are not among these terms.
        """
        joint = self.joint
        if joint is not None and joint.sensor and "sensor" not in signals:
            raise InputError(
                f"{joint.owner} has a torque sensor, but the samples have no signal sensor",
                argument="sensor",
                place="samples",
                remedy=("give its reading", Action("call", {"sensor": False}, function="Joint")),
            )
        if not {"torque", "motor_torque", "current"} & set(signals):
            raise InputError(
                "it is missing",
                argument="torque",
                place="samples",
                remedy="give the torque at the output, or motor_torque or current and a joint that converts it",
            )
        recording = _example(signals, joint.kind if joint is not None else "revolute")
        output_torque(recording, joint)
        choice = choose_terms((recording,), joint, self.request)
        names = tuple(self.problem(recording, choice).penalty(None).names)
        parameter_bounds(names, joint, self.parameters)
        if self.windows is not None and self.window <= 2 * len(names) * self.windows:
            raise InputError(
                f"{len(names)} parameters need more than {2 * len(names)} windows of integration within window, "
                f"{self.window:g} s",
                argument="windows",
                value=self.windows,
                remedy="give a shorter duration, or a longer window",
            )

    def _check_terms(self) -> None:
        """Refuse settings that are wrong for any samples; only the samples show whether there is a sensor."""
        model = self.request.model
        chosen = (model if self.joint is None else self.joint.model).resolved
        if (model if self.joint is None else self.joint.model).name == AUTO:
            raise InputError(
                "only recorded motion can be held out to choose a model",
                argument="model",
                value=AUTO,
                remedy="name the model, e.g. stribeck",
            )
        if chosen.name == "stribeck_general":
            raise InputError(
                "its two shape parameters take too long to search while samples arrive",
                argument="model",
                value=chosen.name,
                remedy="use the model stribeck",
            )
        if chosen.load_friction:
            raise InputError(
                "it acts on the sum of all other terms, which takes too long to search while samples arrive",
                argument="load_friction",
                value=chosen.load_friction,
                remedy="leave it out",
            )
        if chosen.terms:
            raise InputError(
                "samples that arrive on line have no extra signals",
                argument="terms",
                value=str(chosen.terms),
                remedy=Action("call", {"terms": {}}, text="on a recording, identify has them"),
            )
        if model.per_recording:
            raise InputError(
                "there is only one recording on line",
                argument="per_recording",
                value=list(model.per_recording),
            )
        with_sensor = ("time", "position", "torque", "sensor")
        if self.joint is not None:
            self.check_signals(with_sensor)
            return
        try:
            self.check_signals(with_sensor)
        except InputError:
            self.check_signals(with_sensor[:-1])


def _check_duration(name: str, value: object, *, optional: bool) -> None:
    if optional and value is None:
        return
    if not is_number(value):
        raise InputError("a duration in seconds is expected", argument=name, value=value)
    try:
        seconds = finite_number("", name, value)
    except InputError as error:
        value, seconds = error.value, 0.0
    if seconds <= 0.0:
        raise InputError(
            "a duration above 0 and finite [s] is expected", argument=name, value=value
        )


def _example(signals: tuple[str, ...], kind: str) -> Recording:
    """Return one second of a motion with these signals, to check settings with."""
    time = np.arange(1000) * 1e-3
    motion = np.sin(2.0 * np.pi * time)
    signal: dict[str, Any] = {name: time if name == "time" else motion for name in signals}
    return Recording(**signal, kind=kind)
