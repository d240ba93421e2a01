"""Early end of a session: its limit, time and excess, and the exceptions for it."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from typing import Any

from jointid.base.errors import InputError
from jointid.hardware.session.drive import DriveFaultError
from jointid.recording.recording import Recording


@dataclass(frozen=True, slots=True, kw_only=True)
class Stop:
    """Reason why a session ended early.

    Attributes
    ----------
    limit : str
        Name of the stop: a field of `SessionLimits`, a kind of `DriveFaultError`, or one of four others.
        "torque_sign": the joint gained energy against the torque. "recording": the file of the recording cannot be
        created or written. "user": the user stopped the session. "error": another exception stopped the session.
    phase : str
        Phase of the session: "check", "enable", "move", "settle" or "run".
    time : float
        Time since the start of the phase [s].
    moment : float
        Time on the drive's clock [s]; the frames have time stamps of this clock.
    message : str
        One sentence on the cause, with numbers.
    measured, allowed : float or None
        Value beyond the limit, and this limit, in the limit's unit; None without a number.
    motor_off : bool or None
        Whether the drive confirmed that its motor is off; None if the drive cannot report this.
    """

    limit: str
    phase: str
    time: float
    moment: float
    message: str
    measured: float | None = None
    allowed: float | None = None
    motor_off: bool | None = None

    def __str__(self) -> str:
        return f"stopped by {self.limit} after {self.time:.3f} s of {self.phase}: {self.message}"

    def to_dict(self) -> dict[str, Any]:
        """Return the fields as JSON types."""
        return asdict(self)


class LimitError(RuntimeError):
    """A limit was exceeded.

    Parameters
    ----------
    limit, message : str
    measured, allowed : float, optional
        As in `Stop`.
    """

    def __init__(
        self,
        limit: str,
        message: str,
        *,
        measured: float | None = None,
        allowed: float | None = None,
    ) -> None:
        super().__init__(message)
        self.limit, self.measured, self.allowed = limit, measured, allowed


class SessionRefusedError(RuntimeError):
    """The session did not start; the motor was never on."""


class SessionStoppedError(RuntimeError):
    """A limit stopped the session; torque and motor are off.

    Parameters
    ----------
    stop : Stop
    recording : Recording or None
        Recording until the stop, if it is long enough.
    """

    def __init__(self, stop: Stop, recording: Recording | None) -> None:
        super().__init__(str(stop))
        self.stop, self.recording = stop, recording


def is_bug(error: BaseException) -> bool:
    """Return whether an exception means a bug in a program, and not a limit, a fault, bad input or the user.

    An OSError is no bug: a device or a disk has failed.
    """
    expected = (LimitError, DriveFaultError, InputError, OSError, KeyboardInterrupt)
    return not isinstance(error, expected)


def noted(error: Exception, note: str) -> Exception:
    """Return the exception, with the note if it is not empty."""
    if note:
        error.add_note(note)
    return error
