"""From an estimate to the motion to record next: what it tells of its joint, and the noise that it has seen."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from jointid import _core
from jointid.base.argument_checks import require_kind
from jointid.base.errors import InputError
from jointid.design.known import Known, Told
from jointid.design.next_motion import motion_after
from jointid.estimate.intervals import NORMAL, half_widths
from jointid.estimate.unseen import unseen_friction
from jointid.joint.joint import Joint
from jointid.joint.parameters import Parameter
from jointid.problem.constant_torque import undivided

if TYPE_CHECKING:
    from jointid.design.design import Design
    from jointid.design.motion_limits import MotionLimits
    from jointid.estimate.estimate import Estimate

Array = NDArray[np.float64]

_SIGNED = ("offset", "gravity", "ripple", "position")


def next_motion_of(
    estimate: Estimate,
    limits: MotionLimits | Mapping[str, Any] | None,
    duration: float,
    *,
    joint: Joint | None = None,
    **options: Any,
) -> Design:
    """Answer `Estimate.next_motion`."""
    told = told_by(estimate)
    if not told.names:
        raise InputError(
            "the estimate has no free parameter that a motion could tell more of",
            argument="parameters",
        )
    if options.get("sensors") is None:
        options["sensors"] = sensors_of(estimate)
    return motion_after(joint_of(estimate, told, joint), told, limits, duration, **options)


def told_by(estimate: Estimate) -> Told:
    """Return what an estimate tells of the parameters that another motion can tell more of.

    It is as uncertain as the intervals: by chance and by what the recordings show besides. An offset
    that no motion divides from the friction of the two directions is taken as it is, and so is what a bound holds,
    but for friction at low speed that was not seen: it is looked for.
    """
    assumed, held = unseen_friction(estimate)
    held |= {each.offset for each in undivided(estimate.free)}
    # A recording's own parameter, "coulomb[0]", will not be that of the next one.
    own = {name for name in estimate.free if "[" in name}
    names = tuple(
        name for name in estimate.parameters if name in {*estimate.free, *assumed} - held - own
    )
    table = estimate.joint.parameters
    values = {name: estimate.parameters[name].value for name in names} | assumed
    friction = float(np.max(np.abs(estimate.windows.friction), initial=0.0))
    return Told(
        known=Known(names=names, information=_information(estimate, names, held, {*assumed, *own})),
        values=np.array([values[name] for name in names]),
        bounds={name: (table[name].min, table[name].max) for name in names if name in table},
        scale={name: friction for name in names if any(part in name for part in _SIGNED)},
    )


def _information(
    estimate: Estimate, names: tuple[str, ...], held: set[str], unknown: set[str]
) -> Array:
    """Information of these parameters, as wide as their intervals: at what is held, whatever the unknown ones are."""
    wider = half_widths(estimate) / NORMAL
    whole = _of_chance(estimate) / np.outer(wider, wider)
    free = estimate.free
    kept = [free.index(name) for name in names if name in free and name not in unknown]
    lost = [free.index(name) for name in free if name in unknown and name not in held]
    told = whole[np.ix_(kept, kept)]
    if lost:
        across = whole[np.ix_(kept, lost)]
        told = told - across @ np.linalg.pinv(whole[np.ix_(lost, lost)], hermitian=True) @ across.T
    matrix = np.zeros((len(names), len(names)))
    places = [names.index(free[place]) for place in kept]
    matrix[np.ix_(places, places)] = told
    return matrix


def _of_chance(estimate: Estimate) -> Array:
    """The estimate's information; of one that was saved without it, what the finite part of its covariance tells."""
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
    """Return the sensors as the residuals show them: a torque sensor's noise [N·m]; None without a sensor."""
    gain = estimate.parameters.get("sensor_gain")
    found = estimate.residuals
    if gain is None or not found.rms > 0.0:
        return None
    # Of white noise, the mean over a window is less by the root of its samples.
    usable = found.samples * (1.0 - found.left_out)
    period = float(np.sum(estimate.windows.duration)) / max(usable, 1.0)
    noise = found.rms * math.sqrt(max(found.window_duration / period, 1.0))
    if estimate.settings.get("residual") != "torque":
        noise *= abs(gain.value)
    return _core.Sensors(torque_noise=noise)


def joint_of(estimate: Estimate, told: Told, given: Joint | None) -> Joint:
    """Return the joint of a design: the estimate's values, free where another motion can tell more of them.

    Parameters
    ----------
    given : Joint, optional
        With facts that the joint of the identification lacked: a link, limits. Default: none.
    """
    if given is not None:
        require_kind("joint", given, Joint)
    base = estimate.joint if given is None else given
    own = estimate.joint
    if given is not None and (given.kind, given.sensor) != (own.kind, own.sensor):
        raise InputError(
            "it is another joint than the estimate's: kind and sensor must be the same",
            argument="joint",
            value=given,
        )
    table = dict(base.parameters)
    values = dict(zip(told.names, told.values.tolist(), strict=True))
    for name, parameter in own.parameters.items():
        if parameter.value is None:  # of another model
            continue
        known = table.get(name, parameter)
        table[name] = Parameter(
            name=name,
            value=values.get(name, parameter.value),
            min=known.min,
            max=known.max,
            vary=name in told.names,
        )
    return base.replace(parameters=table, model=own.model, torque_offset=own.torque_offset)
