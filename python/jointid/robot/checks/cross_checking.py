"""The cross-check of an identification, and the finding that the two disagree."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np
from numpy.typing import NDArray

from jointid import _core
from jointid.base.advice import Action
from jointid.estimate.findings import Finding, Measured
from jointid.estimate.wording import number, percent
from jointid.robot.checks.filtered_regression import SETTINGS, SecondLook, filtered_fit
from jointid.robot.fit.attempt import Attempt, Request
from jointid.robot.links.models import shaped_term
from jointid.robot.links.parameters import JOINT_FRICTION
from jointid.robot.motion.plain_motion import PlainSignals
from jointid.robot.result.cross_check import Compared, CrossCheck
from jointid.robot.result.finding_types import TYPES
from jointid.robot.result.prediction import loading_of
from jointid.robot.result.record import RobotJoint

Array = NDArray[np.float64]

COMPARED = (*JOINT_FRICTION, "rotor_inertia")
_APART, _ERRORS = 0.05, 3.0  # relative to the value, and to both errors
_MATTERS = 0.01  # of the joint's torque: a smaller difference is harmless
_VAGUE = 0.5  # of the value: with a larger error the cross-check gives no answer
_SHOWN = 5
_PAST = 2.2  # of the speed of a shape: above it, static friction has decayed
_RISEN = 3.0  # of the speed of a shape: above it, dry friction has risen fully
_GONE = 0.01  # of a coefficient
_CLEARER = 0.25  # of the squared residuals
# residual over torque, and the ratio of the cross-check's squared residual to it
_POOR, _BETTER = 0.05, 0.5


def cross_checked(
    signals: Sequence[PlainSignals],
    attempt: Attempt,
    request: Request,
    requested_delay: Array | None,
) -> CrossCheck:
    """Return the cross-check on signals as recorded, with the delay of the torques that a call states [s].

    The signals of a drive already contain the delay of its commands. Nothing else in them is late.
    """
    robot, estimate = attempt.robot, attempt.estimate
    delay, other = requested_delay, attempt.delay
    if robot.drive is not None:
        delay, other = None, np.zeros(robot.n)
    if not signals:
        return CrossCheck(reason="the recording is too short")
    joints = list(estimate.joints.values())
    look = filtered_fit(
        signals,
        robot,
        estimate.inertia,
        np.maximum([_past_shape(joint) for joint in joints], request.slowest),
        [joint.model for joint in joints],
        loading_of(estimate),
        np.zeros(robot.n) if delay is None else delay,
        other,
    )
    if not look.matrix:
        return CrossCheck(reason="no joint has enough fast motion")
    found = {
        f"{joint.name}.{name}": _compared(attempt, look, k, name)
        for k, joint in enumerate(joints)
        for name in COMPARED
        if name in joint.parameters
    }
    residuals = dict(_residuals(attempt, look))
    said = [each.agrees for each in found.values() if each.agrees is not None]
    worse = any(_much_worse(*each) for each in residuals.values())
    return CrossCheck(
        parameters=found,
        residuals=residuals,
        agrees=(all(said) and not worse) if said or worse else None,
        reason="" if said or worse else "the cross-check determines no parameter",
    )


def clearer(stamped: CrossCheck, even: CrossCheck) -> CrossCheck:
    """Return the check on the even clock if its residual is far smaller than that of the check on the stamps."""
    left = [sum(own**2 for _, own in each.residuals.values()) for each in (even, stamped)]
    return even if even.residuals and left[0] < _CLEARER * left[1] else stamped


def _past_shape(joint: RobotJoint) -> float:
    """Return the speed above which a joint's shaped term has settled; infinite if it never settles."""
    term = shaped_term(joint.model)
    if term is None:
        return 0.0
    value = joint.parameters[term.shapes[0]].value
    power = _core.shape(term.shapes[0]).speed_power
    speed = (_RISEN if term.settles else _PAST) * value ** (1.0 / power) if power else np.inf
    left = abs(float(term.settles) - _core.friction_basis(term.key, [speed], [value])[0])
    return float(speed) if left < _GONE else np.inf


def _compared(attempt: Attempt, look: SecondLook, joint: int, name: str) -> Compared:
    p = list(attempt.estimate.joints.values())[joint].parameters[name]
    value, stderr = p.value, p.stderr or 0.0
    if joint not in look.matrix:
        return Compared(value=value, stderr=stderr, reason="too few rows of fast motion")
    if name == "rotor_inertia" and look.recorded:
        reason = "the cross-check uses the recorded velocity; a late velocity would look like rotor inertia"
        return Compared(value=value, stderr=stderr, reason=reason)
    label = (joint, name)
    second, error, spread = look.values[label], look.errors[label], look.spread[label]
    doubt = _ERRORS * float(np.hypot(stderr, error)) + spread
    scale = max(abs(value), abs(second))
    labels, matrix = look.matrix[joint]
    column = matrix[:, labels.index(label)]
    felt = float(np.sqrt(np.mean(column**2))) or 1.0
    little = _MATTERS * look.size[joint] / felt
    if not doubt < max(_VAGUE * scale, little):
        return Compared(
            value=value,
            stderr=stderr,
            reason="the cross-check does not determine this value well enough",
        )
    return Compared(
        value=value,
        stderr=stderr,
        second=second,
        second_stderr=error,
        spread=spread,
        agrees=abs(value - second) <= max(_APART * scale + doubt, little),
    )


def _residuals(attempt: Attempt, look: SecondLook) -> Iterator[tuple[str, tuple[float, float]]]:
    """Yield each joint's residual over its torque, with both sets of values."""
    fit = attempt.fit
    places = {label: place for place, label in enumerate(fit.labels)}
    for joint, (labels, matrix) in look.matrix.items():
        known = [float(fit.values[places[label]]) if label in places else 0.0 for label in labels]
        left = [
            float(np.sqrt(np.mean((look.torque[joint] - matrix @ np.array(values)) ** 2)))
            for values in (known, [look.values[label] for label in labels])
        ]
        size = look.size[joint] or 1.0
        yield attempt.robot.names[joint], (left[0] / size, left[1] / size)


def _much_worse(identified: float, second: float) -> bool:
    return identified > _POOR and second**2 < _BETTER * identified**2


def slow_motion(signals: Sequence[PlainSignals]) -> float:
    """Return the median over the joints of the speed below which the cross-check has no rows [rad/s or m/s]."""
    peaks = [np.abs(each.velocity).max(axis=1) for each in signals] or [np.zeros(1)]
    return float(f"{SETTINGS[0][1] * float(np.median(np.max(peaks, axis=0))):.2g}")


def disagreement(found: CrossCheck, slow: float) -> Iterator[Finding]:
    """Yield the blocking finding that the cross-check does not support the values; `slow`: its least speed [rad/s]."""
    if found.agrees is not False or found.explained:
        return
    apart = {name: each for name, each in found.parameters.items() if each.agrees is False}
    worse = {name: each for name, each in found.residuals.items() if _much_worse(*each)}
    title, texts = "", []
    if apart:
        name, first = next(iter(apart.items()))
        title = f"gives {name} {number(first.second or 0.0)}, not {number(first.value)}"
        shown = [
            f"{name} {number(c.second or 0.0)}, not {number(c.value)}" for name, c in apart.items()
        ]
        more = f" and {len(apart) - _SHOWN} more" if len(apart) > _SHOWN else ""
        texts.append(f"it gives other values: {', '.join(shown[:_SHOWN])}{more}")
    advice: tuple[Action, ...] = (
        Action("call", {"min_speed": slow}, text="if the friction model is wrong at low speed"),
    )
    if worse:
        joint, (ours, second) = max(worse.items(), key=lambda each: each[1][0] / each[1][1])
        title = f"leaves {percent(second)} of the torque of {joint} unexplained, the identification {percent(ours)}"
        texts.append(f"it {title}")
        advice = ()
    yield TYPES["cross_check"].finding(
        f"the cross-check {title}",
        *advice,
        Action("inspect", text="the time stamps and the logger"),
        details="; ".join(
            (
                "the cross-check is a simple least-squares fit to the filtered recorded signals",
                *texts,
                "the identification probably mishandles time stamps, gaps, delays or slow motion of this recording",
            )
        ),
        parameters=tuple(apart) if not worse else (),
        evidence={f"{name}.second": Measured(each.second or 0.0) for name, each in apart.items()},
    )
