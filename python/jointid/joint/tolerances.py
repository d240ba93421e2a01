"""How well the given facts of a joint are known."""

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
    """How far given facts may be off: each ± a share, as text (``"5 %"``), or ± a number in the fact's own unit.

    Parameters
    ----------
    torque_constant : str or float, optional
        Torque constant of the motor [N·m/A]. A drive computes its torque from its current, so it scales the torque
        of any signal. A relative tolerance needs no known torque constant.
    gear_ratio : str or float, optional
        It scales a torque that is recorded on the motor side, and the reflected inertia of a rotor.
    inertia, rotor_inertia : str or float, optional
        [kg·m²]
    mass, centre_of_mass, link_inertia : str or float, optional
        Mass [kg], center of mass [m] and inertia [kg·m²] of the link.
    symmetry : str or float, optional
        How far the Coulomb friction of each direction may be off the mean of both, as a share of it or in its unit:
        a sensor's offset takes that up. Default, where none is stated: "10 %".

    Raises
    ------
    InputError
        Neither a share below 100 % nor a number, or a negative one.

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
        """Return tolerances from tolerances or a mapping.

        Raises
        ------
        InputError
            Something else, or a fact that has no tolerance.
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
        """Those that are stated, by name."""
        stated = {item.name: getattr(self, item.name) for item in fields(self)}
        return {name: value for name, value in stated.items() if value is not None}

    def size(self, name: str, value: float | None) -> float | None:
        """Return a fact's tolerance in its own unit; None where it is not stated, or the fact is not known.

        Parameters
        ----------
        name : str
        value : float or None
            The fact.
        """
        stated = getattr(self, name)
        if stated is None or value is None:
            return None
        return share_of(stated) * abs(value) if isinstance(stated, str) else float(stated)


def share_of(text: str) -> float:
    """Return the share that a text such as "5 %" states."""
    found = re.fullmatch(_PERCENT, text)
    assert found is not None  # checked before
    return float(found[1]) / 100.0


def _checked(name: str, value: object) -> str | float:
    """Return a tolerance in its usual form, or refuse it."""
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
