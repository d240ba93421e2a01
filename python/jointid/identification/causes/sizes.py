"""Size of a cause as text and numbers, and the parameters that it changes directly."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import field
from typing import TYPE_CHECKING

import numpy as np

from jointid.base.values import dataclass
from jointid.estimate.delays import Delay
from jointid.estimate.findings import Measured
from jointid.estimate.wording import percent
from jointid.identification.causes.candidates import inertia_basis
from jointid.identification.causes.fitted_balance import FILTERED, FittedBalance

if TYPE_CHECKING:
    from jointid.identification.causes.attributed import Attributed


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Size:
    """Size of a cause as text and numbers; `detail` replaces the candidate's detail if that is not a text."""

    text: str = ""
    numbers: Mapping[str, Measured] = field(default_factory=dict)
    detail: str = ""


def by_unit(fit: FittedBalance, cause: Attributed, _: Mapping[str, Delay]) -> Size:
    """Return the coefficient of a candidate that has a unit."""
    if not cause.candidate.unit:
        return Size()
    unit = cause.candidate.unit.split("|")[fit.kind == "prismatic"]
    value = float(cause.coefficients[0])
    return Size(text=f"{value:.3g} {unit}", numbers={"coefficient": Measured(value, unit)})


def _torque_unit(fit: FittedBalance) -> str:
    """Return the unit of the balance's torque or force."""
    return "N" if fit.kind == "prismatic" else "N·m"


def amplitude(fit: FittedBalance, cause: Attributed, _: Mapping[str, Delay]) -> Size:
    """Return the amplitude of a cosine and a sine together."""
    value, unit = float(np.hypot(*cause.coefficients)), _torque_unit(fit)
    return Size(text=f"{value:.3g} {unit}", numbers={"amplitude": Measured(value, unit)})


def over_angle(angle: str) -> Callable[[FittedBalance, Attributed, Mapping[str, Delay]], Size]:
    """Return a function for the amplitude of a torque over a multiple of an angle."""

    def size(fit: FittedBalance, cause: Attributed, delays: Mapping[str, Delay]) -> Size:
        found, order = amplitude(fit, cause, delays), cause.candidate.detail
        numbers = {**found.numbers, f"order_{order}": Measured(float(order))}
        return Size(text=found.text, numbers=numbers, detail=f"{order} × {angle}")

    return size


def constant(fit: FittedBalance, cause: Attributed, _: Mapping[str, Delay]) -> Size:
    """Return the size of a constant torque."""
    value, unit = float(cause.coefficients[0]), _torque_unit(fit)
    return Size(text=f"{value:.3g} {unit}", numbers={"torque": Measured(value, unit)})


def lateness(_: FittedBalance, cause: Attributed, delays: Mapping[str, Delay]) -> Size:
    """Return the delay of a signal; a direct measurement has priority over the residual."""
    if cause.candidate.detail == FILTERED:
        return Size()
    late = float(cause.coefficients[0])
    known = delays.get(cause.candidate.detail)
    if known is not None and known.certain and known.left:
        late = known.left
    side = "late" if late > 0.0 else "early"
    text = f"{side} by about {1e3 * abs(late):.2g} ms"
    return Size(text=text, numbers={"delay": Measured(late, "s")})


def of_the_load(_: FittedBalance, cause: Attributed, __: Mapping[str, Delay]) -> Size:
    """Return the friction coefficient as a share of the load."""
    value = float(cause.coefficients[0])
    return Size(text=f"{value:.3g} of the load", numbers={"coefficient": Measured(value)})


def drift_of(fit: FittedBalance, cause: Attributed, _: Mapping[str, Delay]) -> Size:
    """Return the change of a coefficient over the recording and per minute."""
    rate = float(cause.coefficients[0]) / (abs(fit.value(cause.candidate.detail)) or 1.0)
    change, minute = rate * fit.duration_of_recording, 60.0 * rate
    over, rated = f"{100.0 * change:+.3g} %", f"{100.0 * minute:+.3g} % per minute"
    return Size(
        text=f"{over} over the recording, {rated} relative to the value in mid-recording",
        numbers={"change": Measured(change), "change_a_minute": Measured(minute)},
    )


def drifts(fit: FittedBalance, cause: Attributed) -> dict[str, float]:
    """Return half the change of the drifting coefficient."""
    detail = cause.candidate.detail
    half = float(0.5 * cause.coefficients[0] * fit.duration_of_recording)
    return {detail: half} if detail in fit.names else {}


def off_scale(fit: FittedBalance, cause: Attributed) -> float:
    """Return the relative difference of the inertia that the torque shows from the fixed one."""
    return float(cause.coefficients[0]) / (fit.value("inertia") or 1.0)


def scale(fit: FittedBalance, cause: Attributed, _: Mapping[str, Delay]) -> Size:
    """Return the relative error of a scale."""
    share = off_scale(fit, cause)
    return Size(text=f"{100.0 * share:+.2g} %", numbers={"ratio": Measured(1.0 + share)})


def scaled(fit: FittedBalance, cause: Attributed) -> dict[str, float]:
    """Return the shifts of friction if the torque's scale is wrong.

    A wrong inertia does not shift friction, but the data do not show which of both is wrong.
    """
    frictions = [fit.names[index] for index in fit.friction if index in fit.free]
    return {name: -off_scale(fit, cause) * fit.value(name) for name in frictions}


def half_range(fit: FittedBalance, cause: Attributed) -> float:
    """Return half the range of a varying inertia over the angles of the recordings."""
    orders = [float(order) for order in cause.candidate.detail.split(" and ")]
    basis = np.hstack([inertia_basis(fit, order) for order in orders])
    return 0.5 * float(np.ptp(basis @ cause.coefficients))


def range_of(fit: FittedBalance, cause: Attributed, _: Mapping[str, Delay]) -> Size:
    """Return half the range of a varying inertia, as a share of the inertia."""
    share = half_range(fit, cause) / (abs(fit.value("inertia")) or 1.0)
    orders = cause.candidate.detail.split(" and ")
    numbers = {"range": Measured(share)} | {f"order_{n}": Measured(float(n)) for n in orders}
    detail = " and ".join(f"{order} × angle" for order in orders)
    return Size(text=f"±{percent(share)}", numbers=numbers, detail=detail)
