"""Units: axis labels of velocity and torque, and units of parameters from the table of terms."""

from __future__ import annotations

from jointid import _core


def velocity_label(kind: str) -> str:
    """Return the label of a velocity axis for a kind of joint."""
    return "velocity [m/s]" if kind == "prismatic" else "velocity [rad/s]"


def torque_unit(kind: str) -> str:
    """Return the unit of torque, or of force for a prismatic joint."""
    return "N" if kind == "prismatic" else "N·m"


def parameter_unit(name: str, kind: str = "revolute") -> str:
    """Return the unit of a parameter; ``""`` for an unknown name."""
    units = {row.name: (row.unit, row.unit_prismatic) for row in _core.terms()}
    units |= {row.name: (row.unit, row.unit_prismatic) for row in _core.shapes()}
    return units.get(name, ("", ""))[kind == "prismatic"]
