"""A fit with every coefficient free and without bounds."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from jointid.balance.covariance import parameter_covariance
from jointid.base.values import dataclass
from jointid.identification.warnings.evidence import Evidence, Regressor

Array = NDArray[np.float64]

EXPLAINED = 0.03  # largest share of the torque that is left if every term is free
_SURE = 10.0  # standard errors
_STRIBECK_SHARES = (0.02, 0.05, 0.1, 0.2, 0.4)  # shares of the peak speed


@dataclass(frozen=True, slots=True, kw_only=True)
class Unbounded:
    """Coefficients with every term free and without bounds, at the found shapes or others."""

    evidence: Evidence
    regressor: Regressor
    best: Array | None
    values: dict[str, float]
    relative: float

    def sure(self, name: str, wanted: float) -> bool:
        """Return whether the data contradict a value by many standard errors; robust to slow drifts of the residual."""
        names, penalty = list(self.values), self.evidence.penalty
        best = self.evidence.best if self.best is None else self.best
        columns = penalty.columns(best[penalty.coefficients :])
        columns = columns[:, [self.regressor.names.index(each) for each in names]]
        missed = columns @ np.array(list(self.values.values())) - np.asarray(penalty.target)
        spread = parameter_covariance(columns, missed, None, threads=self.evidence.problem.threads)
        return bool(abs(self.values[name] - wanted) > _SURE * spread.stderr[names.index(name)])

    def with_noisy_sensor(self) -> dict[str, float] | None:
        """Return coefficients of the reverse regression, of the sensor by all other terms; None without a sensor.

        In `values`, noise of the sensor makes the gain too small and moves a part of the link's inertia to the joint.
        Here, noise of the torque has the opposite effect. The true values are between the two.
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


def without_bounds(evidence: Evidence) -> Unbounded | None:
    """Return the best fit at the estimated shape and some others, because bounds may have distorted the shape."""
    found = _at(evidence, None)
    shapes = [i for i, name in enumerate(evidence.penalty.names) if name == "stribeck"]
    if found is None or not shapes or found.relative < EXPLAINED:
        return found
    for share in _STRIBECK_SHARES:
        other = evidence.best.copy()
        other[shapes] = (share * evidence.problem.peak_speed) ** -2
        tried = _at(evidence, other)
        if tried is not None and tried.relative < found.relative:
            found = tried
    return found


def _at(evidence: Evidence, best: Array | None) -> Unbounded | None:
    regressor = evidence.regressor(best)
    names = [name for name in regressor.names if regressor.norm(name) > 0.0]
    windows = evidence.penalty.window_count
    if windows < 2 * len(names) or regressor.target == 0.0:
        return None
    kept = [regressor.names.index(name) for name in names]
    found, missed = regressor.triangle.solve(kept, len(regressor.names), rcond=1e-10)
    return Unbounded(
        evidence=evidence,
        regressor=regressor,
        best=best,
        values=dict(zip(names, found.tolist(), strict=True)),
        relative=missed / regressor.target,
    )
