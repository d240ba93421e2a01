"""Signals of a servo's recording: position, duty, supply, and times with a driven motor."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from jointid.base.argument_checks import require_kind
from jointid.base.errors import InputError
from jointid.base.values import dataclass
from jointid.joint.joint import Joint
from jointid.joint.voltage_drive import VoltageDrive
from jointid.recording.recording import Recording

Array = NDArray[np.float64]

_LARGEST = 1.05
"""Largest duty that counts as 1, because of rounding or the last step of a counter."""


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class ServoSignals:
    """One run of a servo, in SI units (n samples)."""

    name: str
    time: Array  # [s]
    position: Array  # [rad]
    duty: Array  # logged duty times its scale; computed from the position loop if no duty is logged
    supply: Array  # [V]
    driven: Array  # 1 if the motor is connected to its voltage, 0 if it turns freely
    reference: Array | None  # wanted position [rad]
    gain: float  # duty per error of the position loop [1/rad]; 0 without a position loop
    logged: bool  # whether the duty was logged

    @property
    def closed(self) -> bool:
        """Whether the position loop is known, so that a simulation can close it."""
        return self.reference is not None and self.gain != 0.0

    def driven_at(self, times: Array) -> Array:
        """Return 1 where the motor is connected to its voltage, 0 where it turns freely."""
        return np.asarray(self.driven[np.searchsorted(self.time, times, side="right") - 1])


def signals_of(recordings: Recording | Sequence[Recording], joint: Joint) -> list[ServoSignals]:
    """Return the runs of a servo from recordings; missing signals get the defaults of the joint's voltage drive.

    The extra signals are "duty" (or a `reference` and a known position loop), "supply" (unless the joint has it),
    "driven" (default: always driven) and "gain".
    """
    require_kind("joint", joint, Joint)
    drive = voltage_drive(joint)
    one = (Recording, Mapping)  # a mapping is a recording of several joints
    given: list[Any] = [recordings] if isinstance(recordings, one) else list(recordings)
    if not given:
        raise InputError("at least one recording is expected", argument="recordings", value=[])
    for each in given:
        require_kind("recordings", each, Recording)
    return [_run(recording, drive, number) for number, recording in enumerate(given)]


def voltage_drive(joint: Joint) -> VoltageDrive:
    """Return a joint's voltage drive; raise an error if the joint's input is a torque."""
    if joint.voltage is None:
        raise InputError(
            "the joint's input is not a voltage",
            argument="voltage",
            place=joint.owner,
            remedy='write input = "voltage" in the joint file\'s [drive]',
        )
    return joint.voltage


def _run(recording: Recording, drive: VoltageDrive, number: int) -> ServoSignals:
    place = f"recording {recording.name or number}"
    extra, count = recording.extra, len(recording.time)
    driven = extra.get("driven")
    on = np.ones(count) if driven is None else np.where(np.asarray(driven) > 0.5, 1.0, 0.0)
    supply = _supply(recording, drive, place)
    loop, reference = drive.position_loop, recording.reference
    gain = 0.0
    if loop is not None:
        gain = loop.gain * _constant(extra.get("gain"), place)
    if "duty" in extra:
        duty = _of_full_voltage(extra["duty"] * drive.duty_scale, place)
    elif loop is not None and reference is not None:
        late = np.interp(
            recording.time - loop.delay, recording.time, reference - recording.position
        )
        duty = np.clip(gain * late, -loop.saturation, loop.saturation) * on
    else:
        raise InputError(
            "the recording has neither a signal duty nor a reference with a known position loop",
            argument="duty",
            place=place,
            remedy=(
                "name the column of the duty in the joint file's [drive.signals]",
                "give the loop's gain in [drive.position_loop]",
            ),
        )
    return ServoSignals(
        name=recording.name or str(number),
        time=recording.time,
        position=recording.position,
        duty=duty,
        supply=supply,
        driven=on,
        reference=reference if loop is not None else None,
        gain=gain,
        logged="duty" in extra,
    )


def _of_full_voltage(duty: Array, place: str) -> Array:
    """Return a duty; refuse another unit, because all values would have a wrong factor and the fit would hide it."""
    top = float(np.abs(duty).max())
    if top > _LARGEST:
        raise InputError(
            f"the duty reaches {top:.4g}, but 1 is the full voltage",
            argument="duty",
            place=place,
            remedy="state its scale in the joint file's [drive]: duty_scale = 0.01 for percent",
        )
    return duty


def _supply(recording: Recording, drive: VoltageDrive, place: str) -> Array:
    """Return the supply voltage that the joint states, otherwise the logged one."""
    if drive.supply is not None:
        return np.full(len(recording.time), drive.supply)
    if "supply" not in recording.extra:
        raise InputError(
            "the supply voltage is neither in the joint's drive nor in the recording",
            argument="supply",
            place=place,
            remedy=(
                "give the supply's voltage in the joint file's [drive]",
                "name its column in [drive.signals]",
            ),
        )
    return np.asarray(recording.extra["supply"])


def _constant(gain: Array | None, place: str) -> float:
    if gain is None:
        return 1.0
    if np.ptp(gain) > 1e-9 * np.abs(gain).max():
        raise InputError(
            "the position loop's gain changes within a run",
            argument="gain",
            place=place,
            remedy="save one recording for each gain",
        )
    return float(gain[0])
