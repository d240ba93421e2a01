"""Largest values that joints reach in a motion."""

from __future__ import annotations

from dataclasses import asdict, fields
from typing import Any

from jointid.base.errors import InputError
from jointid.base.values import dataclass
from jointid.joint.checks import finite_number, not_negative, set_numbers


@dataclass(frozen=True, slots=True, kw_only=True)
class Peaks:
    """Largest values that several simulated joints reach in one motion.

    For a prismatic joint the units are m, m/s, m/s² and N.

    Parameters
    ----------
    position : tuple of float
        Lowest and highest position [rad].
    velocity : float
        Largest magnitude of the velocity [rad/s].
    acceleration : float
        Largest magnitude of the reference's acceleration [rad/s²].
    torque : float
        Largest magnitude of the drive torque at the joint [N·m].
    sensor_torque : float, optional
        Largest magnitude at the joint's torque sensor [N·m]. Default: no sensor.

    Raises
    ------
    InputError
        A value is not finite, or a magnitude is below 0.
    """

    position: tuple[float, float]
    velocity: float
    acceleration: float
    torque: float
    sensor_torque: float | None = None

    def __post_init__(self) -> None:
        low, high = (finite_number("peaks", "position", bound) for bound in self.position)
        if not low <= high:
            raise InputError(
                "the first value must not be above the second",
                argument="position",
                value=[low, high],
                place="peaks",
            )
        object.__setattr__(self, "position", (low, high))
        others = [item.name for item in fields(self) if item.name != "position"]
        set_numbers(self, "peaks", others, not_negative)

    def to_dict(self) -> dict[str, Any]:
        """Return the values by name, in JSON types."""
        return {**asdict(self), "position": list(self.position)}
