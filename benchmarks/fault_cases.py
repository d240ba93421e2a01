"""Faults of a session, one by one on an emulated bus, and the required reaction to each.

`fault_matrix.py` prints the reactions; the tests compare them with this table.
"""

from __future__ import annotations

import math
import struct
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

import can

import jointid as jid
from jointid.hardware.elmo.drive import ElmoDrive
from jointid.hardware.elmo.emulated_converter import EmulatedConverter
from jointid.hardware.elmo.emulated_drive import ElmoSettings, EmulatedElmo
from jointid.hardware.elmo.options import ElmoOptions
from jointid.hardware.elmo.torque_source import AnalogInput
from jointid.hardware.emulated.bus import EmulatedBus
from jointid.hardware.emulated.faults import BusFault
from jointid.hardware.session.drive import DriveSample
from jointid.hardware.session.limits import SessionLimits
from jointid.hardware.session.session import Session, SessionOptions, SessionStoppedError, Stop
from jointid.simulation.stepped import stepped_joint

PERIOD = 2e-3  # [s]
BEGIN = 1.47  # [s] on the bus's clock, in the middle of the joint's motion
COMMAND, REPLY, POSITION, EMERGENCY, OURS, SENSOR = 0x37F, 0x2FF, 0x4FF, 0x0FF, 0x701, 0x1C0
REQUEST, ANSWER = 0x67F, 0x5FF  # of objects
TRUTH = {
    "coulomb": 25.0,
    "static": 20.0,
    "stribeck": 100.0,
    "viscous": 20.0,
    "sensor_gain": 2.4,
    "sensor_offset": 15.0,
}
ZERO = bytes.fromhex("54 43 00 80 00 00 00 00")  # TC = 0
OFF = bytes.fromhex("4D 4F 00 00 00 00 00 00")  # MO = 0


def joint() -> jid.Joint:
    """Return the thesis's joint with its link about the vertical, with its true parameters."""
    plain = jid.thesis_joint()
    assert plain.link is not None
    return plain.replace(link=replace(plain.link, angle=-math.pi / 2.0)).with_parameters(TRUTH)


class WatchedBus(EmulatedBus):
    """An emulated bus that keeps the host's frames and their times."""

    def __init__(self, *devices: Any, faults: tuple[BusFault, ...] = ()) -> None:
        self.tried: list[tuple[float, int, bytes]] = []
        super().__init__(*devices, faults=faults)

    def send(self, msg: can.Message, timeout: float | None = None) -> None:
        """Send a frame, and keep it."""
        self.tried.append((self.now(), msg.arbitration_id, bytes(msg.data)))
        super().send(msg, timeout)

    def assignments(self) -> list[tuple[float, bytes]]:
        """Return commands that change something in the drive."""
        return [
            (when, data) for when, sent, data in self.tried if sent == COMMAND and len(data) == 8
        ]


class EmulatedSession:
    """A session on an emulated bench to which faults can be applied.

    Parameters
    ----------
    faults : sequence of BusFault
    limits : mapping
        Limits that replace the joint's own.
    drive : ElmoOptions
    output : path, optional
    """

    def __init__(
        self,
        faults: tuple[BusFault, ...] = (),
        *,
        limits: Mapping[str, Any] | None = None,
        drive: ElmoOptions | None = None,
        output: Path | None = None,
    ) -> None:
        true = joint()
        self.elmo = EmulatedElmo(stepped_joint(true, period=PERIOD))
        self.converter = EmulatedConverter(self.elmo)
        self.bus = WatchedBus(self.elmo, self.converter, faults=faults)
        self.law: Any = jid.AdaptiveRobust(**jid.control_estimates(true))
        self.law = self.law.replace(friction_velocity="reference")
        self.trajectory = jid.Trajectory.thesis(math.radians(30.0), cycle=2.0, duration=2.0)
        self.limits = SessionLimits.of(true, **(limits or {}))
        self.drive = ElmoDrive(self.bus, true, drive)
        self.observer: Callable[[str, float, DriveSample, float, float], object] | None = None
        self.output = output

    def session(self) -> Session:
        """Return the session with the current settings."""
        options = SessionOptions(period=PERIOD, settle=0.1)
        return Session(
            *(self.drive, self.law, self.trajectory, self.limits),
            options=options,
            output=self.output,
            observer=self.observer,
        )

    def at(self, when: float, event: Callable[[], object]) -> None:
        """Call a function at a time on the bus's clock [s]."""

        def run() -> None:
            event()

        self.bus.at(when, run)


Script = Callable[[EmulatedSession], object]


@dataclass(frozen=True, kw_only=True)
class Case:
    """One fault.

    Attributes
    ----------
    name : str
    stop : str
        The expected `Stop.limit`.
    says : str
        Text that its message must contain.
    script : callable, optional
        Prepares the fault.
    faults : callable, optional
        Returns the bus's faults.
    limits : mapping
    drive : ElmoOptions, optional
    detected : float
        Latest detection after the fault [s].
    reachable : bool
        Whether the drive receives the host's frames; otherwise its own watchdog must switch it off.
    heard : bool
        Whether the host also receives the drive's frames, and so sees that the motor is off.
    """

    name: str
    stop: str
    says: str = ""
    script: Script | None = None
    faults: Callable[[], tuple[BusFault, ...]] = tuple
    limits: Mapping[str, Any] = field(default_factory=dict)
    drive: ElmoOptions | None = None
    detected: float = 3.0 * PERIOD
    reachable: bool = True
    heard: bool = True


@dataclass(frozen=True, kw_only=True)
class Outcome:
    """Outcome of a case."""

    stop: Stop
    recording: jid.Recording
    bench: EmulatedSession

    @property
    def detected(self) -> float:
        """Time from the fault to the session's stop [s]."""
        return self.stop.moment - BEGIN

    @property
    def commanded_off(self) -> float:
        """Time from the stop until TC = 0 and MO = 0 were sent [s]."""
        sent = self.bench.bus.assignments()
        last = [when for when, data in sent if data == OFF and when >= self.stop.moment]
        return last[0] - self.stop.moment if last else math.inf

    @property
    def motor_off(self) -> float:
        """Time from the stop until the motor was off [s]; negative if the drive was faster."""
        when, on = self.bench.elmo.switchings[-1]
        return math.inf if on else when - self.stop.moment


def outcome(case: Case, output: Path | None = None) -> Outcome:
    """Run a session into a fault."""
    bench = EmulatedSession(
        case.faults(),
        limits=case.limits,
        drive=case.drive,
        output=output,
    )
    if case.script is not None:
        case.script(bench)
    stopped: SessionStoppedError | None = None
    try:
        bench.session().run()
    except SessionStoppedError as error:
        stopped = error
    finally:
        bench.bus.shutdown()
    assert stopped is not None, f"{case.name}: the session was not stopped"
    assert stopped.recording is not None, f"{case.name}: too little was recorded: {stopped}"
    return Outcome(stop=stopped.stop, recording=stopped.recording, bench=bench)


# Actions at BEGIN.


def _set(what: str, value: Any) -> Script:
    """Set an attribute of the emulated drive."""
    return lambda bench: bench.at(BEGIN, lambda: setattr(bench.elmo, what, value))


def _fails(kind: str) -> Script:
    return lambda bench: bench.at(BEGIN, lambda: bench.elmo.fail(kind))


def _slips(angle: float) -> Script:
    """Move the encoder's zero by an output angle [rad]."""
    return _set("slipped_counts", round(angle / (2.0 * math.pi) * 808_000))


def _sticks(bench: EmulatedSession) -> None:
    bench.at(BEGIN, lambda: setattr(bench.elmo, "stuck_encoder", bench.elmo.counts()))


def _sensor_rails(bench: EmulatedSession) -> None:
    highest = (4095 * 128).to_bytes(4, "little")
    bench.at(BEGIN, lambda: setattr(bench.converter, "stuck", highest))


def _host_works(duration: float, times: int | None = None) -> Script:
    """Delay the host by this time at each frame [s], for this number of frames."""

    def script(bench: EmulatedSession) -> None:
        bench.at(BEGIN, lambda: setattr(bench.bus, "host_work", duration))
        if times is not None:
            bench.at(
                BEGIN + 0.5 * PERIOD + (times - 0.5) * duration,
                lambda: setattr(bench.bus, "host_work", 0.0),
            )

    return script


def _same_stamp(bench: EmulatedSession) -> None:
    """Let the drive show an old sample again."""
    read, last = bench.drive.read, list[DriveSample]()

    def stale(timeout: float) -> DriveSample:
        if bench.bus.now() < BEGIN:
            last[:] = [read(timeout)]
        return last[0]

    bench.drive.read = stale  # type: ignore[method-assign]


class Tampered:
    """A user's controller: equal to another one, until something happens in it."""

    def __init__(self, law: Any, bench: EmulatedSession, act: Callable[[float], float]) -> None:
        self._law, self._bench, self._act = law, bench, act
        self.saturations = 0

    def start(self, **given: Any) -> Tampered:
        """Start the controller."""
        self._law = self._law.start(**given)
        return self

    def step(self, **measured: float) -> float:
        """Return the torque [N·m]."""
        torque = float(self._law.step(**measured))
        return torque if self._bench.bus.now() < BEGIN else self._act(torque)


def _controller(act: Callable[[float], float]) -> Script:
    return lambda bench: setattr(bench, "law", Tampered(bench.law, bench, act))


def _refuses(torque: float) -> float:
    raise jid.InputError("too small", argument="torque", value=torque)


def _observer(error: BaseException) -> Script:
    def script(bench: EmulatedSession) -> None:
        def watch(*_: object) -> None:
            if bench.bus.now() >= BEGIN:
                raise error

        bench.observer = watch

    return script


def _bus(kind: str, *identifiers: int | None, **more: float) -> Callable[[], tuple[BusFault, ...]]:
    given: dict[str, Any] = {"start": BEGIN, **more}
    return lambda: tuple(
        BusFault(kind=kind, identifier=identifier, **given) for identifier in identifiers
    )


def foreign(
    identifier: int, payload: bytes, *, begin: float = BEGIN, every: float = 20e-3
) -> Script:
    """Let another master send a frame repeatedly [s]; the drive takes it for the host's."""

    def script(bench: EmulatedSession) -> None:
        def send(when: float) -> None:
            message = can.Message(arbitration_id=identifier, data=payload, is_extended_id=False)
            bench.bus.transmit(message)
            bench.bus.at(when + every, lambda: send(when + every))

        bench.bus.at(begin, lambda: send(begin))

    return script


def _deaf_to_the_sensor(bench: EmulatedSession) -> None:
    """Stop the drive's answers to AN."""
    reply = bench.elmo.reply

    def some(payload: bytes) -> None:
        if not (payload[:2] == b"AN" and bench.bus.now() >= BEGIN):
            reply(payload)

    bench.elmo.reply = some  # type: ignore[method-assign]


def _answers_wrongly(bench: EmulatedSession) -> None:
    """Let the drive use 1 A more than the command."""
    reply = bench.elmo.reply

    def changed(payload: bytes) -> None:
        if payload[:2] == b"TC" and bench.bus.now() >= BEGIN:
            current = struct.unpack_from("<f", payload, 4)[0]
            payload = payload[:4] + struct.pack("<f", current + 1.0)
        reply(payload)

    bench.elmo.reply = changed  # type: ignore[method-assign]


_WIDE = {"tracking_error": 10.0, "velocity": 1e4}
_SENSOR_AT_DRIVE = ElmoOptions(torque=AnalogInput())

CASES = (
    # The session's own limits.
    Case(name="joint leaves its window", stop="position", script=_slips(2.0), says="rad, outside",
         limits={"position": (-1.0, 1.0), **_WIDE}),
    Case(name="position jumps", stop="velocity", script=_slips(0.1), says="rad/s, more than 10 rad/s"),
    Case(name="joint is off its reference", stop="tracking_error", script=_slips(0.015),
         limits={"tracking_error": 0.01}, says="more than 0.01 rad"),
    Case(name="controller asks for too much", stop="torque", script=_controller(lambda t: t + 500.0),
         says="more than 159.984"),
    Case(name="controller asks for a value that is not finite", stop="torque", script=_controller(lambda _: math.nan),
         says="finite"),
    Case(name="command jumps", stop="torque_rate", script=_controller(lambda t: t + 150.0),
         limits={"torque_rate": 6e4}, says="N·m/s"),
    Case(name="command is cut for long", stop="saturated_samples", script=_set("stage_gain", 0.2),
         limits={"torque_difference": 1e3, **_WIDE}, says="21 times", detected=100 * PERIOD),
    Case(name="joint would leave its window", stop="position", script=_controller(lambda _: 150.0), limits=_WIDE,
         says="even immediate braking would stop", detected=300 * PERIOD),
    Case(name="command beyond what the joint needs", stop="torque_envelope", script=_set("stage_gain", 0.3),
         limits={"torque_envelope": 1.0, "torque_difference": 1e3, "saturated_samples": 1000, **_WIDE},
         says="is commanded, but", detected=60 * PERIOD),
    Case(name="torque has the wrong sign", stop="torque_sign", script=_set("stage_gain", -1.0),
         limits={"torque_difference": 1e3, "saturated_samples": 1000, **_WIDE},
         says="opposite signs", detected=40 * PERIOD),
    Case(name="current beyond the command", stop="measured_torque", script=_set("stage_gain", 4.0),
         limits={"torque_difference": 1e3, **_WIDE}, says="more than", detected=50 * PERIOD),
    Case(name="no current", stop="torque_difference", script=_set("stage_gain", 0.0), limits=_WIDE,
         says="is commanded", detected=50 * PERIOD),
    Case(name="encoder hangs", stop="repeated_positions", script=_sticks, limits=_WIDE,
         says="the encoder hangs", detected=15 * PERIOD),
    Case(name="sensor at its end", stop="clipped_samples", script=_sensor_rails, says="6 samples",
         detected=8 * PERIOD),
    Case(name="sensor's reading is not finite", stop="sensor", script=_set("stuck_voltage", math.nan),
         drive=_SENSOR_AT_DRIVE, says="finite", detected=6 * PERIOD),
    Case(name="sensor is not answered", stop="sensor", script=_deaf_to_the_sensor, detected=25 * PERIOD,
         drive=_SENSOR_AT_DRIVE, says="did not answer"),
    Case(name="host is late", stop="missed_deadlines", script=_host_works(0.8e-3), says="6 cycles",
         detected=10 * PERIOD),
    # The drive.
    Case(name="over-temperature", stop="drive_fault", script=_fails("over-temperature"),
         says="the drive reports: over-temperature"),
    Case(name="short circuit", stop="drive_fault", script=_fails("short circuit"), says="short circuit"),
    Case(name="encoder loss", stop="drive_fault", script=_fails("encoder loss"), says="feedback lost"),
    Case(name="under-voltage", stop="drive_fault", script=_fails("under-voltage"), says="under-voltage"),
    Case(name="drive's speed limit", stop="drive_fault", says="speed limit exceeded",
         script=_set("settings", ElmoSettings(speed_limit=1000.0))),
    Case(name="emergency is lost", stop="drive_fault", script=_fails("over-temperature"),
         faults=_bus("drop", EMERGENCY), says="the motor must be on (EC 58); the drive reports: over-temp"),
    Case(name="drive starts anew", stop="drive_fault", script=lambda b: b.at(BEGIN, b.elmo.restart),
         says="restarted"),
    Case(name="drive's heartbeat stays away", stop="heartbeat_lost", says="for",
         script=_set("silent_heartbeat", True), detected=0.06),
    # The host.
    Case(name="our heartbeat is lost", stop="host_heartbeat_lost", faults=_bus("drop", OURS),
         says="0x8130); the drive reports: heartbeat lost", detected=0.06),
    Case(name="host stands still", stop="host_heartbeat_lost", script=_host_works(0.08, 1),
         says="heartbeat lost", detected=0.09),
    Case(name="observer's file is full", stop="error", script=_observer(OSError("no space left")),
         says="OSError: no space left"),
    Case(name="controller refuses its input", stop="error", script=_controller(_refuses),
         says="InputError: torque is"),
    Case(name="Ctrl-C in user code", stop="user", script=_observer(KeyboardInterrupt()), says="keyboard"),
    # The bus.
    Case(name="position is lost", stop="late_samples", faults=_bus("drop", POSITION), says="SYNC",
         detected=6 * PERIOD),
    Case(name="five positions are lost", stop="late_samples", says="5 cycles in a row", detected=6 * PERIOD,
         faults=_bus("drop", POSITION, stop=BEGIN + 5 * PERIOD)),
    Case(name="SYNC is lost", stop="late_samples", faults=_bus("drop", 0x080), says="SYNC", detected=6 * PERIOD),
    Case(name="sensor's frame is lost", stop="late_samples", faults=_bus("drop", SENSOR), says="SYNC",
         detected=6 * PERIOD),
    Case(name="position is late", stop="late_samples", faults=_bus("delay", POSITION, delay=1.5e-3),
         detected=6 * PERIOD),
    Case(name="every eighth position is lost", stop="late_share", says="cycles of the last 5 s", detected=0.3,
         faults=lambda: tuple(
             BusFault(kind="drop", identifier=POSITION, start=BEGIN + k * PERIOD, stop=BEGIN + (k + 1) * PERIOD)
             for k in range(0, 400, 8))),
    Case(name="sample is stamped like the one before", stop="stale_position", script=_same_stamp,
         says="stamps must increase"),
    Case(name="position is garbled", stop="position", faults=_bus("corrupt", POSITION)),
    Case(name="replies are garbled", stop="drive_fault", faults=_bus("corrupt", REPLY), says="unreadable"),
    Case(name="replies are lost", stop="command_echo", faults=_bus("drop", REPLY), detected=8 * PERIOD,
         says="not acknowledged 5 torque commands"),
    Case(name="replies and answers are lost", stop="command_echo", faults=_bus("drop", REPLY, ANSWER),
         detected=8 * PERIOD, heard=False),
    Case(name="commands are lost, then switching off too", stop="command_echo",
         faults=_bus("drop", COMMAND), detected=8 * PERIOD, says="not acknowledged 5"),
    Case(name="five commands are lost", stop="command_echo", detected=8 * PERIOD,
         faults=_bus("drop", COMMAND, stop=BEGIN + 5 * PERIOD), says="not acknowledged 5"),
    Case(name="commands and objects are lost", stop="command_echo", detected=8 * PERIOD, heard=False,
         reachable=False, faults=_bus("drop", COMMAND, REQUEST)),
    Case(name="command is changed on its way", stop="command_echo", script=_answers_wrongly,
         says="acknowledges TC"),
    # Another master.
    Case(name="somebody else beats as our node", stop="foreign_master", script=foreign(OURS, b"\x05"),
         says="another node sends the heartbeat of node 1 (701h)"),
    Case(name="somebody else commands a current", stop="foreign_master",
         script=foreign(COMMAND, bytes.fromhex("54 43 00 80 00 00 80 3F"), every=PERIOD),
         says="commands the drive: TC = 1 (37F#544300800000803F)"),
    Case(name="somebody else stops the node", stop="foreign_master", script=foreign(0x000, b"\x02\x7f"),
         says="network command 'stop'"),
    Case(name="somebody else sends SYNC", stop="foreign_master", script=foreign(0x080, b"", every=PERIOD),
         says="SYNC, which it answers"),
    Case(name="somebody else writes an object", stop="foreign_master", says="access to object 6007h:0",
         script=foreign(REQUEST, bytes.fromhex("2B 07 60 00 00 00 00 00"), every=1.0)),
    Case(name="somebody else sends the control word", stop="foreign_master", says="a PDO (27F#0600)",
         script=foreign(0x27F, b"\x06\x00")),
    Case(name="first two switchings-off are lost", stop="error", script=_observer(OSError("late")),
         faults=_bus("drop", COMMAND, stop=BEGIN + 1.9 * PERIOD), says="late"),
    Case(name="error frame, off the bus for 3 ms", stop="bus", says="error frame",
         faults=_bus("bus_off", None, stop=BEGIN + 1.5 * PERIOD)),
    Case(name="bus off", stop="bus", faults=_bus("bus_off", None), says="bus-off:",
         reachable=False, heard=False),
    Case(name="interface down", stop="bus", faults=_bus("down", None), says="down",
         reachable=False, heard=False),
)  # fmt: skip
