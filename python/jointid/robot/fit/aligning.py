"""Torques moved to the positions' clock before a robot is identified, and the findings about it."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from jointid.base.advice import Action
from jointid.estimate.findings import Finding, Measured
from jointid.estimate.wording import rounded, two_digits
from jointid.recording.wide.robot_recording import RobotRecording
from jointid.robot.fit.attempt import Attempt, Request, attempted
from jointid.robot.fit.delays import LONGEST, TorqueDelay, coarse_delay, torque_delay
from jointid.robot.fit.gravity import found_gravity
from jointid.robot.fit.lags import TorqueLag, torque_lag_of
from jointid.robot.links.robot import Robot
from jointid.robot.motion.shifts import requested_delay, shift_option, torque_lag
from jointid.robot.result.finding_types import TYPES

Array = NDArray[np.float64]

_TURNS = 3
_SMALL = 2e-4  # [s]: a smaller remainder needs no further identification
# [s]: smaller, because the delay of a held command is determined more sharply
_SMALL_OF_COMMAND = 2e-5
_LEVEL = 1e-4  # [rad]
_NORMAL = 1.96  # standard errors of a 95 % interval
_HALF = 0.2  # of a sample period: a torque early by half a period, within this, is probably held


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Alignment:
    """An identification on one clock."""

    attempt: Attempt
    left: TorqueDelay  # delay that is left after the removal
    chosen: bool  # True if the removed delay was found, not stated
    request: Request  # with the filters of the torques
    lag: TorqueLag | None = None  # filters that were found instead of a delay


def aligned(
    recordings: Sequence[RobotRecording], robot: Robot, request: Request, shift: object
) -> Alignment:
    """Return the identification without the torque's delay, and the delay that is left.

    If the call states no `shift`, the delays that are certain are removed.
    """
    delay = requested_delay(shift, robot)
    free = delay is None
    delay = np.zeros(robot.n) if delay is None else delay
    if isinstance(shift, Mapping):
        request = replace(request, lag=torque_lag(shift, robot))
    attempt = attempted(recordings, robot, request, delay)
    attempt = _levelled(recordings, robot, request, attempt)
    robot = replace(robot, tree=attempt.robot.tree)
    if free and robot.drive is not None:
        delay = np.full(robot.n, coarse_delay(attempt.balance, attempt.fit, attempt.excerpts))
        attempt = attempted(recordings, robot, request, delay)
    first = attempt
    left = torque_delay(attempt.balance, attempt.fit, attempt.excerpts)
    for _ in range(_TURNS if free else 0):
        step = left.taken if left.certain else _short(delay, left)
        if np.abs(step).max() < (_SMALL if robot.drive is None else _SMALL_OF_COMMAND):
            break
        if np.any(delay + step < -_period(attempt)) or np.abs(delay + step).max() > LONGEST:
            # A torque does not come before its motion: in that case the position is late, or it is coarse.
            break
        delay = delay + step
        attempt = attempted(recordings, robot, request, delay)
        attempt = _levelled(recordings, robot, request, attempt)
        robot = replace(robot, tree=attempt.robot.tree)
        left = torque_delay(attempt.balance, attempt.fit, attempt.excerpts)
    lag = torque_lag_of(first, delay) if free and robot.drive is None and delay.any() else None
    if lag is not None:
        request = replace(request, lag=lag.values)
        attempt = attempted(recordings, robot, request, np.zeros(robot.n))
        left = torque_delay(attempt.balance, attempt.fit, attempt.excerpts)
    return Alignment(attempt=attempt, left=left, chosen=free, request=request, lag=lag)


def _levelled(
    recordings: Sequence[RobotRecording], robot: Robot, request: Request, attempt: Attempt
) -> Attempt:
    """Return the identification with the direction of gravity that is found, if this direction is free."""
    for _ in range(_TURNS if robot.gravity_free else 0):
        found = found_gravity(attempt)
        if found.turn < _LEVEL:
            break
        robot = replace(robot, tree=found.robot.tree)
        attempt = attempted(recordings, robot, request, attempt.delay)
    return attempt


def delay_findings(found: Alignment) -> Iterator[Finding]:
    """Yield findings of the delay that was removed, and of a certain delay that is left."""
    attempt, left = found.attempt, found.left
    if found.lag is not None:
        yield _lag_finding(found.lag, attempt.robot.names)
    if found.chosen and attempt.delay.any():
        yield _delay_finding("delay_removed", attempt.delay, found)
    if left.certain and np.abs(left.taken).max() >= _SMALL and (found.chosen or left.sure):
        yield _delay_finding("signal_lag", np.zeros_like(left.taken), found)


def _lag_finding(lag: TorqueLag, names: Sequence[str]) -> Finding:
    sizes = {
        name: f"{rounded(1e3 * value, 1e3 * error)} ± {two_digits(1e3 * error)} ms"
        for name, value, error in zip(names, lag.values, lag.errors, strict=True)
        if value
    }
    name, size = next(iter(sizes.items()))
    more = f", and {len(sizes) - 1} more joints" if len(sizes) > 1 else ""
    every = ", ".join(f"{each} {text}" for each, text in sizes.items())
    return TYPES["torque_filtered"].finding(
        f"the torque of {name} passed a low-pass filter with a time constant of {size}{more}",
        details=f"first-order filters: {every}; filters explain held-out motion better than a delay; "
        "the effect of the filters was removed before the identification",
        evidence={
            f"{each}.time_constant": Measured(float(value), "s")
            for each, value in zip(names, lag.values, strict=True)
            if value
        },
    )


def _delay_finding(code: str, away: Array, found: Alignment) -> Finding:
    attempt, left = found.attempt, found.left
    names, period = attempt.robot.names, _period(attempt)
    which = away if away.any() else left.taken
    alike = bool(np.all(which == which[0]))
    titles, details = [], []
    evidence: dict[str, Measured] = {}
    for joint in [0] if alike else np.flatnonzero(which).tolist():
        rest = left.value if alike else float(left.joints[joint])
        error = left.stderr if alike else float(left.errors[joint])
        # The value is the removed delay plus the delay that the balance still shows.
        value = float(away[joint]) + rest
        low, high = (1e3 * (abs(value) + sign * _NORMAL * error) for sign in (-1, 1))
        of_joint = "" if alike else f" of {names[joint]}"
        size = f"{rounded(1e3 * abs(value), 1e3 * error)} ± {two_digits(1e3 * error)} ms"
        titles.append(_how_late(attempt.robot, of_joint, value, size, bool(away.any())))
        details.append(
            f"{f'{names[joint]}: ' * (not alike)}time shift of {abs(value) / period:.1f} sample periods against "
            f"the position, 95 % interval {low:.2f} to {high:.2f} ms"
        )
        prefix = "" if alike else f"{names[joint]}."
        evidence |= {
            f"{prefix}lag": Measured(value, "s"),
            f"{prefix}lag_error": Measured(error, "s"),
            f"{prefix}lag_periods": Measured(value / period),
        }
    more = f", and {len(titles) - 1} more" if len(titles) > 1 else ""
    whole = attempt.delay + left.taken
    advice: tuple[Action, ...] = ()
    early = -float(whole[0]) / period
    logged = attempt.robot.drive is None
    if (
        logged
        and alike
        and abs(early - 0.5) < _HALF
        and not next(iter(attempt.excerpts.values())).torque_held
    ):
        text = "if the torque is a command that is held between samples"
        advice = (Action("call", {"torque_hold": "zoh"}, text=text, function="load_robot"),)
    if away.any() and attempt.robot.drive is not None:
        details.append("the standard errors of all values include the uncertainty of this delay")
    elif away.any():
        details.append("the torque was shifted before the identification")
    elif found.chosen:
        details.append(
            "possible causes: a late or coarse position, an early torque, or an elastic gear"
        )
        text = "the position's filter and resolution, and both clocks"
        advice = (Action("inspect", text=text),)
    else:
        after = " after the stated shift" if attempt.delay.any() else ""
        details.append(f"this delay remains{after} and biases the values")
        shift = {"shift": shift_option(whole, attempt.robot)}
        advice = (Action("call", shift, function="identify_robot"), *advice)
        if not alike:
            text = (
                "the stated shift; without a stated shift, each joint's delay is found and removed"
            )
            advice += (Action("inspect", text=text),)
    return TYPES[code].finding(
        titles[0] + more, *advice, details="; ".join([*titles[1:], *details]), evidence=evidence
    )


def _how_late(robot: Robot, of_joint: str, value: float, size: str, removed: bool) -> str:
    if robot.drive is not None and not removed:
        return f"the wanted position{of_joint} acts {size} {'later' if value > 0.0 else 'earlier'} than stated"
    if robot.drive is not None:
        return f"the wanted position{of_joint} acts {size} {'after' if value > 0.0 else 'before'} the time of its row"
    return f"the torque{of_joint} is {'late' if value > 0.0 else 'early'} by {size}"


def _short(delay: Array, left: TorqueDelay) -> Array:
    """Return the delay that is left, for joints with a delay that was removed; 0 for the others."""
    values, counts = np.unique(delay, return_counts=True)
    usual = values[int(np.argmax(counts))]
    return np.where(delay == 0.0, 0.0, np.where(delay == usual, left.value, left.joints))


def _period(attempt: Attempt) -> float:
    return float(np.median(np.diff(next(iter(attempt.excerpts.values())).time)))
