"""Possible effects of another joint on a joint's torque, as integrals over the joint's windows."""

from __future__ import annotations

import functools
from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from jointid.base.values import dataclass
from jointid.identification.causes.fitted import Fitted
from jointid.recording.recording import Recording

Array = NDArray[np.float64]

_SLOW = 4  # number of half waves over the recording
# Names of the groups of signals, and their meaning.
SPEED, RELATIVE, MOMENTUM = "speed", "relative speed", "acceleration"
POSITION, POSE, TORQUE = "position", "pose", "torque"
MEANING = {
    SPEED: "friction of a coupled drive",
    RELATIVE: "friction between the two joints",
    MOMENTUM: "coupled inertia",
    POSITION: "gravity",
    POSE: "inertia that changes with the other joint's position",
    TORQUE: "torque of the other joint that acts on this joint",
}


@dataclass(frozen=True, kw_only=True, eq=False)
class Group:
    """Columns of one other joint that belong together.

    Attributes
    ----------
    joint : str
        The other joint.
    by : str
        "speed", "acceleration", "position" or "torque".
    columns : ndarray, shape (windows, m)
    """

    joint: str
    by: str
    columns: Array


def own_groups(fit: Fitted) -> list[Array]:
    """Return possible effects of the joint's own motion beyond its model, group by group.

    They are friction of any shape, gravity, and an inertia that varies with the angle. Their share of the residual is
    not attributed to another joint that happens to move alike.
    """
    groups = [
        np.column_stack([fit.duration, fit.rise(lambda _, run: run.velocity)]),
        fit.integral(lambda _, run: _either_way(run)),
        fit.integral(lambda _, run: _at_low_speed(run)),
        fit.integral(lambda _, run: _slowly(run)),
    ]
    if fit.problem.recordings[0].kind != "revolute":
        return groups
    for order in (1.0, 2.0):
        groups.append(fit.integral(lambda _, run, k=order: _angles(run.position, k)))  # type: ignore[misc]
        groups.append(
            np.hstack(
                [
                    fit.rise(
                        lambda _, run, k=order: _angles(run.position, k) * run.velocity[:, None]  # type: ignore[misc]
                    ),
                    fit.integral(
                        lambda _, run, k=order: (  # type: ignore[misc]
                            _angles(run.position, k) * run.velocity[:, None] ** 2
                        )
                    ),
                ]
            )
        )
    return groups


def other_groups(fit: Fitted, other: Recording, name: str, rows: NDArray[np.intp]) -> list[Group]:
    """Return possible effects of another joint's motion and torque on this joint, group by group.

    Parameters
    ----------
    fit : Fitted
        Fit of this joint.
    other : Recording
        Recording of the other joint.
    name : str
        Name of the other joint.
    rows : ndarray of int
        Sample number of `other` for each sample of the fit's recording.
    """
    position, velocity = other.position[rows], other.velocity[rows]
    turning = fit.problem.recordings[0].kind == other.kind == "revolute"

    def speed(*_: object) -> Array:
        return np.column_stack([velocity, np.sign(velocity)])

    def relative(_: int, run: Recording) -> Array:
        # A drive may turn with the sum or the difference of two joints.
        return np.sign(np.column_stack([velocity - run.velocity, velocity + run.velocity]))

    def pose(_: int, run: Recording) -> Array:
        return np.asarray(_angles(position, 1.0) * run.velocity[:, None])

    def momentum(_: int, run: Recording) -> Array:
        if not turning:
            return velocity[:, None]
        ones = np.ones((len(velocity), 1))
        shapes = np.hstack([ones, _angles(position, 1.0), _angles(run.position, 1.0)])
        return np.asarray(shapes * velocity[:, None])

    def gravity(_: int, run: Recording) -> Array:
        both = [_angles(position + sign * run.position, 1.0) for sign in (1.0, -1.0)]
        return np.hstack([_angles(position, 1.0), *both])

    signals: list[tuple[str, Callable[[], Array]]] = [
        (SPEED, lambda: fit.integral(speed)),
        (RELATIVE, lambda: fit.integral(relative)),
        (MOMENTUM, lambda: fit.rise(momentum)),
    ]
    if turning:
        signals.append((POSITION, lambda: fit.integral(gravity)))
        signals.append((POSE, lambda: fit.rise(pose)))
    torque = _torque(other)
    if torque is not None:
        signals.append((TORQUE, functools.partial(_of_torque, fit, torque[rows])))
    groups = [Group(joint=name, by=by, columns=make()) for by, make in signals]
    return [group for group in groups if np.any(group.columns)]


def _of_torque(fit: Fitted, torque: Array) -> Array:
    return fit.integral(lambda *_: torque)[:, None]


def _torque(other: Recording) -> Array | None:
    for signal in (other.torque, other.motor_torque, other.current):
        if signal is not None:
            return signal
    return None


def _either_way(run: Recording) -> Array:
    """Return friction that differs between the directions, and friction that grows with the square of the speed."""
    v = run.velocity
    return np.column_stack([np.abs(v), v * np.abs(v)])


def _slowly(run: Recording) -> Array:
    """Return a torque that changes slowly, for example while the joint warms up."""
    share = (run.time - run.time[0]) / run.duration
    return np.column_stack([np.cos(k * np.pi * share) for k in range(1, _SLOW + 1)])


def _at_low_speed(run: Recording) -> Array:
    v = run.velocity
    fast = float(np.quantile(np.abs(v), 0.9)) or 1.0
    return np.column_stack(
        [np.exp(-np.abs(v) / (share * fast)) * np.sign(v) for share in (0.05, 0.3)]
    )


def _angles(angle: Array, *orders: float) -> Array:
    return np.column_stack([each(order * angle) for order in orders for each in (np.cos, np.sin)])
