"""Whether torque, motion and sensor obey one torque balance: reversed signs, wrong scales."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from jointid.estimate.statistics import Warned
from jointid.identification.inference.covariance import parameter_covariance
from jointid.identification.warnings.evidence import Facts, Regressor
from jointid.identification.warnings.units import degrees_advice

Array = NDArray[np.float64]

_AGAINST = -0.1  # correlation of torque and velocity: friction makes it positive
_SCALE = 0.05
_SURE = 10.0  # standard errors
_HIDDEN = 0.5  # of the gain: noise leaves no more of it, and the link's inertia goes to the joint
_GROSS = 1.5  # factor of an inertia that is wrong even then
_EXPLAINED = 0.03  # what may be left of the torque when every term is free
_DEGREE = np.pi / 180.0
_STRIBECK_SHARES = (0.02, 0.05, 0.1, 0.2, 0.4)  # Stribeck velocities, of the peak speed


@dataclass(frozen=True, slots=True, kw_only=True)
class _Free:
    """Coefficients with every term free and no bounds, at the shapes found or others."""

    facts: Facts
    regressor: Regressor
    best: Array | None
    values: dict[str, float]
    relative: float

    def sure(self, name: str, wanted: float) -> bool:
        """Whether the data contradict a value beyond doubt, slow drifts of the residual allowed for."""
        names, penalty = list(self.values), self.facts.penalty
        best = self.facts.best if self.best is None else self.best
        columns = penalty.columns(best[penalty.coefficients :])
        columns = columns[:, [self.regressor.names.index(each) for each in names]]
        missed = columns @ np.array(list(self.values.values())) - np.asarray(penalty.target)
        spread = parameter_covariance(columns, missed, None, threads=self.facts.problem.threads)
        return bool(abs(self.values[name] - wanted) > _SURE * spread.stderr[names.index(name)])

    def with_noisy_sensor(self) -> dict[str, float] | None:
        """The coefficients that explain the sensor by all else; None without one, or when nothing does.

        Noise of the sensor makes the gain too small in `values`, and leaves part of the link's inertia to
        the joint's; noise of the torque does the opposite here. The truth lies between.
        """
        if "sensor_gain" not in self.values:
            return None
        names = self.regressor.names
        others = [names.index(name) for name in self.values if name != "sensor_gain"]
        torque = len(names)
        found, _ = self.regressor.triangle.solve(
            [*others, torque], names.index("sensor_gain"), rcond=1e-10
        )
        if found[-1] == 0.0:
            return None
        by_torque = {
            names[i]: -float(x) / float(found[-1]) for i, x in zip(others, found, strict=False)
        }
        return by_torque | {"sensor_gain": 1.0 / float(found[-1])}


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
    return _Free(
        facts=facts,
        regressor=regressor,
        best=best,
        values=dict(zip(names, found.tolist(), strict=True)),
        relative=missed / regressor.target,
    )


def _torque_opposes(facts: Facts) -> bool:
    """Whether the drive takes power from the joint, on the whole: friction can only take it from the drive."""
    table = facts.table
    torque = np.asarray(facts.penalty.target) / table.duration
    power = float(np.mean(torque * table.velocity))
    level = float(np.sqrt(np.mean(torque**2) * np.mean(table.velocity**2)))
    return power < _AGAINST * level


def torque_balance(facts: Facts) -> Iterator[Warned]:
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


def _inertia_ratio(free: _Free, given: float) -> float | None:
    """How many times the given inertia the recording shows, wherever the noise is; None if that fits."""
    ratios = [free.values["inertia"] / given]
    reverse = free.with_noisy_sensor()
    if reverse is not None:
        ratios.append(reverse["inertia"] / given)
        hidden = 1.0 - free.values["sensor_gain"] / reverse["sensor_gain"] > _HIDDEN
        if hidden and 1.0 / _GROSS < ratios[0] < _GROSS:
            return None
    if min(ratios) < 1.0 < max(ratios):
        return None
    nearest = min(ratios, key=lambda ratio: abs(ratio - 1.0))
    return nearest if abs(nearest - 1.0) >= _SCALE else None


def _inertia_contradicts(facts: Facts, free: _Free) -> Iterator[Warned]:
    """A known inertia is a scale: the recording must agree with it."""
    given = facts.parameters.get("inertia")
    if given is None or given.vary or given.value == 0.0 or "inertia" not in free.values:
        return
    if free.relative > _EXPLAINED:
        return  # something else is wrong, and the inertia takes the blame
    ratio = _inertia_ratio(free, given.value)
    if ratio is None or not free.sure("inertia", given.value):
        return
    told = (
        f"by itself the recording says inertia {ratio * given.value:.4g} {given.unit}, {ratio:.3g} times the "
        f"{given.value:.4g} given"
    )
    for factor, which in ((_DEGREE, "position or velocity"), (1.0 / _DEGREE, "torque")):
        if which == "position or velocity" and 0.8 < ratio / factor < 1.25:
            yield Warned(
                code="implausible_units",
                parameters=("inertia",),
                message=(
                    f"{told}, which is what degrees taken for radians make of it: "
                    f"{degrees_advice(facts.recordings[0], ('position', 'velocity'))}"
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
