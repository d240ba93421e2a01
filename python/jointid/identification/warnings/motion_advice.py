"""Advice to record other motion, with the call that designs it. Limits come from the joint or the recordings."""

from __future__ import annotations

from typing import Any

import numpy as np

from jointid.base.advice import Action
from jointid.base.errors import InputError
from jointid.identification.warnings.evidence import Evidence
from jointid.joint.joint import Joint
from jointid.recording.order_statistics import quantile, quantile_of_sizes

DESIGNED = "; `jointid design --after` or `jid.design(estimate)` designs such a motion"
"""Text about this advice in the table of findings."""

_SHORTEST, _LONGEST = 6.0, 60.0  # [s]
_GENTLER = 0.9  # of the torque at which the drive's torque was clipped
_PEAK = 0.999  # quantile: a single outlier is neither a speed nor a torque


def other_motion(
    evidence: Evidence,
    text: str,
    *,
    wider: bool = False,
    faster: bool = False,
    gentler: bool = False,
    sensor_range: float | None = None,
) -> Action:
    """Return the advice to record such a motion, with the arguments of `design`.

    Limits that the joint states are omitted, because the design takes them from the joint. For other quantities, the
    motion stays in the recorded range. If it must leave that range, the range is left to the user.

    Parameters
    ----------
    text : str
        Text of the missing motion.
    wider, faster : bool
        Whether the recorded range of positions, or of speeds, is too small. Default False.
    gentler : bool
        Whether less torque than the recorded one is needed. Default False.
    sensor_range : float, optional
        Limit of the torque at the sensor [N·m]. Default: none.
    """
    joint, runs = evidence.joint, [each.recording for each in evidence.inspections]
    stated = (joint or Joint()).limits
    limits: dict[str, Any] = {}
    if stated.position is None:
        low = min(float(run.position.min()) for run in runs)
        high = max(float(run.position.max()) for run in runs)
        limits["position"] = ... if wider else [_short(low), _short(high)]
    if stated.velocity is None:
        peak = max(quantile_of_sizes(run.velocity, _PEAK) for run in runs)
        limits["velocity"] = ... if faster or wider else _short(peak)
    by_current = None not in (stated.current, (joint or Joint()).torque_constant)
    if gentler or not (by_current or stated.torque is not None):
        limits["torque"] = _recorded_torque(evidence, _GENTLER if gentler else 1.0)
    if sensor_range is not None:
        limits["sensor_range"] = _short(sensor_range)
    longest = max(float(run.time[-1] - run.time[0]) for run in runs)
    arguments: dict[str, Any] = {"limits": limits} if limits else {}
    arguments["duration"] = float(round(min(max(longest, _SHORTEST), _LONGEST)))
    if evidence.sensor_parameters and (joint is None or joint.link is None):
        arguments["joint"] = ...  # the load of the sensor
    return Action("record", arguments, text, "next_motion")


def _recorded_torque(evidence: Evidence, share: float) -> Any:
    """Return a share of the largest recorded torque at the output; ``...`` if only the user knows it."""
    joint = evidence.joint or Joint()
    try:
        torques = [np.abs(joint.output_torque(each.recording)) for each in evidence.inspections]
    except InputError:
        return ...
    return _short(share * max(quantile(torque, _PEAK) for torque in torques))


def _short(value: float) -> float:
    """Return three digits, rounded towards zero, so that rounding does not widen a limit."""
    rounded = float(f"{value:.2e}")
    if abs(rounded) <= abs(value):
        return rounded
    step = 10.0 ** (np.floor(np.log10(abs(value))) - 2.0)
    return float(f"{np.trunc(value / step) * step:.2e}")
