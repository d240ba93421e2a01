"""Texts for changes of values, where a share of the value is meaningless or misleading."""

from __future__ import annotations

from collections.abc import Mapping

from jointid.estimate.statistics import ParameterEstimate
from jointid.estimate.wording import signed_percent

_MOST = 10.0  # largest meaningful change, as a multiple of the value


def from_to(
    parameters: Mapping[str, ParameterEstimate],
    shifts: Mapping[str, float],
    shares: Mapping[str, float],
    errors: Mapping[str, float],
    before: bool = False,
) -> dict[str, str]:
    """Return texts for changes of values near zero, such as "from 0 to 0.12 N·m".

    A value is near zero if it is at a bound, smaller than its error, or much smaller than the change.

    Parameters
    ----------
    before : bool
        Whether the values are those after the change. Default False: those before it.
    """
    words = {}
    for name, shift in shifts.items():
        p = parameters[name]
        value = p.shown_value
        small = p.at_bound is not None or abs(value) < errors[name]
        if small or abs(shares.get(name, 0.0)) > _MOST:
            ends = (value - shift, value) if before else (value, value + shift)
            words[name] = f"from {ends[0]:.3g} to {ends[1]:.3g} {p.unit}".rstrip()
    return words


def of_a_scale(
    parameters: Mapping[str, ParameterEstimate],
    shifts: Mapping[str, float],
    share: float,
) -> str:
    """Return the effect of a wrong fixed inertia as a clause: either the inertia is wrong, or the torque.

    Parameters
    ----------
    shifts : mapping of str to float
        Shifts of the values with the inertia that the torque shows.
    share : float
        Relative difference of the inertia that the torque shows from the fixed one.
    """
    inertia = parameters["inertia"]
    shown = (1.0 + share) * inertia.value
    moved = [
        f"{name} by {signed_percent(shift / parameters[name].value)}"
        for name, shift in shifts.items()
        if parameters[name].stderr is not None
        and abs(parameters[name].value) > parameters[name].uncertainty
    ]
    if not moved:
        return f"if the torque is wrong, the friction changes by {signed_percent(-share / (1.0 + share))}"
    text = f"with the inertia that fits the torque ({shown:.3g} {inertia.unit})"
    text += f", {', '.join(moved).replace(' by ', ' changes by ', 1)}"
    # A wrong factor of the torque scales all other values by it.
    scale = f"; if the torque is wrong instead, the friction changes by {signed_percent(-share / (1.0 + share))}"
    return text + (scale if shown > 0.0 else "")
