"""The classical peer: filtered inverse dynamics, weighted least squares, base parameters.

Positions pass a Butterworth filter of 4th order forward and backward; velocity and acceleration are central
differences; torques pass the decimating filter of the same kind; rows are weighted by their joint's residual;
QR finds the columns that the motion separates. Janot, Vandanjon, Gautier and many others use this method.
Nothing of the package is used.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]
_LINK = ("m", "mx", "my", "mz", "Ixx", "Ixy", "Iyy", "Ixz", "Iyz", "Izz")


@dataclass(frozen=True, kw_only=True)
class Source:
    """Source of friction and a rotor's inertia: its speed is `speed` · v, and it acts on each joint by `speed`.

    Attributes
    ----------
    name : str
    speed : tuple of float
        One number per joint: 1 for the joint itself; a coupled motor turns with several.
    least : float
        Rows with a smaller speed are left out [rad/s].
    """

    name: str
    speed: tuple[float, ...]
    least: float = 0.0


def joint_sources(joints: int, least: Sequence[float]) -> list[Source]:
    """Return one source per joint."""
    return [
        Source(name=str(j + 1), speed=tuple(float(i == j) for i in range(joints)), least=least[j])
        for j in range(joints)
    ]


@dataclass(frozen=True)
class Signals:
    """Filtered motion at full rate, and the torque as measured; (samples, joints)."""

    time: Array
    position: Array
    velocity: Array
    acceleration: Array
    torque: Array


def filtered(time: Array, position: Array, torque: Array, cutoff: float) -> Signals:
    """Filter by a Butterworth of 4th order forward and backward, then take central differences; stamps must be even."""
    from scipy.signal import butter, filtfilt

    period = float(time[-1] - time[0]) / (len(time) - 1)
    smooth = filtfilt(*butter(4, 2.0 * cutoff * period), position, axis=0)
    velocity = np.gradient(smooth, period, axis=0)
    return Signals(time, smooth, velocity, np.gradient(velocity, period, axis=0), torque)


@dataclass(frozen=True)
class Rows:
    """The regressor's rows of some samples, (samples, joints, columns), their torques, and the mask of used rows."""

    columns: Array
    torque: Array
    used: Mask
    names: tuple[str, ...]


def regressor(model: Any, sources: Sequence[Source], signals: Signals) -> tuple[Array, list[str]]:
    """Return all columns: ten per link by pinocchio, inertia, viscous and Coulomb friction per source, and offsets."""
    import pinocchio

    state = model.createData()
    motion = zip(signals.position, signals.velocity, signals.acceleration, strict=True)
    links = np.array([pinocchio.computeJointTorqueRegressor(model, state, *row) for row in motion])
    joints = signals.position.shape[1]
    names = [f"{name}{link}" for link in range(1, joints + 1) for name in _LINK]
    more: list[Array] = []
    for source in sources:
        acts = np.array(source.speed)
        speed = signals.velocity @ acts
        for name, value in (
            ("inertia", signals.acceleration @ acts),
            ("viscous", speed),
            ("coulomb", np.sign(speed)),
        ):
            more.append(value[:, None] * acts)
            names.append(f"{name} {source.name}")
    for joint in range(joints):
        offset = np.zeros_like(signals.torque)
        offset[:, joint] = 1.0
        more.append(offset)
        names.append(f"offset {joint + 1}")
    return np.concatenate([links, np.stack(more, axis=2)], axis=2), names


def rows_of(model: Any, sources: Sequence[Source], signals: Signals, every: int) -> Rows:
    """Return each `every`-th sample; the torque is filtered below half of the remaining rate."""
    from scipy.signal import butter, filtfilt

    torque = filtfilt(*butter(4, 0.8 / every), signals.torque, axis=0)[::every]
    thin = Signals(
        signals.time[::every],
        signals.position[::every],
        signals.velocity[::every],
        signals.acceleration[::every],
        torque,
    )
    columns, names = regressor(model, sources, thin)
    used = np.ones(torque.shape, dtype=bool)
    for source in sources:
        acts = np.array(source.speed)
        slow = np.abs(thin.velocity @ acts) < source.least
        used[np.ix_(slow, acts != 0.0)] = False
    return Rows(columns, torque, used, tuple(names))


@dataclass(frozen=True)
class Fit:
    """Values and standard errors of the columns that the rows separate; they include the other columns."""

    value: dict[str, float]
    error: dict[str, float]
    chosen: NDArray[np.intp] = field(repr=False)
    beta: Array = field(repr=False)

    def torque(self, columns: Array) -> Array:
        """Return the predicted torque, (samples, joints)."""
        return np.asarray(columns[:, :, self.chosen] @ self.beta)


def fit(rows: Rows, kept: Mask) -> Fit:
    """Fit by weighted least squares over the samples `kept`; weights by each joint's residual, three times."""
    used = rows.used & kept[:, None]
    chosen = _told_apart(rows, used)
    columns = rows.columns[:, :, chosen]
    weight = np.ones(rows.torque.shape[1])
    for _ in range(3):
        left = (columns / weight[:, None])[used]
        right = (rows.torque / weight)[used]
        beta = np.linalg.lstsq(left, right, rcond=None)[0]
        residual = np.where(used, rows.torque - columns @ beta, 0.0)
        weight = np.sqrt((residual**2).sum(axis=0) / used.sum(axis=0))
    left = (columns / weight[:, None])[used]
    errors = np.sqrt(np.diag(np.linalg.inv(left.T @ left)))
    names = [rows.names[column] for column in chosen]
    return Fit(
        dict(zip(names, beta.tolist(), strict=True)),
        dict(zip(names, errors.tolist(), strict=True)),
        chosen,
        np.asarray(beta, dtype=float),
    )


def _told_apart(rows: Rows, used: Mask) -> NDArray[np.intp]:
    """Return columns of a basis by QR; friction comes first, so that dependent columns are those of links."""
    stacked = rows.columns[used]
    size = np.linalg.norm(stacked, axis=0)
    links = sum(name.startswith(_LINK) for name in rows.names)
    present = np.flatnonzero(size > 1e-8)
    order = np.concatenate([present[present >= links], present[present < links]])
    triangle = np.linalg.qr(stacked[:, order] / size[order], mode="r")
    return np.asarray(order[np.abs(np.diag(triangle)) > 1e-6])
