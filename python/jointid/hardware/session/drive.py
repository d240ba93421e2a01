"""What a session needs of a drive: an object with these methods; nothing is inherited.

`docs/hardware.md` shows a complete drive of sixty lines and in which order a session calls it.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Protocol

from jointid.base.errors import InputError
from jointid.hardware.session.clock import Clock
from jointid.hardware.session.motor_state import MotorState, is_off, state_of

FAULT_KINDS = (
    "stale_position",
    "drive_fault",
    "heartbeat_lost",
    "host_heartbeat_lost",
    "bus",
    "sensor",
    "foreign_master",
    "command_echo",
)


class DriveFaultError(RuntimeError):
    """The drive, or the way to it, has failed; the session stops.

    The only exception that a drive should raise: its kind becomes the name of the stop. An OSError or
    InputError stops the session as "error" (before the motor is on, an OSError refuses it as this one
    does); any other is a bug, and is raised again after the session.

    Parameters
    ----------
    kind : str
        "stale_position": no new state within the time allowed, which a session stands for a few cycles while
        the motor moves (`SessionLimits.late_samples`); "drive_fault": the drive has shut down or
        refuses a command; "heartbeat_lost": it does not answer any more; "host_heartbeat_lost": it reports that
        the host does not; "bus": the bus has failed; "sensor": a reading is missing or not finite;
        "foreign_master": somebody else commands the drive, or feeds its watchdog; "command_echo": the drive
        acknowledges another torque than was commanded, or none.
    message : str
        One sentence: what happened, with the numbers.
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
        if kind not in FAULT_KINDS:
            raise InputError(f"known are {', '.join(FAULT_KINDS)}", argument="kind", value=kind)
        super().__init__(message)
        self.kind, self.measured, self.allowed = kind, measured, allowed


@dataclass(frozen=True, slots=True, kw_only=True)
class DriveSample:
    """State of a drive in one cycle.

    Attributes
    ----------
    time : float
        When the position was taken [s], on the drive's `clock`; later than in the cycle before, else the
        session stops by "stale_position".
    position : float
        At the output [rad]. A value that is not finite stops the session.
    reading : float
        Raw, of the torque sensor, in the unit that the joint's `sensor_gain` refers to; the last one when
        `fresh` is False. Default 0: there is no sensor.
    fresh : bool
        The reading is of this cycle. Default True.
    clipped : bool
        The sensor's converter is at the end of its range. Default False.
    current : float
        Active, in the motor [A]. Default: not a number, not known.
    torque : float
        Of that current, at the output [N·m]. Default: not a number.
    confirmed : bool
        The drive has confirmed the last command. When it has not, the recording marks the cycle: its torque
        is in doubt. Default True.
    velocity : float
        Measured by the drive, at the output [rad/s], for the controller. Default: not a number; the
        controller then gets the estimate from times and positions. The velocity limit holds for both.
    """

    time: float
    position: float
    reading: float = 0.0
    fresh: bool = True
    clipped: bool = False
    current: float = float("nan")
    torque: float = float("nan")
    confirmed: bool = True
    velocity: float = float("nan")


@dataclass(frozen=True, slots=True, kw_only=True, init=False)
class DriveEnd:
    """State of a drive after the command to switch its motor off.

    Attributes
    ----------
    state : {"off", "damped", "held", "braked", "on"} or None
        What it said of its motor when asked; None: it cannot be asked.
    failure : str
        Why it had shut the motor down by itself; empty when it had not.
    motor_off : bool or None
        Whether `state` is "off"; as an argument the older name of it, True for "off" and False for "on".
    """

    state: MotorState | None
    failure: str

    def __init__(
        self,
        *,
        state: MotorState | None = None,
        failure: str = "",
        motor_off: bool | None = None,
    ) -> None:
        object.__setattr__(self, "state", state_of(state, motor_off))
        object.__setattr__(self, "failure", failure)

    @property
    def motor_off(self) -> bool | None:
        """Whether it confirmed that its motor is off; None: it cannot be asked."""
        return is_off(self.state)


class Drive(Protocol):
    """A drive in torque control, seen from the output side of the gear: output angle, output torque.

    A session calls, from one thread:

    1. `bus_load`, `connect`, `problems`, `read`: the check. A reason, or an error, and the motor is never on.
    2. `enable`, then `read`.
    3. in each cycle of `period`, first on the way to the start of the trajectory, then along it: `read`,
       then `command`, waiting for the next cycle with `clock.sleep_until`.
    4. always, also when the check failed: `disable`, possibly several times, then `close`.

    All of them may raise DriveFaultError. Torque and position are positive in the same direction.
    A drive may have an attribute `tap`, None at first: if so, the session sets it to a callable
    (time [s], identifier, payload, whether sent) for the time of the run, to be called with each frame,
    for the frame log; with fd=True for a frame of CAN FD, extended=True for an identifier of 29 bits. It may
    have an attribute `resolution`, the output angle of an encoder count [rad],
    which `SessionOptions` must give otherwise; an attribute `joint`, a `Joint`; and a method `metadata`,
    which returns ``{"drive_type": name, "drive_options": …}``, of JSON's types. Both are kept in the
    recording, so that a replay of the frame log finds them. It may have a method `report`, which returns a
    `DriveReport` once it is connected, its motor off; and a method `fall_silent`, which returns a
    `DriveSilence`, for `first_motion(watchdog=True)`. It should have an attribute `watchdog`, a `Watchdog`:
    without it a bench gets no certificate.
    """

    @property
    def clock(self) -> Clock:
        """The clock that the samples are stamped by and the session is paced by.

        `MonotonicClock()` for a drive that exists, a clock of its own for one on virtual time. It must be
        the same object, or at least the same time, throughout.
        """

    def connect(self, period: float) -> None:
        """Bring the drive up, motor off, in torque control.

        Called once, before all but `bus_load`. May take seconds.

        Parameters
        ----------
        period : float
            Of the cycles to come [s]; a watchdog in the drive must not trip within a few of them.
        """

    def problems(self, torque_limit: float) -> list[str]:
        """Return reasons not to enable the motor, in sentences; an empty list when there are none.

        Parameters
        ----------
        torque_limit : float
            The session's, at the output [N·m]; infinite when there is none. A drive whose own limit is
            higher should report it here.
        """

    def enable(self) -> None:
        """Motor on, at zero torque; it is on when this returns. May take seconds."""

    def read(self, timeout: float) -> DriveSample:
        """Ask for the state and wait for it.

        The state must be of now: an answer to an earlier question is never one to this.

        Parameters
        ----------
        timeout : float
            [s]; three quarters of a period while the motor moves.

        Raises
        ------
        DriveFaultError
            "stale_position": nothing came in time. While the motor moves, the session then sends the last
            torque again and asks anew in the next cycle, a few times.
        """

    def command(self, torque: float) -> float:
        """Send a torque, which holds until the next one, without waiting.

        This also shows the drive that the host is alive: without it for some periods the drive should
        stop by itself, as nothing else stops a motor whose host hangs.

        Parameters
        ----------
        torque : float
            At the output [N·m], finite and within the session's limit.

        Returns
        -------
        float
            Torque accepted by the drive [N·m], after its own limit and rounding; the recording holds this.
        """

    def disable(self) -> DriveEnd | None:
        """Zero torque, then motor off, at once and even if a step fails; then check that it is off.

        Must do no harm to a motor that is off, or to a drive that was never connected. Called again when
        the motor was not seen off. Returns in bounded time, and raises nothing for a bus that fails.

        Returns
        -------
        DriveEnd or None
            Whether the motor was seen off; None: the drive cannot be asked.
        """

    def close(self) -> None:
        """Leave the drive and the bus as they were found. What was opened outside stays open."""

    @property
    def command_latency(self) -> float:
        """From sending a command until the drive acts on it [s]; 0 when it is not known.

        The recording's torque is the mean over a cycle; this says when in it the command changed.
        """

    def bus_load(self, period: float) -> float:
        """Share of the bus that a cycle of `period` [s] takes, 0 to 1; 0 where there is no bus."""

    def identity(self) -> dict[str, Any]:
        """What the drive is, for the recording: names and values of JSON's types."""


_METHODS = (
    *("connect", "problems", "enable", "read", "command", "disable", "close"),
    *("bus_load", "identity"),
)
_PROPERTIES = ("clock", "command_latency")


def check_drive(drive: object) -> None:
    """See that a drive has all that a session will call.

    Raises
    ------
    InputError
        Names what is missing.
    """
    kind = type(drive)
    missing = [f"{name}()" for name in _METHODS if not callable(getattr(drive, name, None))]
    # Looked up in the class first: a property of a drive that is not connected may refuse.
    missing += [name for name in _PROPERTIES if not (hasattr(kind, name) or hasattr(drive, name))]
    if missing:
        raise InputError(
            f"a drive is expected, but this has no {', '.join(missing)}",
            argument="drive",
            value=drive,
            remedy="see `jointid.hardware.Drive` for what a session needs of a drive",
        )
