"""Order of a servo's parameters and of its balance's columns; friction comes from the core's table of terms."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from jointid import _core
from jointid.base.values import dataclass

Array = NDArray[np.float64]

_SPEED_TERMS = [t for t in _core.terms() if t.friction and not (t.needs_load or t.shapes or t.side)]
SPEED_FRICTION = tuple(sorted(_SPEED_TERMS, key=lambda term: term.basis != "linear"))
"""Friction terms of the speed without shapes. The first is viscous friction, which brakes like back-EMF."""

LOAD_FRICTION = next(term for term in _core.terms() if term.needs_load and not term.behind_gear)
TERMS = (*SPEED_FRICTION, LOAD_FRICTION, _core.term("inertia"))
"""All terms that a servo can have."""

MOTOR = ("torque_constant", "resistance")
"""Values derived from a solution."""

# Columns of the table; columns of speed-dependent friction start at LINEAR_COLUMN.
VOLTAGE, LATE, DRIVEN, LINEAR_COLUMN = range(4)
CHANGE, KNOWN, LOAD, LOAD_VOLTAGE, LOAD_LATE, LOAD_DRIVEN = range(-6, 0)

# Entries of a solution; speed-dependent friction starts at LINEAR. HELD: share of a held command between rows,
# from 0 (interpolated linearly) to 1.
TORQUE, BACK_EMF, LINEAR = range(3)
BY_LOAD, INERTIA, HELD = range(-3, 0)


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Layout:
    """The parameters of a servo with one friction model."""

    model: str
    friction: tuple[_core.Term, ...]  # terms of the speed, in the order of `SPEED_FRICTION`

    @property
    def names(self) -> tuple[str, ...]:
        """Names of the parameters, in the order of a solution; `HELD` comes after them in the solution."""
        friction = (term.name for term in (*self.friction, LOAD_FRICTION))
        return ("torque_per_voltage", "back_emf", *friction, "inertia")

    def by_name(self, solution: Array) -> dict[str, float]:
        """Return the parameters of a solution by their names."""
        return dict(zip(self.names, solution[:HELD].tolist(), strict=True))

    @property
    def linear(self) -> str:
        """Name of viscous friction, which is the first; "" without it."""
        return next((term.name for term in self.friction if term.basis == "linear"), "")


LAYOUTS = {
    model.name: Layout(
        model=model.name, friction=tuple(t for t in SPEED_FRICTION if t.key in model.terms)
    )
    for model in _core.models()
    if not any(_core.term(key).shapes for key in model.terms)
}
"""Layout of each friction model that a servo can have, by name."""

DEFAULT_MODEL = next(iter(LAYOUTS))


def balance(last: Array) -> tuple[Array, Array]:
    """Return the linearized balance: columns (m, columns, size), and the torques that they give (m, columns).

    Columns that are products of parameters are formed with the last solutions, (m, size).
    """
    count, size = last.shape
    torque, held = last[:, TORQUE], last[:, HELD]
    columns, target = np.zeros((count, size + 4, size)), np.zeros((count, size + 4))
    columns[:, VOLTAGE, TORQUE] = target[:, KNOWN] = 1.0
    columns[:, LATE, HELD] = torque
    columns[:, DRIVEN:CHANGE, BACK_EMF:BY_LOAD] = -np.eye(size - 4)
    columns[:, CHANGE, INERTIA] = columns[:, LOAD, BY_LOAD] = -1.0
    columns[:, LOAD_VOLTAGE, BY_LOAD] = -torque
    columns[:, LOAD_LATE, BY_LOAD] = -torque * held
    columns[:, LOAD_DRIVEN, BY_LOAD] = last[:, BACK_EMF]
    return columns, target
