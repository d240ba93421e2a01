"""Interface between a session and a drive: an object with these methods. No base class is needed.

`docs/hardware.md` shows a complete drive in sixty lines.
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
    """The drive or the connection to it has failed; the session stops.

    A drive should raise no other exception. `kind` becomes the name of the stop. An OSError or InputError stops the
    session with the name "error". Before the motor is on, a DriveFaultError or an OSError refuses the session. Any
    other exception is a bug. The session raises it again after its end.

    Parameters
    ----------
    kind : str
        "stale_position": no new state in time. While the motor moves, a session tolerates this for a few cycles
        (`SessionLimits.late_samples`). "drive_fault": the drive has shut down or refuses a command. "heartbeat_lost":
        the drive does not answer. "host_heartbeat_lost": the drive reports that the host does not answer. "bus": the
        bus has failed. "sensor": a reading is missing or not finite. "foreign_master": another master commands the
        drive or feeds its watchdog. "command_echo": the drive does not acknowledge the torque, or acknowledges
        another torque.
    message : str
        One sentence on the cause, with the numbers.
    measured, allowed : float, optional
        Value beyond a limit, and this limit.
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
            raise InputError(f"choose one of {', '.join(FAULT_KINDS)}", argument="kind", value=kind)
        super().__init__(message)
        self.kind, self.measured, self.allowed = kind, measured, allowed


@dataclass(frozen=True, slots=True, kw_only=True)
class DriveSample:
    """State of a drive in one cycle.

    Attributes
    ----------
    time : float
        Time of the position [s] on the drive's `clock`. If this time is not later than in the previous cycle, the
        session stops with "stale_position".
    position : float
        Position at the output [rad]. A value that is not finite stops the session.
    reading : float
        Raw reading of the torque sensor, in the unit that the joint's `sensor_gain` converts. If `fresh` is False, it
        is the previous reading. Default 0: no sensor.
    fresh : bool
        Whether the reading belongs to this cycle. Default True.
    clipped : bool
        Whether the sensor's converter is at the end of its range. Default False.
    current : float
        Active motor current [A]. Default: NaN, not known.
    torque : float
        Torque of the active motor current at the output [N·m]. Default: NaN.
    confirmed : bool
        Whether the drive has confirmed the last command. Otherwise, the recording marks the cycle, because its torque
        is uncertain. Default True.
    velocity : float
        Velocity at the output [rad/s], measured by the drive. Default: NaN; the controller then uses an estimate from
        times and positions. The velocity limit applies to the measured and to the estimated velocity.
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
        State of the motor that the drive reported; None if the drive cannot report it.
    failure : str
        Reason why the drive had already shut down the motor; empty if it had not.
    motor_off : bool or None
        Whether `state` is "off". As an argument, `motor_off` is the former name of `state`: True means "off", False
        means "on".
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
        """Whether the drive confirmed that its motor is off; None if the drive cannot report this."""
        return is_off(self.state)


class Drive(Protocol):
    """A drive in torque control. All positions and torques are values at the output of the gear.

    A session calls these methods from one thread:

    1. For the check: `bus_load`, `connect`, `problems`, `read`. After a problem or an error, the motor stays off.
    2. To start: `enable`, then `read`.
    3. In each cycle of `period`: `read`, then `command`, then `clock.sleep_until` until the next cycle. The joint
       first moves to the start of the trajectory, then along the trajectory.
    4. At the end, also after a failed check: `disable`, possibly several times, then `close`.

    All methods may raise DriveFaultError. Torque and position are positive in the same direction. Optional attributes
    and methods:

    - `tap`: None at first. During a run, the session sets `tap` to a callable for the frame log. The drive calls it
      for each frame with (time [s], identifier, payload, whether sent). It adds fd=True for a CAN FD frame and
      extended=True for an identifier of 29 bits.
    - `resolution`: output angle of one encoder count [rad]. Without this attribute, `SessionOptions` must state the
      resolution.
    - `joint`: a `Joint`. `metadata`: a method that returns ``{"drive_type": name, "drive_options": …}`` in JSON
      types. The recording keeps type and options for a replay of the frame log.
    - `report`: a method that returns a `DriveReport` when the drive is connected and its motor is off.
    - `fall_silent`: a method that returns a `DriveSilence`, for `first_motion(watchdog=True)`.
    - `watchdog`: a `Watchdog`. Without this attribute, a bench gets no certificate.
    """

    @property
    def clock(self) -> Clock:
        """Clock of the time stamps and of the session's cycles.

        Use `MonotonicClock()` for a real drive, and a virtual clock for an emulated one. Its zero must not change
        during a session.
        """

    def connect(self, period: float) -> None:
        """Connect the drive, with the motor off, in torque control.

        The session calls this method once, before all others except `bus_load`. May take seconds.

        Parameters
        ----------
        period : float
            Period of the control cycles [s]. The drive's watchdog must not trip within a few periods.
        """

    def problems(self, torque_limit: float) -> list[str]:
        """Return the reasons not to enable the motor, as sentences; an empty list if there are none.

        Parameters
        ----------
        torque_limit : float
            Torque limit of the session at the output [N·m]; infinite without a limit. If the drive's own limit is
            higher, the drive should report this as a problem.
        """

    def enable(self) -> None:
        """Switch the motor on at zero torque. The motor is on when this method returns. May take seconds."""

    def read(self, timeout: float) -> DriveSample:
        """Request the drive's state and wait for the answer.

        The state must be current: an answer to an earlier request does not count.

        Parameters
        ----------
        timeout : float
            Longest wait [s]. While the motor moves, it is three quarters of a period.

        Raises
        ------
        DriveFaultError
            "stale_position": no answer in time. While the motor moves, the session tolerates this for a few cycles.
            It then repeats the last torque, and requests the state again in the next cycle.
        """

    def command(self, torque: float) -> float:
        """Send a torque without waiting. The drive holds this torque until the next command.

        The command is also a sign of life. After some periods without a command, the drive should stop the motor.
        Nothing else stops the motor if the host hangs.

        Parameters
        ----------
        torque : float
            Torque at the output [N·m], finite and within the session's limit.

        Returns
        -------
        float
            Torque that the drive accepted [N·m], after its own limit and rounding; the recording keeps this value.
        """

    def disable(self) -> DriveEnd | None:
        """Command zero torque, switch the motor off, and check that it is off. Continue if a step fails.

        This method must be harmless if the motor is off or the drive was never connected. If the motor is not
        confirmed off, the session calls this method again. The method must return in bounded time, and must not raise
        if the bus fails.

        Returns
        -------
        DriveEnd or None
            State of the motor after this call; None if the drive cannot report it.
        """

    def close(self) -> None:
        """Restore the drive and the bus to their initial state. Do not close a bus that the caller opened."""

    @property
    def command_latency(self) -> float:
        """Delay from sending a command until the drive acts on it [s]; 0 if not known.

        The recording's torque is the mean over a cycle; this delay shows when the torque changed within the cycle.
        """

    def bus_load(self, period: float) -> float:
        """Return the bus load, 0 to 1, with cycles of `period` [s]; 0 without a bus."""

    def identity(self) -> dict[str, Any]:
        """Return the identity of the drive for the recording: names and values in JSON types."""


_METHODS = (
    *("connect", "problems", "enable", "read", "command", "disable", "close"),
    *("bus_load", "identity"),
)
_PROPERTIES = ("clock", "command_latency")


def check_drive(drive: object) -> None:
    """Check that a drive has all methods and attributes that a session uses.

    Raises
    ------
    InputError
        A method or attribute is missing; the message names it.
    """
    kind = type(drive)
    missing = [f"{name}()" for name in _METHODS if not callable(getattr(drive, name, None))]
    # The class is checked first, because a property of a drive that is not connected may raise.
    missing += [name for name in _PROPERTIES if not (hasattr(kind, name) or hasattr(drive, name))]
    if missing:
        raise InputError(
            f"a drive is expected, but this object has no {', '.join(missing)}",
            argument="drive",
            value=drive,
            remedy="see `jointid.hardware.Drive` for the methods that a session needs",
        )
