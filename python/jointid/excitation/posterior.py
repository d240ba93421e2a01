"""Knowledge about an estimate's joint: information, possible joints, the sensor's noise."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from jointid import _core
from jointid.base.argument_checks import require_kind
from jointid.base.errors import InputError
from jointid.estimate.estimate import Estimate
from jointid.estimate.intervals import NORMAL, half_widths
from jointid.excitation.information import Known
from jointid.excitation.unseen import unseen_friction
from jointid.joint.joint import Joint
from jointid.joint.own_terms import INERTIA
from jointid.joint.parameters import Parameter
from jointid.problem.constant_torque import undivided

Array = NDArray[np.float64]

_FACTOR = 3.0  # ratio of the farthest drawn joint to the value, if no bound is nearer
_WIDEST = 0.5  # share of the value: largest standard deviation for drawing
_MEDIAN = 0.6745  # median of the magnitude of normal noise, in standard deviations
_SIGNED = ("offset", "gravity", "ripple", "position")


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Posterior:
    """Knowledge about a joint's parameters."""

    known: Known  # information that corresponds to the width of the intervals
    values: Array
    # The user's bounds by name; None without bounds.
    bounds: Mapping[str, tuple[float | None, float | None]] = field(default_factory=dict)
    # Size of a parameter of either sign, e.g. the torque for an offset.
    scale: Mapping[str, float] = field(default_factory=dict)

    @property
    def names(self) -> tuple[str, ...]:
        """Names of the free parameters."""
        return self.known.names

    def joints(self, count: int, seed: int = 0) -> tuple[dict[str, float], ...]:
        """Return values of joints that are possible after the recordings. The first are the estimate's values.

        A joint is drawn from the joint distribution of all parameters. If it would leave a bound, it is moved
        toward the estimate.
        """
        width, lower, upper = self._box()
        strength, vectors = np.linalg.eigh(self.known.information * np.outer(width, width))
        # An undetermined parameter is drawn as a badly determined one: ten times the estimate is another joint.
        lengths = 1.0 / np.sqrt(np.maximum(strength, 1.0))
        drawn = np.random.default_rng(seed).standard_normal((max(count - 1, 0), len(self.names)))
        found = [dict(zip(self.names, self.values.tolist(), strict=True))]
        for each in drawn:
            step = width * (vectors @ (lengths * each))
            room = np.where(step > 0.0, upper - self.values, self.values - lower)
            share = float(np.min(np.where(step == 0.0, 1.0, room / np.maximum(abs(step), 1e-300))))
            inside = np.clip(self.values + min(share, 1.0) * step, lower, upper)
            found.append(dict(zip(self.names, inside.tolist(), strict=True)))
        return tuple(found)

    def _box(self) -> tuple[Array, Array, Array]:
        """Return the largest standard deviation for drawing, and the bounds of the drawn values."""
        scale = np.array([self.scale.get(name, 0.0) for name in self.names])
        size = np.maximum(np.abs(self.values), scale)
        size = np.where(size > 0.0, size, 1.0)
        lower = np.where(scale > 0.0, self.values - _FACTOR * size, self.values / _FACTOR)
        upper = np.where(scale > 0.0, self.values + _FACTOR * size, self.values * _FACTOR)
        lower, upper = np.minimum(lower, upper), np.maximum(lower, upper)
        for i, name in enumerate(self.names):
            low, high = self.bounds.get(name, (None, None))
            if low is not None:
                lower[i] = min(max(lower[i], low), self.values[i])
            if high is not None:
                upper[i] = max(min(upper[i], high), self.values[i])
        return _WIDEST * size, lower, upper


def posterior_of(estimate: Estimate) -> Posterior:
    """Return the knowledge about the parameters that another motion can improve, with the intervals' uncertainty.

    An offset that no motion separates from the friction of the two directions is fixed. A value at its bound
    is fixed too, except unseen friction at low speed, which the next motion must show.
    """
    assumed, fixed = unseen_friction(estimate)
    fixed |= {each.offset for each in undivided(estimate.free)}
    # A recording's own parameter, such as "coulomb[0]", is not valid for the next recording.
    own = {name for name in estimate.free if "[" in name}
    own |= {key for term in estimate.joint.model.resolved.terms.each for key in term.keys}
    names = tuple(
        name for name in estimate.parameters if name in {*estimate.free, *assumed} - fixed - own
    )
    table = estimate.joint.parameters
    values = {name: estimate.parameters[name].value for name in names} | assumed
    if "inertia" in values:
        values["inertia"] += _own_inertia(estimate)
    friction = float(np.max(np.abs(estimate.windows.friction), initial=0.0))
    return Posterior(
        known=Known(
            names=names, information=_information(estimate, names, fixed, {*assumed, *own})
        ),
        values=np.array([values[name] for name in names]),
        bounds={name: (table[name].min, table[name].max) for name in names if name in table},
        scale={name: friction for name in names if any(part in name for part in _SIGNED)},
    )


def _own_inertia(estimate: Estimate) -> float:
    """Return the mean inertia of the own terms [kg·m² or kg]. A design does not have their signals."""
    terms = estimate.joint.model.resolved.terms.each
    means = estimate.settings.get("mean_inertia", {})
    return sum(
        estimate.parameters[key].value * float(means.get(term.signal, 0.0))
        for term in terms
        if term.kind in INERTIA
        for key in term.keys
    )


def _information(
    estimate: Estimate, names: tuple[str, ...], fixed: set[str], unknown: set[str]
) -> Array:
    """Return the information of these parameters, as wide as their intervals, for any value of the unknown ones."""
    wider = half_widths(estimate, without="symmetry") / NORMAL  # no motion reduces this part
    whole = _of_chance(estimate) / np.outer(wider, wider)
    free = estimate.free
    kept = [free.index(name) for name in names if name in free and name not in unknown]
    lost = [free.index(name) for name in free if name in unknown and name not in fixed]
    left = whole[np.ix_(kept, kept)]
    if lost:
        across = whole[np.ix_(kept, lost)]
        left = left - across @ np.linalg.pinv(whole[np.ix_(lost, lost)], hermitian=True) @ across.T
    matrix = np.zeros((len(names), len(names)))
    places = [names.index(free[place]) for place in kept]
    matrix[np.ix_(places, places)] = left
    return matrix


def _of_chance(estimate: Estimate) -> Array:
    """Return the estimate's information. If it was saved without it, use the finite part of its covariance."""
    if estimate.information is not None:
        return estimate.information
    finite = np.flatnonzero(np.isfinite(np.diag(estimate.covariance)))
    matrix = np.zeros_like(estimate.covariance)
    block = estimate.covariance[np.ix_(finite, finite)]
    scale = np.sqrt(np.maximum(np.diag(block), 1e-80))
    inverse = np.linalg.pinv(block / np.outer(scale, scale), rcond=1e-10, hermitian=True)
    matrix[np.ix_(finite, finite)] = inverse / np.outer(scale, scale)
    return matrix


def sensors_of(estimate: Estimate) -> _core.Sensors | None:
    """Return the sensors that the residuals indicate: a torque sensor's noise [N·m]; None without a sensor."""
    gain, windows = estimate.parameters.get("sensor_gain"), estimate.windows
    usable = estimate.residuals.samples * (1.0 - estimate.residuals.left_out)
    if gain is None or usable < 1.0:
        return None
    # White noise grows with the root of time. The median excludes the peaks at reversals.
    period = float(np.sum(windows.duration)) / usable
    shares = np.abs(windows.residual) / np.sqrt(windows.duration * period)
    noise = float(np.median(shares)) / _MEDIAN
    if estimate.settings.get("residual") != "torque":
        noise *= abs(gain.value)
    return _core.Sensors(torque_noise=noise) if noise > 0.0 else None


def joint_of(estimate: Estimate, posterior: Posterior, facts: Joint | None) -> Joint:
    """Return the joint of a design: the estimate's values, free if another motion can improve them.

    `facts` is a joint with data that the identified joint lacks: a link, limits.
    """
    if facts is not None:
        require_kind("joint", facts, Joint)
    base = estimate.joint if facts is None else facts
    own = estimate.joint
    if facts is not None and (facts.kind, facts.sensor) != (own.kind, own.sensor):
        raise InputError(
            "kind and sensor must be the same as in the joint of the estimate",
            argument="joint",
        )
    table = dict(base.parameters)
    values = dict(zip(posterior.names, posterior.values.tolist(), strict=True))
    for name, parameter in own.parameters.items():
        if parameter.value is None:  # a parameter of another model
            continue
        known = table.get(name, parameter)
        table[name] = Parameter(
            name=name,
            value=values.get(name, parameter.value),
            min=known.min,
            max=known.max,
            vary=name in posterior.names,
        )
    for term in own.model.resolved.terms.each:
        for key in term.keys:
            table.pop(key, None)
    # Own torques are omitted and own inertias are part of the inertia, because their signals are not simulated.
    model = own.model.replace(terms={}) if own.model.resolved.terms else own.model
    return base.replace(parameters=table, model=model, torque_offset=own.torque_offset)
