"""The position loop of each joint, which gives the torque from wanted positions if no torque is logged."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any, Self, get_args

import numpy as np
from numpy.typing import NDArray

from jointid.base.argument_checks import is_finite
from jointid.base.errors import InputError
from jointid.joint.checks import suggestion
from jointid.recording.signals import TorqueHold

Array = NDArray[np.float64]

FREE = "free"
HOLDS = get_args(TorqueHold)
KEYS = ("kp", "kd", "torque_limits", "hold", "delay")
_LONGEST = 0.5  # [s]


@dataclass(frozen=True, slots=True, kw_only=True)
class PositionDrive:
    """Torque = kp · (wanted position - position) - kd · velocity, within its limits; on the side of the recording.

    The loop runs continuously in the motor. The wanted position takes effect some time after its row, and holds until
    the next one takes effect.
    """

    # [N·m/rad or N/m], one for each joint; None: identified from the weight of the links
    kp: tuple[float | None, ...]
    # [N·m·s/rad or N·s/m]; 0 if it is not known: it is then part of the viscous coefficient
    kd: tuple[float, ...]
    torque_limits: tuple[float, ...] | None = None  # [N·m or N]
    hold: str = "zoh"  # "linear": the wanted position is interpolated from row to row
    delay: tuple[float, ...] | None = None  # [s], from a row to its effect; None: identified

    @classmethod
    def of(cls, drive: object, count: int) -> Self:
        """Return the drive of `count` joints from a mapping, with one value for all joints or one for each."""
        if not isinstance(drive, Mapping):
            raise InputError(
                f"a table with {' and '.join(KEYS[:2])} is expected", argument="drive", value=drive
            )
        for key in drive:
            if key not in KEYS:
                raise InputError(
                    f"there is no such key; {suggestion(str(key), KEYS)}", argument=f"drive.{key}"
                )
        for key in KEYS[:2]:
            if key not in drive:
                raise InputError(
                    'one number for all joints, one for each joint, or "free" is expected',
                    argument=f"drive.{key}",
                )
        kp = _values(drive, "kp", count)
        kd = _values(drive, "kd", count)
        if any(p is None and d for p, d in zip(kp, kd, strict=True)):
            raise InputError(
                'with kp = "free", kd must be "free" too, because kd is part of the viscous coefficient',
                argument="drive.kd",
                value=drive["kd"],
            )
        if None in kp and "torque_limits" in drive:
            raise InputError(
                'torque limits need a known kp, not "free"',
                argument="drive.torque_limits",
                value=drive["torque_limits"],
                remedy="record motion that does not reach the limits",
            )
        limits, delay = drive.get("torque_limits"), drive.get("delay", FREE)
        hold = drive.get("hold", "zoh")
        if hold not in HOLDS:
            raise InputError(
                f"{' or '.join(HOLDS)} is expected",
                argument="drive.hold",
                value=hold,
            )
        return cls(
            kp=kp,
            kd=tuple(each or 0.0 for each in kd),
            torque_limits=None if limits is None else _numbers(drive, "torque_limits", count),
            hold=hold,
            delay=None if delay == FREE else _numbers(drive, "delay", count, _LONGEST),
        )

    def torque_of_command(self, wanted: Array) -> Array:
        """Return the torque from the wanted position alone, as a mean until the next sample; (n, samples).

        A held command causes a ripple that velocities from sampled positions do not contain. So this is the mean of the
        torque without ripple, not of the held value. The difference would look like inertia: kp · (row's period)² / 12.
        """
        return self._stiffness * (
            _bent(wanted, 1.0 / 12.0) if self.hold == "zoh" else _means(wanted)
        )

    def torque_of_state(self, time: Array, position: Array) -> Array:
        """Return the other part of the torque, as a mean over each interval; exact for damping without any velocity."""
        slope = np.diff(position, axis=1, append=position[:, -1:]) / np.diff(
            time, append=2.0 * time[-1] - time[-2]
        )
        return -self._stiffness * _means(position) - np.array(self.kd)[:, None] * slope

    def torque_at(self, error: Array, velocity: Array) -> Array:
        """Return the torque at one instant, (n,), without its limits."""
        return self._stiffness[:, 0] * error - np.array(self.kd) * velocity

    @property
    def _stiffness(self) -> Array:
        return np.array([each or 0.0 for each in self.kp])[:, None]

    def limited(self, torque: Array) -> Array:
        """Return torques within the limits."""
        if self.torque_limits is None:
            return torque
        most = np.array(self.torque_limits)[:, None]
        return np.clip(torque, -most, most)

    @property
    def free(self) -> tuple[int, ...]:
        """Joints with a gain that is identified."""
        return tuple(joint for joint, each in enumerate(self.kp) if each is None)

    def of_unit_gain(self) -> PositionDrive:
        """Return a drive with gains of 1 for the identified gains, and 0 for all others."""
        kp = tuple(1.0 if each is None else 0.0 for each in self.kp)
        return replace(self, kp=kp, kd=(0.0,) * len(kp), torque_limits=None)

    def with_gains(self, gains: Mapping[int, float]) -> PositionDrive:
        """Return the drive with the gains that were found."""
        return replace(self, kp=tuple(gains.get(k, each) for k, each in enumerate(self.kp)))

    def document(self) -> dict[str, Any]:
        """Return the drive in JSON's types, as an argument of `of`."""
        found: dict[str, Any] = {
            "kp": list(self.kp),
            "kd": list(self.kd),
            "hold": self.hold,
        }
        if self.torque_limits is not None:
            found["torque_limits"] = list(self.torque_limits)
        if self.delay is not None:
            found["delay"] = list(self.delay)
        return found


def _means(rows: Array) -> Array:
    """Return means of a smooth signal over the intervals; the last mean is the last sample."""
    bent = _bent(rows, -1.0 / 12.0)
    following = np.concatenate([bent[:, 1:], rows[:, -1:]], axis=1)
    return np.asarray(0.5 * (bent + following))


def _bent(rows: Array, share: float) -> Array:
    """Return rows plus a share of their second differences."""
    found = rows.copy()
    found[:, 1:-1] += share * np.diff(rows, 2, axis=1)
    return found


def _values(drive: Mapping[str, Any], key: str, count: int) -> tuple[float | None, ...]:
    """Return numbers, or None for "free"."""
    each = drive[key]
    if isinstance(each, str) or is_finite(each):
        each = [each] * count
    wrong = not isinstance(each, Sequence | np.ndarray) or len(each) != count
    if wrong or not all(v in (FREE, None) or (is_finite(v) and v >= 0.0) for v in each):
        raise InputError(
            f'a number of at least 0, or "free", is expected: one for all, or one for each of the {count} joints',
            argument=f"drive.{key}",
            value=drive[key],
        )
    return tuple(None if v in (FREE, None) else float(v) for v in each)


def _numbers(
    drive: Mapping[str, Any], key: str, count: int, most: float | None = None
) -> tuple[float, ...]:
    found = _values(drive, key, count)
    numbers = tuple(each for each in found if each is not None)
    if len(numbers) < count or (most is not None and max(numbers) > most):
        raise InputError(
            f"numbers are expected{'' if most is None else f', at most {most:g} s'}",
            argument=f"drive.{key}",
            value=drive[key],
        )
    return numbers


def facts_of_drive(names: Sequence[str]) -> str:
    """Return the line of a facts file that gives joints a position drive, with the values to fill in."""
    order = ", ".join(names)
    return (
        "state the position loop above the first table of the facts file: "
        f"drive = {{kp = {[20.0] * len(names)}, kd = {[1.0] * len(names)}}}, with the robot's own gains for {order} "
        '[N·m/rad, N·m·s/rad] or one gain for all joints; for unknown gains: drive = {kp = "free", kd = "free"}'
    )


def facts_of_scales(
    drive: PositionDrive | None, scales: Sequence[float], before: Sequence[float] | None
) -> dict[str, object]:
    """Return the facts that apply factors to the joints' torques: the gains of a drive, unless a sign changes.

    `before` are the stated scales.
    """
    if drive is None or min(scales) < 0.0:
        return {"torque_scales": [*scales]}
    found = drive.document()
    for key in KEYS[:2]:
        pairs = zip(found[key], scales, strict=True)
        found[key] = [FREE if each is None else float(f"{each * s:.4g}") for each, s in pairs]
    return {"drive": found} | ({} if before is None else {"torque_scales": [1.0] * len(scales)})
