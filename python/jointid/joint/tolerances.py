"""Tolerances of the known facts of a joint."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import fields
from typing import Any

from jointid.base.errors import InputError
from jointid.base.values import dataclass
from jointid.joint.checks import check_mapping, finite_number, suggestion

_PERCENT = r"\s*(?:±|\+-|\+/-)?\s*(\d+(?:\.\d*)?|\.\d+)\s*%\s*"
_EXPECTED = 'a share such as "5 %", or a number in the unit of the fact, is expected'


@dataclass(frozen=True, slots=True, kw_only=True)
class Tolerances:
    """Tolerances of known facts: each ± a relative tolerance as text (``"5 %"``), or ± a number in the fact's unit.

    Parameters
    ----------
    torque_constant : str or float, optional
        Torque constant of the motor [N·m/A]. A drive computes its torque from its current, so it scales the torque
        of any signal. A relative tolerance needs no known torque constant.
    gear_ratio : str or float, optional
        Gear ratio. It scales a torque that is recorded on the motor side, and the reflected inertia of a rotor.
    inertia, rotor_inertia : str or float, optional
        Inertia at the output, and of the rotor on the motor side [kg·m²].
    mass, centre_of_mass, link_inertia : str or float, optional
        Mass [kg], center of mass [m] and inertia [kg·m²] of the link.
    symmetry : str or float, optional
        Largest difference of each direction's Coulomb friction from the mean of both, relative or in its unit.
        It affects a sensor's offset. Default: "10 %".

    Raises
    ------
    InputError
        A tolerance is neither a share below 100 % nor a number, or is negative.

    Examples
    --------
    >>> Tolerances(torque_constant="5 %", mass=0.02).given
    {'torque_constant': '5 %', 'mass': 0.02}
    """

    torque_constant: str | float | None = None
    gear_ratio: str | float | None = None
    inertia: str | float | None = None
    rotor_inertia: str | float | None = None
    mass: str | float | None = None
    centre_of_mass: str | float | None = None
    link_inertia: str | float | None = None
    symmetry: str | float | None = None

    def __post_init__(self) -> None:
        for name, value in self.given.items():
            object.__setattr__(self, name, _checked(name, value))

    @classmethod
    def of(cls, value: object) -> Tolerances:
        """Return tolerances from `Tolerances` or a mapping.

        Raises
        ------
        InputError
            The value has another type, or names a fact without a tolerance.
        """
        if isinstance(value, Tolerances):
            return value
        check_mapping("", "tolerances", value)
        assert isinstance(value, Mapping)
        known = [item.name for item in fields(cls)]
        for name in value:
            if name not in known:
                raise InputError(
                    f"there is no such tolerance; {suggestion(name, known)}",
                    argument=str(name),
                    place="tolerances",
                )
        return cls(**value)

    @property
    def given(self) -> dict[str, Any]:
        """Stated tolerances by name."""
        stated = {item.name: getattr(self, item.name) for item in fields(self)}
        return {name: value for name, value in stated.items() if value is not None}

    def size(self, name: str, value: float | None) -> float | None:
        """Return a fact's tolerance in the fact's unit; None if the tolerance is not stated, or the fact is unknown.

        Parameters
        ----------
        name : str
        value : float or None
            Value of the fact.
        """
        stated = getattr(self, name)
        if stated is None or value is None:
            return None
        return share_of(stated) * abs(value) if isinstance(stated, str) else float(stated)


def share_of(text: str) -> float:
    """Return the share from a text such as "5 %"."""
    found = re.fullmatch(_PERCENT, text)
    assert found is not None  # checked before
    return float(found[1]) / 100.0


def _checked(name: str, value: object) -> str | float:
    """Return a tolerance in its normal form, or refuse it."""
    place = "tolerances"
    if isinstance(value, str):
        if re.fullmatch(_PERCENT, value) is None or share_of(value) >= 1.0:
            raise InputError(_EXPECTED, argument=name, value=value, place=place)
        return f"{100.0 * share_of(value):.15g} %"
    try:
        number = finite_number(place, name, value)
    except InputError:
        raise InputError(_EXPECTED, argument=name, value=value, place=place) from None
    if number < 0.0:
        raise InputError("0 or more is expected", argument=name, value=number, place=place)
    return number
