"""A log of a serial arm, clean or with one fault that its call does not know."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

import jointid as jid
from arms.serial_arms import SerialArm, Signals, random_arm, simulated

Array = NDArray[np.float64]

FAULTS = ("stamps", "signs", "factors", "order", "lag", "load", "smooth", "slow")
_DURATION = 20.0  # [s]


@dataclass(frozen=True, kw_only=True)
class FaultyLog:
    """Arguments of the call, and the true values."""

    fault: str  # one of FAULTS, or "clean"
    detail: str
    arm: SerialArm
    recording: jid.RobotRecording


@dataclass(frozen=True, kw_only=True)
class _Log:
    time: Array
    position: Array
    torque: Array
    detail: str = ""


def faulty_log(seed: int, fault: str) -> FaultyLog:
    """Return a random arm's log with this fault."""
    rng = np.random.default_rng([seed, 54])
    arm = random_arm(rng, load=fault == "load", rise=fault == "smooth")
    signals = simulated(arm, _DURATION, rng)
    log = _recorded(signals, rng, every=1 if fault == "slow" else int(rng.choice([1, 2, 4, 8])))
    log = _MADE[fault](log, rng) if fault in _MADE else log
    return FaultyLog(
        fault=fault,
        detail=log.detail,
        arm=arm,
        recording=jid.RobotRecording(
            time=log.time,
            position=log.position,
            torque=log.torque,
            names=[f"joint_{number}" for number in range(1, arm.joints + 1)],
            name=f"{fault} {seed}",
        ),
    )


def _recorded(signals: Signals, rng: np.random.Generator, every: int) -> _Log:
    """Return the recording of good sensors: counts, noise on the torques, stamps that are slightly late."""
    count = 2.0 * np.pi / 2.0 ** rng.integers(17, 21)
    noise = rng.uniform(0.002, 0.008) * np.abs(signals.torque).max(axis=0)
    time = signals.time + rng.exponential(3e-5, signals.time.size)
    torque = signals.torque + noise * rng.normal(size=signals.torque.shape)
    position = count * np.round(signals.position / count)
    return _Log(time=time[::every], position=position[::every], torque=torque[::every])


def _stamps(log: _Log, rng: np.random.Generator) -> _Log:
    kind = str(rng.choice(["late", "lost", "late and lost", "rounded"]))
    time, kept = log.time.copy(), np.full(log.time.size, True)
    period = float(np.median(np.diff(time)))
    if "late" in kind:
        time += rng.exponential(rng.uniform(0.3, 1.5) * period, time.size)
        time = np.maximum.accumulate(time) + 1e-7 * np.arange(time.size)
    if "lost" in kind:
        kept = rng.random(time.size) > rng.uniform(0.02, 0.15)
    if kind == "rounded":
        step = rng.uniform(0.3, 0.8) * period  # no stamp twice
        time = np.floor(time / step) * step
    return replace(
        log, time=time[kept], position=log.position[kept], torque=log.torque[kept], detail=kind
    )


def _signs(log: _Log, rng: np.random.Generator) -> _Log:
    n = log.position.shape[1]
    kind = str(rng.choice(["torque", "position", "both"]))
    whole = bool(rng.random() < 0.4)
    sign = np.full(n, -1.0) if whole else np.ones(n)
    sign[int(rng.integers(n))] = -1.0
    position = log.position * (sign if kind != "torque" else 1.0)
    torque = log.torque * (sign if kind != "position" else 1.0)
    where = "all joints" if whole else f"joint_{int(np.argmin(sign)) + 1}"
    return replace(log, position=position, torque=torque, detail=f"{kind} of {where}")


def _factors(log: _Log, rng: np.random.Generator) -> _Log:
    n = log.position.shape[1]
    kind = str(rng.choice(["all torques", "one torque", "one ratio", "degrees", "magnitude"]))
    if kind == "degrees":
        return replace(log, position=np.rad2deg(log.position), detail=kind)
    if kind == "magnitude":
        return replace(log, torque=np.abs(log.torque), detail=kind)
    factor = float(np.exp(rng.choice([-1.0, 1.0]) * rng.uniform(np.log(1.3), np.log(30.0))))
    scales = np.full(n, factor)
    if kind == "one torque":
        scales = np.ones(n)
        scales[rng.integers(n)] = np.exp(rng.choice([-1.0, 1.0]) * rng.uniform(0.2, 1.0))
    if kind == "one ratio":  # the ratio of the first joint is used for all
        ratios = rng.uniform(0.4, 1.0, (n,)) * 100.0
        scales = ratios[0] / ratios
    shown = ", ".join(f"{each:.2g}" for each in scales.tolist())
    return replace(log, torque=log.torque * scales, detail=f"{kind}: {shown}")


def _order(log: _Log, rng: np.random.Generator) -> _Log:
    n = log.position.shape[1]
    kind = str(rng.choice(["two joints", "two torques", "joints", "torques"]))
    order = np.arange(n)
    if "two" in kind:
        first, second = rng.choice(n, 2, replace=False)
        order[[first, second]] = second, first
    else:
        while np.any(order == np.arange(n)) and np.count_nonzero(order != np.arange(n)) < 3:
            order = rng.permutation(n)
    torques_only = "torques" in kind
    return replace(
        log,
        position=log.position if torques_only else log.position[:, order],
        torque=log.torque[:, order],
        detail=f"{kind}: {' '.join(str(each + 1) for each in order)}",
    )


def _lag(log: _Log, rng: np.random.Generator) -> _Log:
    size = float(rng.uniform(0.004, 0.03))
    if rng.random() < 0.5:
        late = [np.interp(log.time - size, log.time, column) for column in log.torque.T]
        return replace(log, torque=np.column_stack(late), detail=f"delay {1e3 * size:.0f} ms")
    torque = log.torque.copy()
    for row in range(1, log.time.size):
        share = 1.0 - np.exp(-(log.time[row] - log.time[row - 1]) / size)
        torque[row] = torque[row - 1] + share * (log.torque[row] - torque[row - 1])
    return replace(log, torque=torque, detail=f"first-order lag {1e3 * size:.0f} ms")


def _slow(log: _Log, rng: np.random.Generator) -> _Log:
    every = int(rng.choice([20, 25, 40, 50, 100]))
    return replace(
        log,
        time=log.time[::every],
        position=log.position[::every],
        torque=log.torque[::every],
        detail=f"{1000 // every} Hz",
    )


_MADE = {
    "stamps": _stamps,
    "signs": _signs,
    "factors": _factors,
    "order": _order,
    "lag": _lag,
    "slow": _slow,
}
