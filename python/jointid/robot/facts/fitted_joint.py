"""A robot's joint as input of the search for causes: its rows and friction, with the rest of the robot known."""

from __future__ import annotations

import functools
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Literal, Self

import numpy as np
from numpy.typing import NDArray

from jointid import _core
from jointid.balance.windows import interval_means
from jointid.base.advice import Action
from jointid.identification.causes.fitted_balance import FittedBalance
from jointid.identification.causes.samples import Motion, Samples
from jointid.robot.balance.columns import Summing
from jointid.robot.fit.attempt import Attempt
from jointid.robot.links.models import (
    LOAD,
    MODELS,
    PLAIN,
    SHAPED,
    is_asymmetric,
    is_loaded,
    modelled,
    name_of,
    terms_of,
)
from jointid.robot.links.parameters import FRICTION, MOTOR_TERMS, SHAPES

Array = NDArray[np.float64]
Whole = NDArray[np.int64]

_HELD = ("inertia_scale",)  # parameters of a link: they act on other joints, too
_NO_LOAD = ("torque_offset", "rotor_inertia")


@dataclass(frozen=True, kw_only=True)
class FittedJoint(FittedBalance):
    """The minimum of a robot's balance in the parameters of one joint, over excerpts of the recordings.

    Inertias and the parameters of other joints stay at their values.
    """

    joint: int
    attempt: Attempt
    kept: Whole  # row numbers of the joint in the balance
    places: Whole  # positions of its parameters in the fit

    @classmethod
    def of(cls, attempt: Attempt, joint: int) -> Self:
        """Return the fit of a joint."""
        balance, fit = attempt.balance, attempt.fit
        rows, mine = balance.rows, balance.places[joint]
        kept = mine[np.isin(rows.piece[mine], list(attempt.excerpts))]
        places = np.flatnonzero(
            [owner == joint and name not in _HELD for owner, name in fit.labels]
        )
        jacobian = fit.jacobian[kept][:, list(places)]
        free = tuple(
            number
            for number, place in enumerate(places)
            if not fit.at_bound[place] and jacobian[:, number].any()
        )
        return cls(
            joint=joint,
            attempt=attempt,
            kept=kept,
            places=places,
            best=fit.values[places],
            free=free,
            residual=fit.residual[kept],
            jacobian=-jacobian[:, list(free)],
            start=np.zeros(len(free)),
        ).at_own_minimum()

    @property
    def duration_of_recording(self) -> float:
        """Duration of the whole recording; the excerpts are a part of it."""
        rows = self.attempt.balance.rows
        recording = np.asarray(self.attempt.runs)[rows.piece]
        return max(
            float(rows.stop[recording == run].max() - rows.start[recording == run].min())
            for run in np.unique(recording)
        )

    @property
    def names(self) -> tuple[str, ...]:
        """Names of the joint's parameters, shapes last."""
        return tuple(self.attempt.fit.labels[place][1] for place in self.places)

    @property
    def terms(self) -> Sequence[_core.Term | None]:
        """Terms of the joint's own friction, and of a motor that turns with several joints."""
        own: dict[str, _core.Term] = {term.name: term for term in terms_of(self.model)}
        return [(own | MOTOR_TERMS).get(name) for name in self.names if name not in SHAPES]

    @functools.cached_property
    def columns(self) -> Array:
        """Columns of the fit."""
        linear = self.places[: len(self.terms)]
        return self.attempt.fit.jacobian[self.kept][:, list(linear)]

    @property
    def duration(self) -> Array:
        """Durations of the rows."""
        return self.attempt.balance.rows.duration[self.kept]

    @functools.cached_property
    def run(self) -> Whole:
        """Number of each row's excerpt."""
        pieces = sorted(self.attempt.excerpts)
        return np.searchsorted(pieces, self.attempt.balance.rows.piece[self.kept])

    @property
    def spans(self) -> Array:
        """Spans of the rows."""
        rows = self.attempt.balance.rows
        return np.column_stack([rows.start, rows.stop])[self.kept]

    @property
    def window_duration(self) -> float:
        """Duration of the windows, the same for all joints."""
        return self.attempt.duration

    @functools.cached_property
    def runs(self) -> Sequence[Motion]:
        """The joint's motion in the excerpts."""
        return [
            Motion(
                time=motion.time,
                position=motion.position[self.joint],
                velocity=motion.velocity[self.joint],
            )
            for _, motion in sorted(self.attempt.excerpts.items())
        ]

    @property
    def kind(self) -> Literal["revolute", "prismatic"]:
        """Kind of the joint in the URDF."""
        return "prismatic" if self.attempt.robot.tree.prismatic[self.joint] else "revolute"

    @property
    def gear_ratio(self) -> float:
        """Gear ratio of the joint."""
        ratios = self.attempt.robot.gear_ratios
        return 1.0 if ratios is None else abs(float(ratios[self.joint]))

    @property
    def knows_link(self) -> bool:
        """True, because the URDF describes all links."""
        return True

    @functools.cached_property
    def load(self) -> Array:
        """Torque at the joint that the links need, by the fit."""
        own = [
            number
            for number, name in enumerate(self.names[: len(self.terms)])
            if name in FRICTION or name in _NO_LOAD
        ]
        balance = self.attempt.balance
        torque = balance.rows.torque[self.kept] - balance.known[self.kept]
        return np.asarray(torque - self.residual - self.columns[:, own] @ self.best[own])

    @property
    def model(self) -> str:
        """The joint's model."""
        return self.attempt.fit.models[self.joint]

    @property
    def model_name(self) -> str:
        """Name of the joint's model."""
        return name_of(self.model)

    @property
    def is_asymmetric(self) -> bool:
        """Whether the model has different friction in the two directions."""
        return is_asymmetric(self.model)

    def integral_of_each(self, signal: Callable[[int, Samples], Array]) -> Array:
        """Return means over the intervals; within a reversal weighted by the time on each side."""
        return self._summed(
            signal,
            lambda values, summing: (
                interval_means(values, summing.velocity[self.joint]) * summing.step
            ),
        )

    def rise_of_each(self, signal: Callable[[int, Samples], Array]) -> Array:
        """Return differences over the intervals."""
        return self._summed(signal, lambda values, _: np.diff(values))

    def _summed(
        self,
        signal: Callable[[int, Samples], Array],
        over_intervals: Callable[[Array, Summing], Array],
    ) -> Array:
        balance, found = self.attempt.balance, []
        for number, piece in enumerate(sorted(self.attempt.excerpts)):
            run, summing = self.runs[number], balance.summings[piece]
            values = signal(number, Samples.of(run, slice(0, run.time.size)))
            columns = np.atleast_2d(values.T)
            windows = balance.windows_of(self.joint, piece)
            sums = [summing(self.joint, over_intervals(each, summing))[windows] for each in columns]
            found.append(np.column_stack(sums))
        every = np.concatenate(found)
        return every[:, 0] if values.ndim == 1 else every

    def identified_with(self, **changes: Any) -> tuple[Action, ...]:
        """Return a call of `identify` with another model of this joint, if a robot supports it."""
        changed = self._changed(changes)
        if changed is None:
            return self._alone()
        models = {self.attempt.robot.names[self.joint]: changed}
        return (Action("call", {"model": models}, function="identify_robot"),)

    def compared_with(self, **changes: Any) -> tuple[Action, ...]:
        """Return a call of `compare`, if a robot supports such a model."""
        changed = self._changed(changes)
        if changed is None:
            return self._alone()
        if LOAD.option in changes or changes.get("name") not in (None, PLAIN, SHAPED):
            return self.identified_with(**changes)  # with the joint that it was found for
        return (Action("call", {"models": [self.model, changed]}, function="compare_robot_models"),)

    def _changed(self, changes: Mapping[str, Any]) -> str | None:
        """Return the model with these fields; None if a robot's joint has no such model."""
        wanted = {
            "name": self.model_name,
            "asymmetric": self.is_asymmetric,
            LOAD.option: is_loaded(self.model),
            **changes,
        }
        if len(wanted) > 3 or wanted["name"] not in MODELS:
            return None
        return modelled(**wanted)

    def _alone(self) -> tuple[Action, ...]:
        name = self.attempt.robot.names[self.joint]
        return (
            Action(
                "inspect",
                text=f"{name} identified alone, with more friction terms than in this model",
            ),
        )
