"""Settings of an online identification, checked before the first sample."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from jointid.base.advice import Action
from jointid.base.errors import InputError
from jointid.identification.prepared import require_joint
from jointid.identification.search.stated_bounds import parameter_bounds
from jointid.joint.joint import Joint
from jointid.joint.model import AUTO
from jointid.online.options import checked_duration
from jointid.problem.problem import Problem
from jointid.problem.recordings import output_torque
from jointid.problem.settings import Settings
from jointid.problem.terms import Request, TermChoice, choose_terms
from jointid.recording.recording import Recording


@dataclass(frozen=True, slots=True, kw_only=True)
class OnlineSettings:
    """Settings of an online identification; see `OnlineIdentifier`.

    Attributes
    ----------
    posed : Settings
        Settings of the problem for the samples of a window.

    Raises
    ------
    InputError
        Values are invalid, alone or for this joint.
    """

    joint: Joint | None
    window: float
    update: float
    posed: Settings

    def __post_init__(self) -> None:
        require_joint(self.joint)
        if self.joint is not None:
            own = self.joint.model
            model = self.posed.model.over(own).replace(per_recording=own.per_recording)
            object.__setattr__(self, "joint", self.joint.replace(model=model))
        for name in ("window", "update"):
            checked_duration(name, getattr(self, name))
        if self.window < 4.0 * self.update:
            raise InputError(
                f"at least four times `update` ({4.0 * self.update:g} s) is expected",
                argument="window",
                value=self.window,
            )
        if self.posed.residual == "instruments":
            raise InputError(
                "instrumental variables need the whole recording; online, a regression identifies the gain",
                argument="residual",
                value="instruments",
                remedy=Action("call", {"residual": "sensor"}),
            )
        self._check_terms()

    @property
    def request(self) -> Request:
        """Terms and residual that the call requests."""
        return Request(model=self.posed.model, residual=self.posed.residual)

    @property
    def windows(self) -> float | None:
        """Stated duration of an integration window [s]; None: not stated."""
        windows = self.posed.windows
        assert windows is None or isinstance(windows, float)
        return windows

    def problem(self, recording: Recording, choice: TermChoice) -> Problem:
        """Return the problem for these samples."""
        return Problem(
            recordings=(recording,),
            joint=self.joint,
            choice=choice,
            settings=self.posed,
        )

    def check_signals(self, signals: tuple[str, ...]) -> None:
        """Refuse signals if one that the terms need is missing.

        Raises
        ------
        InputError
            There is no torque, or no sensor although the joint has one, or parameters are not among these terms.
        """
        joint = self.joint
        if joint is not None and joint.sensor and "sensor" not in signals:
            raise InputError(
                f"{joint.owner} has a torque sensor, but the samples have no signal sensor",
                argument="sensor",
                place="samples",
                remedy=(
                    "give the sensor's reading",
                    Action("call", {"sensor": False}, function="Joint"),
                ),
            )
        if not {"torque", "motor_torque", "current"} & set(signals):
            raise InputError(
                "this signal is missing",
                argument="torque",
                place="samples",
                remedy="give the torque at the output, or motor_torque or current with a joint that converts them",
            )
        recording = _example(signals, joint.kind if joint is not None else "revolute")
        output_torque(recording, joint)
        choice = choose_terms((recording,), joint, self.request)
        names = tuple(self.problem(recording, choice).penalty(None).names)
        parameter_bounds(names, joint, self.posed.parameters)
        if self.windows is not None and self.window <= 2 * len(names) * self.windows:
            raise InputError(
                f"{len(names)} parameters need more than {2 * len(names)} integration windows within "
                f"`window` ({self.window:g} s)",
                argument="windows",
                value=self.windows,
                remedy="give a shorter duration, or a longer window",
            )

    def _check_terms(self) -> None:
        """Refuse settings that are wrong for any samples; the sensor is checked later, with the samples."""
        model = self.posed.model
        chosen = (model if self.joint is None else self.joint.model).resolved
        if (model if self.joint is None else self.joint.model).name == AUTO:
            raise InputError(
                "auto needs held-out recorded motion, so the model cannot be chosen online",
                argument="model",
                value=AUTO,
                remedy="name the model, e.g. stribeck",
            )
        if chosen.name == "stribeck_general":
            raise InputError(
                "online, the search for the two shape parameters of this model takes too long",
                argument="model",
                value=chosen.name,
                remedy="use the model stribeck",
            )
        if chosen.load_friction:
            raise InputError(
                "load friction acts on the sum of all other terms; online, the search for load friction takes too long",
                argument="load_friction",
                value=chosen.load_friction,
                remedy="leave it out",
            )
        if chosen.terms:
            raise InputError(
                "samples that arrive online have no extra signals",
                argument="terms",
                value=str(chosen.terms),
                remedy=Action(
                    "call", {"terms": {}}, text="only identify on a recording uses extra signals"
                ),
            )
        if model.per_recording:
            raise InputError(
                "online, there is only one recording",
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


def _example(signals: tuple[str, ...], kind: str) -> Recording:
    """Return one second of a motion with these signals, to check settings with."""
    time = np.arange(1000) * 1e-3
    motion = np.sin(2.0 * np.pi * time)
    signal: dict[str, Any] = {name: time if name == "time" else motion for name in signals}
    return Recording(**signal, kind=kind)
