"""Changes of values in words, where a share of the value says nothing or says the wrong thing."""

from __future__ import annotations

from collections.abc import Mapping

from jointid.estimate.statistics import ParameterEstimate
from jointid.estimate.wording import signed_percent

_MOST = 10.0  # of a value: a larger share is no size


def from_to(
    parameters: Mapping[str, ParameterEstimate],
    shifts: Mapping[str, float],
    shares: Mapping[str, float],
    errors: Mapping[str, float],
    before: bool = False,
) -> dict[str, str]:
    """Return the words of changes of values near zero: "from 0 to 0.12 N·m".

    A value is near zero if it is at a bound or less than its error, or if the change is many times the value.

    Parameters
    ----------
    before : bool
        Whether the values are those after the change. Default: those before it.
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
    """Return what a given inertia that does not fit does, as sentence parts: it is wrong, or the torque is.

    Parameters
    ----------
    shifts : mapping of str to float
        Shifts of the values, with the inertia from the torque.
    share : float
        By which the torque shows a larger inertia.
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
    text = f"with the {shown:.3g} {inertia.unit} that the torque shows instead"
    text += f", {', '.join(moved).replace(' by ', ' changes by ', 1)}"
    # A torque that is wrong by a factor has everything else wrong by it.
    scale = f"; if the torque is wrong instead, the friction changes by {signed_percent(-share / (1.0 + share))}"
    return text + (scale if shown > 0.0 else "")
