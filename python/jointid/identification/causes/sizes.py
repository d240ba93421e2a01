"""How large a cause is: the values that it is itself a change of, its size as a text, and its numbers."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from jointid.estimate.delays import Delay
from jointid.estimate.findings import Measured
from jointid.estimate.wording import percent
from jointid.identification.causes.attributed import Attributed
from jointid.identification.causes.candidates import inertia_basis
from jointid.identification.causes.fitted_balance import FILTERED, FittedBalance
from jointid.identification.causes.samples import span_of

_OF = {"ripple": "motor "}


def of_itself(fit: FittedBalance, each: Attributed) -> dict[str, float]:
    """A coefficient that is no constant: half of its range."""
    name, detail = each.candidate.name, each.candidate.detail
    if name == "drift" and detail in fit.names:
        return {detail: float(0.5 * each.coefficients[0] * _span(fit))}
    if name == "inertia_varies" and "inertia" in fit.names:
        return {"inertia": _half_range(fit, each)}
    if name == "asymmetry" and "viscous" in fit.names:
        return {"viscous": float(each.coefficients[0])}
    if name == "wrong_scale":
        return _of_a_scale(fit, off_scale(fit, each))
    return {}


def off_scale(fit: FittedBalance, each: Attributed) -> float:
    """By what share the torque shows a larger inertia than the given one."""
    return float(each.coefficients[0]) / (fit.value("inertia") or 1.0)


def _of_a_scale(fit: FittedBalance, share: float) -> dict[str, float]:
    """A wrong torque scales the friction with it; a wrong inertia does not, and nothing tells which it is."""
    frictions = [fit.names[index] for index in fit.friction if index in fit.free]
    return {name: -share * fit.value(name) for name in frictions}


def _half_range(fit: FittedBalance, each: Attributed) -> float:
    """Half of the range of an inertia that varies, over the angles of the recordings."""
    orders = [float(order) for order in each.candidate.detail.split(" and ")]
    basis = np.hstack([inertia_basis(fit, order) for order in orders])
    return 0.5 * float(np.ptp(basis @ each.coefficients))


def _span(fit: FittedBalance) -> float:
    return max(map(span_of, fit.runs))


def described(
    fit: FittedBalance, each: Attributed, delays: Mapping[str, Delay]
) -> tuple[str, str, dict[str, Measured]]:
    """Detail and size as texts, and their numbers."""
    name, found = each.candidate.name, each.coefficients
    prismatic = fit.kind == "prismatic"
    length, torque = ("m", "N") if prismatic else ("rad", "N·m")
    detail, size = each.candidate.detail, ""
    numbers = {key: Measured(value, length + unit) for key, value, unit in each.candidate.numbers}
    if name in ("gravity", "harmonic", "ripple"):
        amplitude = float(np.hypot(*found))
        size, numbers["amplitude"] = f"{amplitude:.3g} {torque}", Measured(amplitude, torque)
    elif name in ("offset", "disturbance"):
        size, numbers["torque"] = f"{found[0]:.3g} {torque}", Measured(float(found[0]), torque)
    elif name == "delay" and detail != FILTERED:
        late = float(found[0])
        known = delays.get(detail)
        if known is not None and known.certain and known.left:
            late = known.left
        side = "late" if late > 0.0 else "early"
        size, numbers["delay"] = f"{side} by about {1e3 * abs(late):.2g} ms", Measured(late, "s")
    elif name == "load_friction":
        size, numbers["coefficient"] = f"{found[0]:.3g} of the load", Measured(float(found[0]))
    elif name == "drift":
        rate = float(found[0]) / (abs(fit.value(detail)) or 1.0)
        change, minute = rate * _span(fit), 60.0 * rate
        over, rated = f"{100.0 * change:+.3g} %", f"{100.0 * minute:+.3g} % per minute"
        size = f"{over} over the recording, {rated} of its value in the middle"
        numbers |= {"change": Measured(change), "change_a_minute": Measured(minute)}
    elif name == "wrong_scale":
        share = off_scale(fit, each)
        size, numbers["ratio"] = f"{100.0 * share:+.2g} %", Measured(1.0 + share)
    elif name == "inertia_varies":
        range_of_it = _half_range(fit, each) / (abs(fit.value("inertia")) or 1.0)
        size, numbers["range"] = f"±{percent(range_of_it)}", Measured(range_of_it)
    elif each.candidate.unit:
        unit = each.candidate.unit.split("|")[prismatic]
        size, numbers["coefficient"] = f"{found[0]:.3g} {unit}", Measured(float(found[0]), unit)
    if name in ("harmonic", "ripple", "inertia_varies"):
        orders = detail.split(" and ")
        detail = " and ".join(f"{order} × {_OF.get(name, '')}angle" for order in orders)
        numbers |= {f"order_{order}": Measured(float(order)) for order in orders}
    for unit in ("@/s", "@"):
        detail = detail.replace(unit, unit.replace("@", length))
    return detail, size, numbers
