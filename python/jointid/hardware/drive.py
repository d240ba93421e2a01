"""What a session asks of a drive. Anything with these methods will do; nothing is inherited."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Protocol

from jointid.hardware.clock import Clock


class DriveFaultError(RuntimeError):
    """The drive, or the way to it, has failed; the session stops.

    Parameters
    ----------
    kind : str
        "stale_position", "drive_fault", "emergency", "heartbeat_lost", "bus", "refused".
    message : str
    """

    def __init__(self, kind: str, message: str) -> None:
        super().__init__(message)
        self.kind = kind


@dataclass(frozen=True, slots=True, kw_only=True)
class DriveSample:
    """What a drive says in one cycle.

    Attributes
    ----------
    time : float
        On the session's clock, when the position was taken [s].
    position : float
        At the output [rad].
    reading : float
        Raw, of the torque sensor; the last one when `fresh` is False.
    fresh : bool
    clipped : bool
        The sensor's converter is at the end of its range.
    current : float
        Active, in the motor [A]; not a number when the drive does not tell.
    """

    time: float
    position: float
    reading: float = 0.0
    fresh: bool = True
    clipped: bool = False
    current: float = float("nan")


class Drive(Protocol):
    """A drive in torque control, at the output side of the gear.

    A session calls `connect`, `problems`, `enable`, then in each cycle `read` and `command`, and at the
    end, whatever happened, `disable` and `close`. All of them raise DriveFaultError.
    """

    @property
    def clock(self) -> Clock:
        """The clock that the drive's samples are stamped by."""

    def connect(self, period: float) -> None:
        """Bring the drive up, motor off; `period` [s] is that of the cycles to come."""

    def problems(self, torque_limit: float) -> list[str]:
        """What speaks against enabling the motor, in sentences; nothing when all is well."""

    def enable(self) -> None:
        """Motor on, at zero torque."""

    def read(self, timeout: float) -> DriveSample:
        """Ask for the state and wait for it [s]."""

    def command(self, torque: float) -> float:
        """Send a torque [N·m], to be held until the next; return what the drive was told [N·m]."""

    def disable(self) -> None:
        """Zero torque, then motor off; tries to the end, whatever fails on the way."""

    def close(self) -> None:
        """Leave the drive and the bus as they were found."""

    @property
    def command_latency(self) -> float:
        """From sending a command until the drive acts on it [s]."""

    def bus_load(self, period: float) -> float:
        """Share of the bus that a cycle takes."""

    def identity(self) -> dict[str, Any]:
        """What the drive is, for the recording."""
