"""A servo's balance as input of the search for causes, on windows that do not overlap."""

from __future__ import annotations

import functools
from collections.abc import Callable, Sequence
from typing import Any, Literal, Self

import numpy as np
from numpy.typing import NDArray

from jointid import _core
from jointid.base.advice import Action
from jointid.base.values import dataclass
from jointid.identification.causes.fitted_balance import FittedBalance
from jointid.identification.causes.samples import Motion, Samples
from jointid.joint.joint import Joint
from jointid.joint.model import Model
from jointid.servo.layout import BY_LOAD, LAYOUTS, LOAD_FRICTION
from jointid.servo.signals import ServoSignals
from jointid.servo.solving import Unknowns, weights
from jointid.servo.windows import ServoGrid

Array = NDArray[np.float64]
Whole = NDArray[np.int64]

_STEP = 1e-3  # relative step of a parameter; exact, because the weights are of second degree


@dataclass(frozen=True, kw_only=True)
class FittedServo(FittedBalance):
    """The minimum of a servo's balance, with the sign of the gear's torque held."""

    grid: ServoGrid
    unknowns: Unknowns
    joint: Joint
    signals: Sequence[ServoSignals]
    kept: Whole  # numbers of the windows in the grid
    every: Array  # (windows, parameters), derivatives of the residual

    @classmethod
    def of(
        cls,
        joint: Joint,
        signals: Sequence[ServoSignals],
        grid: ServoGrid,
        filled: Array,
        unknowns: Unknowns,
        values: Array,
    ) -> Self:
        """Return the fit of a solution; `filled` is the table with the load's friction."""
        kept = _side_by_side(grid)
        rows = filled[kept]
        every = np.column_stack([rows @ _slope(values, place) for place in range(len(values))])
        free = tuple(
            place
            for place in _identified(unknowns)
            if values[place] > 0.0 and every[:, place].any()
        )
        return cls(
            grid=grid,
            unknowns=unknowns,
            joint=joint,
            signals=signals,
            kept=kept,
            every=every,
            best=values,
            free=free,
            residual=rows @ weights(values),
            jacobian=every[:, free],
            start=np.zeros(len(free)),
        ).at_own_minimum()

    @property
    def names(self) -> tuple[str, ...]:
        """Names of the layout's parameters, and the share of a held command."""
        names = self.unknowns.layout.names
        if not self.unknowns.loaded:
            names = tuple("" if name == LOAD_FRICTION.name else name for name in names)
        return (*names, "held")

    @property
    def terms(self) -> Sequence[_core.Term | None]:
        """Terms of friction."""
        own = {term.name: term for term in (*self.unknowns.layout.friction, LOAD_FRICTION)}
        return [own.get(name) for name in self.names]

    @property
    def columns(self) -> Array:
        """Torque per parameter, with the sign of the measured torque."""
        return -self.every

    @functools.cached_property
    def duration(self) -> Array:
        """Durations of the windows."""
        return np.asarray(self.grid.integrals(np.ones(len(self.grid.velocity)))[self.kept, 0])

    @property
    def run(self) -> Whole:
        """Run of each window."""
        return self.grid.run[self.kept]

    @property
    def spans(self) -> Array:
        """Spans of the windows."""
        first = self.grid.time[self.kept]
        return np.column_stack([first, first + self.duration])

    @property
    def window_duration(self) -> float:
        """Usual duration of a window."""
        return float(np.median(self.duration))

    @functools.cached_property
    def runs(self) -> Sequence[Motion]:
        """The runs on their grids."""
        bounds = np.cumsum([0, *map(len, self.grid.instants)])
        return [
            Motion(
                time=time,
                position=self.grid.position[low : low + len(time)],
                velocity=self.grid.velocity[low : low + len(time)],
            )
            for low, time in zip(bounds, self.grid.instants, strict=False)
        ]

    @property
    def run_names(self) -> Sequence[str]:
        """Names of the runs."""
        return [run.name for run in self.signals]

    @property
    def kind(self) -> Literal["revolute", "prismatic"]:
        """A servo turns."""
        return "revolute"

    @property
    def gear_ratio(self) -> float:
        """Gear ratio of the joint."""
        return abs(self.joint.gear_ratio)

    @property
    def knows_link(self) -> bool:
        """The joint's link is its only known torque."""
        return True

    @property
    def has_torque(self) -> bool:
        """True, because the load gives the scale of the torque."""
        return False

    @property
    def load(self) -> Array:
        """Size of the gear's torque, with the sign of the velocity."""
        return -self.every[:, BY_LOAD]

    @property
    def model_name(self) -> str:
        """Name of the layout's friction model."""
        return self.unknowns.layout.model

    def integral_of_each(self, signal: Callable[[int, Samples], Array]) -> Array:
        """Return integrals by the trapezoidal rule on the grid."""
        values = self._on_grid(signal)
        found = self.grid.integrals(*np.atleast_2d(values.T))[self.kept]
        return found[:, 0] if values.ndim == 1 else found

    def rise_of_each(self, signal: Callable[[int, Samples], Array]) -> Array:
        """Return differences between the first and last instant of each window."""
        values = self._on_grid(signal)
        return np.asarray(values[self.grid.end[self.kept]] - values[self.grid.start[self.kept]])

    def _on_grid(self, signal: Callable[[int, Samples], Array]) -> Array:
        return np.concatenate(
            [
                signal(number, Samples.of(run, slice(0, len(run.time))))
                for number, run in enumerate(self.runs)
            ]
        )

    def identified_with(self, **_: Any) -> tuple[Action, ...]:
        """Return advice to inspect the servo: its model has no such term."""
        return (
            Action("inspect", text="how the servo turns: its model has no term for this effect"),
        )

    def with_offset(self) -> tuple[Action, ...]:
        """Return advice to inspect the zero: gravity is the only known torque, so a wrong zero looks like an offset."""
        return (Action("inspect", text="the zero of the position, and the link's angle and mass"),)

    def compared_with(self, **changes: Any) -> tuple[Action, ...]:
        """Return a call of `compare`, if a servo supports such a model."""
        known: dict[str, Any] = {
            "name": self.model_name,
            LOAD_FRICTION.option: self.unknowns.load_friction,
        }
        wanted = known | changes
        if wanted.keys() != known.keys() or wanted["name"] not in LAYOUTS:
            return self.identified_with(**changes)
        models = [str(Model(**each)) for each in (known, wanted)]
        return (Action("call", {"models": models}, function="compare_servo_models"),)


def _side_by_side(grid: ServoGrid) -> Whole:
    """Return the numbers of windows that do not overlap."""
    first = grid.start[np.searchsorted(grid.run, grid.run)]
    return np.flatnonzero((grid.start - first) % (grid.end - grid.start) == 0)


def _slope(values: Array, place: int) -> Array:
    """Return the derivative of the table's weights by a parameter."""
    step = np.zeros(len(values))
    step[place] = _STEP * max(abs(float(values[place])), 1.0)
    return np.asarray((weights(values + step) - weights(values - step)) / (2.0 * step[place]))


def _identified(unknowns: Unknowns) -> list[int]:
    """Return the places of the parameters that the balance determines; the share of a held command is fixed."""
    known = set(unknowns.fixed)
    if not unknowns.load_friction:
        known.add(LOAD_FRICTION.name)
    if unknowns.motor_known or not unknowns.divided:
        known.add("back_emf")
    return [place for place, name in enumerate(unknowns.layout.names) if name not in known]
