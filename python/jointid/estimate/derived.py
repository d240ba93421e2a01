"""Quantities that follow from the parameters: breakaway friction and Stribeck velocity, with standard errors."""

from __future__ import annotations

import math
import re
from collections.abc import Iterator, Mapping

import numpy as np
from numpy.typing import NDArray

from jointid.base.values import dataclass
from jointid.estimate.intervals import BESIDE, quantile_of, squared_half_widths
from jointid.estimate.record import EstimateRecord
from jointid.problem.constant_torque import undivided

Array = NDArray[np.float64]

_FLAT = 1e-10  # share of the largest information that counts as zero


@dataclass(frozen=True, slots=True, kw_only=True)
class DerivedValue:
    """A quantity that follows from the parameters.

    Attributes
    ----------
    name : str
        "breakaway", "stribeck_velocity", "coulomb_sum" or "constant", with the parameters' suffix for direction or
        recording. A name such as "coulomb_and_viscous" is the sum of two parameters that the recording cannot separate.
    meaning : str
    unit : str
    value : float
    stderr : float or None
        Standard error by the delta method, with correlations. None if a parameter ended on a bound or is
        undetermined, or if all are fixed.
    interval : tuple of float or None
        95 % interval, with the parameters' correlations and the same parts as their intervals.
    formula : str
        Formula, e.g. "coulomb + static".
    systematic_total : float
        Systematic part of the interval from the parameters' systematic parts, with correlations, as one standard
        error. Default 0.
    largest_part : str or None
        Name of the largest systematic part; None (default) without one.
    """

    name: str
    meaning: str
    unit: str
    value: float
    stderr: float | None
    interval: tuple[float, float] | None
    formula: str
    systematic_total: float = 0.0
    largest_part: str | None = None


def derived_values(estimate: EstimateRecord) -> dict[str, DerivedValue]:
    """Return breakaway friction, Stribeck velocity, and the sums for an offset that cannot be separated, if present."""
    values = (
        *_breakaway(estimate),
        *_constants(estimate),
        *_stribeck_velocity(estimate),
        *sums_of_splits(estimate),
    )
    return {each.name: each for each in values}


def _breakaway(estimate: EstimateRecord) -> Iterator[DerivedValue]:
    """Yield the breakaway friction at rest: Coulomb friction plus the static excess."""
    parameters = estimate.parameters
    for direction in ("", "_positive", "_negative"):
        pair = (f"coulomb{direction}", f"static{direction}")
        own = re.compile(rf"(?:coulomb|static){direction}(\[\d+\])")
        runs = [found[1] for name in parameters if (found := own.fullmatch(name))]
        for run in dict.fromkeys(runs) or ("",):
            names = [name + run if name + run in parameters else name for name in pair]
            if all(name in parameters for name in names):
                yield _derived(
                    estimate,
                    name=f"breakaway{direction}{run}",
                    meaning="friction to overcome at rest",
                    unit=parameters[names[0]].unit,
                    value=sum(parameters[name].value for name in names),
                    slopes=dict.fromkeys(names, 1.0),
                    formula=" + ".join(names),
                )


def _constants(estimate: EstimateRecord) -> Iterator[DerivedValue]:
    """Yield the determined sums if a recording cannot separate an offset from the difference of Coulomb frictions."""
    found = estimate.parameters
    sides = ("coulomb_positive", "coulomb_negative")
    if not all(name in found for name in sides):
        return
    unit = found[sides[0]].unit
    yield _derived(
        estimate,
        name="coulomb_sum",
        meaning="Coulomb friction of both directions",
        unit=unit,
        value=sum(found[name].value for name in sides),
        slopes=dict.fromkeys(sides, 1.0),
        formula=" + ".join(sides),
    )
    offsets = [n for n in found if n.partition("[")[0] in ("torque_offset", "sensor_offset")]
    for offset in offsets:
        run = offset[len(offset.partition("[")[0]) :]
        for name, sign in zip(sides, (1.0, -1.0), strict=True):
            yield _derived(
                estimate,
                name=f"constant_{name.removeprefix('coulomb_')}{run}",
                meaning="sum of friction and offset at low speed, "
                + name.removeprefix("coulomb_")
                + " velocity",
                unit=unit,
                value=found[name].value + sign * found[offset].value,
                slopes={name: 1.0, offset: sign},
                formula=f"{name} {'+' if sign > 0 else '-'} {offset}",
            )


def sums_of_splits(estimate: EstimateRecord) -> Iterator[DerivedValue]:
    """Yield the sum of two coefficients, in the recorded motion, if the recording cannot separate them.

    The weight of the second makes the sum most accurate: a speed for viscous friction, 1 for an offset.
    """
    found = estimate.parameters
    for finding in estimate.findings:
        pairs = [key.split(".") for key in finding.evidence if key.endswith(".correlation")]
        for first, second, _ in (pair for pair in pairs if finding.code == "undetermined"):
            names = sorted((first, second), key=lambda name: not name.startswith("coulomb"))
            if not all(_is_force(estimate, name) for name in names):
                continue
            one, other = names
            matrix = _pair(estimate, one, other)
            if matrix is None or not matrix[1, 1] > 0.0:
                continue
            factor = -float(matrix[0, 1] / matrix[1, 1])
            error = math.sqrt(max(matrix[0, 0] + factor * matrix[0, 1], 0.0))
            value, half = (
                found[one].value + factor * found[other].value,
                quantile_of(estimate) * error,
            )
            times = "" if abs(abs(factor) - 1.0) < 5e-4 else f"{abs(factor):.4g} · "
            yield DerivedValue(
                name=f"{one}_and_{other}",
                meaning=f"combined value of {one} and {other}, which the recorded motion cannot separate",
                unit=found[one].unit,
                value=value,
                stderr=error,
                interval=(value - half, value + half),
                formula=f"{one} {'+' if factor > 0.0 else '-'} {times}{other}",
            )


def _is_force(estimate: EstimateRecord, name: str) -> bool:
    base = name.partition("[")[0]
    parts = ("coulomb", "static", "viscous", "load_friction", "torque_offset", "sensor_offset")
    return (
        name in estimate.free and base.removesuffix("_positive").removesuffix("_negative") in parts
    )


def _pair(estimate: EstimateRecord, one: str, other: str) -> Array | None:
    """Return the covariance of two parameters; large instead of infinite along undetermined directions."""
    information = estimate.information
    if information is None:
        return None
    places = [estimate.free.index(name) for name in (one, other)]
    scale = np.sqrt(np.diag(information))
    if not np.all(scale > 0.0):
        return None
    values, vectors = np.linalg.eigh(information / np.outer(scale, scale))
    values = np.maximum(values, _FLAT * values[-1])
    covariance = vectors / values @ vectors.T / np.outer(scale, scale)
    return np.asarray(covariance[np.ix_(places, places)])


def _stribeck_velocity(estimate: EstimateRecord) -> Iterator[DerivedValue]:
    """Yield the speed at which the static excess has decayed to 1/e."""
    shape = estimate.parameters.get("stribeck")
    if shape is not None and shape.value > 0.0:
        yield _derived(
            estimate,
            name="stribeck_velocity",
            meaning="speed at which the static excess has decayed to 1/e",
            unit="m/s" if estimate.settings["kind"] == "prismatic" else "rad/s",
            value=1.0 / math.sqrt(shape.value),
            slopes={"stribeck": _slope(shape.value)},
            formula="1/√stribeck",
        )


def _slope(stribeck: float) -> float:
    """Return the derivative of 1/√stribeck; infinite if it overflows."""
    try:
        return -0.5 * float(stribeck**-1.5)
    except OverflowError:
        return -math.inf


def _derived(
    estimate: EstimateRecord,
    *,
    name: str,
    meaning: str,
    unit: str,
    value: float,
    slopes: Mapping[str, float],
    formula: str,
) -> DerivedValue:
    stderr = _error(estimate, slopes, estimate.covariance)
    half = _error(estimate, slopes, squared_half_widths(estimate))
    interval = None if stderr is None or half is None else (value - half, value + half)
    beside, part = 0.0, None
    if stderr is not None and half is not None:
        part = _largest_part(estimate, slopes)
        if part is not None:
            beside = math.sqrt(max(0.0, (half / quantile_of(estimate)) ** 2 - stderr**2))
    return DerivedValue(
        name=name,
        meaning=meaning,
        unit=unit,
        value=value,
        stderr=stderr,
        interval=interval,
        formula=formula,
        systematic_total=beside,
        largest_part=part if beside > 0.0 else None,
    )


def _largest_part(estimate: EstimateRecord, slopes: Mapping[str, float]) -> str | None:
    sizes: dict[str, float] = {}
    for name, slope in slopes.items():
        for part, size in estimate.parameters[name].systematic.items():
            if part not in BESIDE:
                sizes[part] = sizes.get(part, 0.0) + abs(slope) * size
    largest = max(sizes, key=sizes.__getitem__, default=None)
    return largest if largest is not None and sizes[largest] > 0.0 else None


def _error(estimate: EstimateRecord, slopes: Mapping[str, float], matrix: Array) -> float | None:
    """Return the error of a quantity with these derivatives by the parameters: √(slopes · matrix · slopes)."""
    free = [name for name in slopes if name in estimate.free]
    held = [name for name in slopes if name not in free and estimate.parameters[name].vary]
    if not free or held:
        return None
    places = [estimate.free.index(name) for name in free]
    slope = np.array([slopes[name] for name in free])
    if not np.isfinite(slope).all():
        return None
    covariance = matrix[np.ix_(places, places)]
    for each in undivided(estimate.free):
        if sum(slopes.get(name, 0.0) * sign for name, sign in each.change.items()) != 0.0:
            return None
        if each.offset in free:  # the offset cancels; the others' covariance is for a fixed offset
            covariance[free.index(each.offset), free.index(each.offset)] = 0.0
    variance = float(slope @ covariance @ slope)
    return math.sqrt(max(variance, 0.0)) if math.isfinite(variance) else None
