"""A robot's joint as the attribution of causes sees it: its rows, its friction, the rest of the robot as known."""

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

_HELD = ("inertia_scale",)  # of a link: it acts on other joints, too
_NO_LOAD = ("torque_offset", "rotor_inertia")


@dataclass(frozen=True, kw_only=True)
class FittedJoint(FittedBalance):
    """The minimum of a robot's balance in the parameters of one joint, over the recordings' excerpts.

    Inertias and the parameters of other joints are held at their values.
    """

    joint: int
    attempt: Attempt
    kept: Whole  # its rows of the balance
    places: Whole  # of its parameters in the fit

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
        """Of all of it, of which the excerpts are a part."""
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
        """Of its own friction, and of a motor's that turns with several joints."""
        own: dict[str, _core.Term] = {term.name: term for term in terms_of(self.model)}
        return [(own | MOTOR_TERMS).get(name) for name in self.names if name not in SHAPES]

    @functools.cached_property
    def columns(self) -> Array:
        """Those of the fit."""
        linear = self.places[: len(self.terms)]
        return self.attempt.fit.jacobian[self.kept][:, list(linear)]

    @property
    def duration(self) -> Array:
        """Of its rows."""
        return self.attempt.balance.rows.duration[self.kept]

    @functools.cached_property
    def run(self) -> Whole:
        """Number of each row's excerpt."""
        pieces = sorted(self.attempt.excerpts)
        return np.searchsorted(pieces, self.attempt.balance.rows.piece[self.kept])

    @property
    def spans(self) -> Array:
        """Of its rows."""
        rows = self.attempt.balance.rows
        return np.column_stack([rows.start, rows.stop])[self.kept]

    @property
    def window_duration(self) -> float:
        """Of all joints."""
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
        """That of the URDF."""
        return "prismatic" if self.attempt.robot.tree.prismatic[self.joint] else "revolute"

    @property
    def gear_ratio(self) -> float:
        """That of the robot."""
        ratios = self.attempt.robot.gear_ratios
        return 1.0 if ratios is None else abs(float(ratios[self.joint]))

    @property
    def knows_link(self) -> bool:
        """The URDF describes all links."""
        return True

    @functools.cached_property
    def load(self) -> Array:
        """What the links need of the joint, by the fit."""
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
        """Its name."""
        return name_of(self.model)

    @property
    def is_asymmetric(self) -> bool:
        """Whether the model says so."""
        return is_asymmetric(self.model)

    def integral_of_each(self, signal: Callable[[int, Samples], Array]) -> Array:
        """Means over the intervals, within a reversal by the share of time on each side."""
        return self._summed(
            signal,
            lambda values, summing: (
                interval_means(values, summing.velocity[self.joint]) * summing.step
            ),
        )

    def rise_of_each(self, signal: Callable[[int, Samples], Array]) -> Array:
        """Differences over the intervals."""
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
        """A call of `identify` with another model of this joint, where a robot can have it."""
        changed = self._changed(changes)
        if changed is None:
            return self._alone()
        models = {self.attempt.robot.names[self.joint]: changed}
        return (Action("call", {"model": models}, function="identify_robot"),)

    def compared_with(self, **changes: Any) -> tuple[Action, ...]:
        """A call of `compare`, where a robot can have such a model."""
        changed = self._changed(changes)
        if changed is None:
            return self._alone()
        if LOAD.option in changes or changes.get("name") not in (None, PLAIN, SHAPED):
            return self.identified_with(**changes)  # of the joints that it was found for
        return (Action("call", {"models": [self.model, changed]}, function="compare_robot_models"),)

    def _changed(self, changes: Mapping[str, Any]) -> str | None:
        """The model with these fields; None where a robot's joint has no such model."""
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
        return (Action("inspect", text=f"{name} as a single joint, for which more is modelled"),)
