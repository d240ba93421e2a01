"""The limits of a designed motion."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, fields
from typing import Any

import numpy as np

from jointid.base.errors import InputError
from jointid.joint.checks import finite_number, positive_number, set_numbers, suggestion
from jointid.joint.joint import Joint
from jointid.simulation.plant import torque_limit

OWN_SHARE = 0.9
"""Share of the joint file's window and velocity that a motion uses by default, because a session stops at them."""

_OWNER = "limits"
_NARROWEST, _FARTHEST = 1e-9, 1e9  # [rad] or [m], of a window
_SMALLEST = 1e-9  # lowest other limit, because the used share divides by it


@dataclass(frozen=True, slots=True, kw_only=True)
class MotionLimits:
    """Limits of a designed motion. Both the reference and the motion of the joint stay within these limits.

    For a prismatic joint, lengths are in m and torques are forces.

    Parameters
    ----------
    position : tuple of float
        Lowest and highest position [rad].
    velocity : float
        Largest magnitude of the velocity [rad/s].
    acceleration : float, optional
        Largest magnitude of the reference's acceleration [rad/s²]. Default: not limited.
    torque : float, optional
        Largest magnitude of the drive torque at the joint [N·m]. Default: not limited; `of` uses the joint's limit.
    sensor_range : float, optional
        Largest magnitude of the torque at the joint's torque sensor [N·m]. Default: not limited.

    Raises
    ------
    InputError
        A limit is not a finite number above 0, or the window is empty.

    Examples
    --------
    >>> limits = MotionLimits(position=(-1.0, 1.0), velocity=3.4, torque=160.0)
    """

    position: tuple[float, float]
    velocity: float
    acceleration: float | None = None
    torque: float | None = None
    sensor_range: float | None = None

    def __post_init__(self) -> None:
        window: Any = self.position
        if isinstance(window, np.ndarray):
            window = window.tolist()
        if not isinstance(window, list | tuple) or len(window) != 2:
            raise InputError(
                "a lowest and a highest position are expected",
                argument="position",
                value=window,
                place=_OWNER,
            )
        low, high = (finite_number(_OWNER, "position", bound) for bound in window)
        if not low < high:
            raise InputError(
                "the first value must be below the second",
                argument="position",
                value=[low, high],
                place=_OWNER,
            )
        if high - low < _NARROWEST or max(abs(low), abs(high)) > _FARTHEST:
            raise InputError(
                f"a window that is at least {_NARROWEST:g} wide and at most {_FARTHEST:g} from 0 is expected",
                argument="position",
                value=[low, high],
                place=_OWNER,
            )
        object.__setattr__(self, "position", (low, high))
        others = [item.name for item in fields(self) if item.name != "position"]
        set_numbers(self, _OWNER, others, positive_number)
        for name in others:
            value = getattr(self, name)
            if value is not None and value < _SMALLEST:
                raise InputError(
                    f"at least {_SMALLEST:g} is expected", argument=name, value=value, place=_OWNER
                )

    @classmethod
    def of(cls, given: MotionLimits | Mapping[str, Any] | None, joint: Joint) -> MotionLimits:
        """Return motion limits. The joint's limits replace missing limits.

        Parameters
        ----------
        given : MotionLimits, mapping or None
            Stated limits. A mapping contains fields of `MotionLimits`.
        joint : Joint
            Joint with limits. Nine tenths of its position window and velocity limit are used, because a session
            stops at the full limits. Its torque limit (the smaller limit of torque and current) is used completely.

        Raises
        ------
        InputError
            A name is unknown, a value is invalid, a required limit is missing, or `sensor_range` is set for a joint
            without a torque sensor.

        Examples
        --------
        >>> limits = MotionLimits.of({"position": (-1.0, 1.0), "velocity": 3.4}, joint)
        """
        if given is None:
            stated: dict[str, Any] = {}
        elif isinstance(given, MotionLimits):
            stated = given.asdict()
        elif isinstance(given, Mapping):
            stated = dict(given)
        else:
            raise InputError(
                "MotionLimits or a mapping of them is expected", argument=_OWNER, value=given
            )
        known = [item.name for item in fields(cls)]
        for name in stated:
            if name not in known:
                raise InputError(
                    f"there is no such limit; {suggestion(name, known)}",
                    argument=str(name),
                    place=_OWNER,
                )
        own = {name: value for name, value in _own(joint).items() if value is not None}
        limits = own | {name: value for name, value in stated.items() if value is not None}
        missing = [name for name in ("position", "velocity", "torque") if name not in limits]
        if missing:
            first, *others = missing
            also = f"{' and '.join(others)} {'is' if len(others) == 1 else 'are'} needed"
            raise InputError(
                "this limit is needed, but the joint does not state it"
                + f"; {also}, too" * bool(others),
                argument=first,
                place=_OWNER,
            )
        made = cls(**limits)
        _within(made, joint)
        if limits.get("sensor_range") is not None and not joint.sensor:
            raise InputError(
                "the joint has no torque sensor",
                argument="sensor_range",
                value=limits["sensor_range"],
                place=_OWNER,
            )
        return made

    def asdict(self) -> dict[str, Any]:
        """Return the limits that have a value, by name."""
        values = {item.name: getattr(self, item.name) for item in fields(self)}
        return {name: value for name, value in values.items() if value is not None}


def _within(limits: MotionLimits, joint: Joint) -> None:
    """Refuse limits beyond the joint's own limits."""
    fastest, window = joint.limits.velocity, joint.limits.position
    if fastest is not None and limits.velocity > fastest:
        raise InputError(
            f"this is above the joint's own limit of {fastest:g}",
            argument="velocity",
            value=limits.velocity,
            place=_OWNER,
        )
    if window is not None and not window[0] <= limits.position[0] < limits.position[1] <= window[1]:
        raise InputError(
            f"this is outside the joint's own window, {window[0]:g} to {window[1]:g}",
            argument="position",
            value=list(limits.position),
            place=_OWNER,
        )


def _own(joint: Joint) -> dict[str, Any]:
    """Return the part of a joint's limits that a motion may use."""
    known = joint.limits
    window = known.position
    if window is not None:
        middle, half = 0.5 * (window[0] + window[1]), 0.5 * OWN_SHARE * (window[1] - window[0])
        window = (middle - half, middle + half)
    return {
        "position": window,
        "velocity": None if known.velocity is None else OWN_SHARE * known.velocity,
        "torque": torque_limit(joint),
    }
