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
        "stale_position", "drive_fault", "heartbeat_lost" (the drive's), "host_heartbeat_lost" (ours, so
        the drive says), "bus", "sensor".
    message : str
    measured, allowed : float, optional
        The number that was beyond a limit, and the limit.
    """

    def __init__(
        self,
        kind: str,
        message: str,
        *,
        measured: float | None = None,
        allowed: float | None = None,
    ) -> None:
        super().__init__(message)
        self.kind, self.measured, self.allowed = kind, measured, allowed


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
    torque : float
        Of that current, at the output [N·m]; not a number when the drive does not tell.
    """

    time: float
    position: float
    reading: float = 0.0
    fresh: bool = True
    clipped: bool = False
    current: float = float("nan")
    torque: float = float("nan")


@dataclass(frozen=True, slots=True, kw_only=True)
class DriveEnd:
    """What a drive says after it was told to switch its motor off.

    Attributes
    ----------
    motor_off : bool or None
        Whether it said so when asked; None: it cannot be asked.
    failure : str
        Why it had shut the motor down by itself; empty when it had not.
    """

    motor_off: bool | None = None
    failure: str = ""


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

    def disable(self) -> DriveEnd | None:
        """Zero torque, then motor off, at once and whatever fails on the way; then see that it is off.

        Called again when the motor was not seen off. Returns in bounded time, and raises nothing for a
        bus that fails. None: the drive cannot be asked.
        """

    def close(self) -> None:
        """Leave the drive and the bus as they were found."""

    @property
    def command_latency(self) -> float:
        """From sending a command until the drive acts on it [s]."""

    def bus_load(self, period: float) -> float:
        """Share of the bus that a cycle takes."""

    def identity(self) -> dict[str, Any]:
        """What the drive is, for the recording."""
