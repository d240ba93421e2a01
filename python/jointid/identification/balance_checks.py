"""Whether torque, motion and sensor obey one torque balance: reversed signs, wrong scales."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from jointid.estimate.findings import Warned
from jointid.identification.facts import Facts

Array = NDArray[np.float64]

_AGAINST = -0.1  # correlation of torque and velocity: friction makes it positive
_SCALE = 0.05
_SURE = 10.0  # standard errors
_EXPLAINED = 0.03  # what may be left of the torque when every term is free
_DEGREE = np.pi / 180.0
_STRIBECK_SHARES = (0.02, 0.05, 0.1, 0.2, 0.4)  # Stribeck velocities, of the peak speed


@dataclass(frozen=True, slots=True, kw_only=True)
class _Free:
    """Coefficients with every term free and no bounds, at the shapes found."""

    values: dict[str, float]
    errors: dict[str, float]
    relative: float

    def sure(self, name: str, wanted: float) -> bool:
        """Whether the data contradict a value beyond doubt."""
        return abs(self.values[name] - wanted) > _SURE * self.errors[name]


def _unbounded(facts: Facts) -> _Free | None:
    """The best of the shape found and a few others: bounds may have bent the shape, too."""
    found = _unbounded_at(facts, None)
    shapes = [i for i, name in enumerate(facts.penalty.names) if name == "stribeck"]
    if found is None or not shapes or found.relative < _EXPLAINED:
        return found
    for share in _STRIBECK_SHARES:
        other = facts.best.copy()
        other[shapes] = (share * facts.problem.peak_speed) ** -2
        tried = _unbounded_at(facts, other)
        if tried is not None and tried.relative < found.relative:
            found = tried
    return found


def _unbounded_at(facts: Facts, best: Array | None) -> _Free | None:
    regressor = facts.regressor(best)
    names = [name for name in regressor.names if regressor.norm(name) > 0.0]
    windows = facts.penalty.window_count
    if windows < 2 * len(names) or regressor.target == 0.0:
        return None
    kept = [regressor.names.index(name) for name in names]
    found, missed = regressor.triangle.solve(kept, len(regressor.names), rcond=1e-10)
    rows = regressor.triangle.matrix[:, kept]
    scale = np.linalg.norm(rows, axis=0)
    gram = (rows / scale).T @ (rows / scale)
    variance = missed**2 / (windows - len(names))
    errors = np.sqrt(variance * np.abs(np.diag(np.linalg.pinv(gram, hermitian=True))))
    return _Free(
        values=dict(zip(names, found.tolist(), strict=True)),
        errors=dict(zip(names, (errors / scale).tolist(), strict=True)),
        relative=missed / regressor.target,
    )


def _torque_opposes(facts: Facts) -> bool:
    """Whether the drive takes power from the joint, on the whole: friction can only take it from the drive."""
    table = facts.table
    torque = np.asarray(facts.penalty.target) / table.duration
    power = float(np.mean(torque * table.velocity))
    level = float(np.sqrt(np.mean(torque**2) * np.mean(table.velocity**2)))
    return power < _AGAINST * level


def balance(facts: Facts) -> Iterator[Warned]:
    """Signs and scales that the torque balance contradicts."""
    if _torque_opposes(facts):
        yield Warned(
            code="reversed_sign",
            parameters=(),
            message=(
                "the torque works against the motion on the whole, which no joint with friction does: torque or "
                "position has the wrong sign; turn one of the two round (for a motor-side torque, negate gear_ratio)"
            ),
        )
        return
    free = _unbounded(facts)
    if free is None:
        return
    yield from _inertia_contradicts(facts, free)
    yield from _sensor_reversed(facts, free)


def _inertia_contradicts(facts: Facts, free: _Free) -> Iterator[Warned]:
    """A known inertia is a scale: the recording must agree with it."""
    given = facts.parameters.get("inertia")
    if given is None or given.vary or given.value == 0.0 or "inertia" not in free.values:
        return
    if free.relative > _EXPLAINED:
        return  # something else is wrong, and the inertia takes the blame
    ratio = free.values["inertia"] / given.value
    if abs(ratio - 1.0) < _SCALE or not free.sure("inertia", given.value):
        return
    told = (
        f"by itself the recording says inertia {free.values['inertia']:.4g} {given.unit}, {ratio:.3g} times the "
        f"{given.value:.4g} given"
    )
    for factor, which in ((_DEGREE, "position or velocity"), (1.0 / _DEGREE, "torque")):
        if which == "position or velocity" and 0.8 < ratio / factor < 1.25:
            yield Warned(
                code="implausible_units",
                parameters=("inertia",),
                message=(
                    f"{told}, which is what degrees taken for radians make of it: load with "
                    "units={'position': 'deg', 'velocity': 'deg/s'}"
                ),
            )
            return
    gear = abs(facts.joint.gear_ratio) if facts.joint is not None else 1.0
    hint = ""
    if gear > 1.0:
        for factor, words in ((gear, "multiplied"), (1.0 / gear, "divided")):
            if 0.8 < ratio / factor < 1.25:
                hint = f" (the torque seems {words} by the gear ratio once too often)"
    yield Warned(
        code="wrong_scale",
        parameters=("inertia",),
        message=(
            f"{told}{hint}: gear ratio, torque constant, unit of the torque or the joint's inertia is wrong, and every "
            "value in N·m with it; correct it, or free the inertia with parameters={'inertia': {'vary': True}}"
        ),
    )


def _sensor_reversed(facts: Facts, free: _Free) -> Iterator[Warned]:
    gain = facts.parameters.get("sensor_gain")
    if gain is None or gain.min < 0.0 or "sensor_gain" not in free.values:
        return
    if free.values["sensor_gain"] < 0.0 and free.sure("sensor_gain", 0.0):
        yield Warned(
            code="reversed_sign",
            parameters=("sensor_gain",),
            message=(
                "the sensor falls where the link's torque rises: its sign is reversed; turn the column round, or let "
                "sensor_gain be negative"
            ),
        )
