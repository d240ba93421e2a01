"""The scenarios on vcan: what is done to drive, session and bus in the guest, and what must come of it, outside."""

from __future__ import annotations

import signal
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any

from canlab.bridge import bridged
from canlab.outcome import MASTER, PERIOD, Outcome
from canlab.stage import Stage, switched_off

COMMAND = 0x37F
TORQUE = bytes.fromhex("544300800000803F")  # TC = 1 A
_SOME = 20  # cycles of the run


@dataclass(frozen=True)
class Scenario:
    """One of them.

    Attributes
    ----------
    act : callable
        Plays it on a stage; its documentation says what happens.
    check : callable
        Judges the outcome.
    """

    act: Callable[[Stage], None]
    check: Callable[[Outcome], None]


# Nothing goes wrong.


def plain(stage: Stage) -> None:
    """A whole session, and the emulated drive is ended by Ctrl-C."""
    drive = stage.emulator()
    stage.session().wait()
    stage.until(lambda: switched_off(drive), "the motor stays on")
    drive.signal(signal.SIGINT)
    stage.notes["status"] = drive.wait()


def plain_checked(outcome: Outcome) -> None:
    session = outcome.session()
    assert session["ended"] == "done", session
    assert session["motor_off"] is True
    recording = outcome.recording()
    assert len(recording) == 50
    assert recording.metadata["motor_off"] is True
    outcome.off_by_the_session()
    assert outcome.notes["status"] == 130


# The host.


def host_killed(stage: Stage) -> None:
    """The session's program is killed while the joint moves."""
    drive, session = stage.emulator(), stage.session()
    session.reach("run", _SOME)
    session.signal(signal.SIGKILL)
    stage.until(lambda: switched_off(drive), "the motor stays on")


def host_killed_checked(outcome: Outcome) -> None:
    outcome.off_by_the_watchdog()
    outcome.left_by_a_killed_session()


def host_stopped(stage: Stage) -> None:
    """The session's program stands still until the drive has stopped by itself, and goes on then."""
    drive, session = stage.emulator(), stage.session()
    session.reach("run", _SOME)
    session.signal(signal.SIGSTOP)
    stage.until(lambda: switched_off(drive), "the motor stays on")
    session.signal(signal.SIGCONT)
    session.wait()


def host_stopped_checked(outcome: Outcome) -> None:
    outcome.off_by_the_watchdog()
    outcome.stopped("host_heartbeat_lost", seen_off=True)


# The drive.


def drive_killed(stage: Stage) -> None:
    """The drive is gone from one moment to the next."""
    drive, session = stage.emulator(), stage.session()
    session.reach("run", _SOME)
    drive.signal(signal.SIGKILL)
    session.wait()


def drive_killed_checked(outcome: Outcome) -> None:
    outcome.stopped("late_samples", seen_off=False)


def drive_stopped(stage: Stage) -> None:
    """The drive's program stands still, and goes on when the session has given up."""
    drive, session = stage.emulator(), stage.session()
    session.reach("run", _SOME)
    drive.signal(signal.SIGSTOP)
    session.wait()
    drive.signal(signal.SIGCONT)
    stage.until(lambda: switched_off(drive), "the motor stays on")


def drive_stopped_checked(outcome: Outcome) -> None:
    outcome.stopped("late_samples", seen_off=False)
    outcome.off_in_time()


def drive_restarted(stage: Stage) -> None:
    """The drive loses its power, and comes back at once."""
    drive, session = stage.emulator(), stage.session()
    session.reach("run", _SOME)
    drive.end()
    again = stage.emulator("again")
    session.wait()
    stage.until(lambda: again.events(), "it does not begin again")


def drive_restarted_checked(outcome: Outcome) -> None:
    outcome.stopped("late_samples", "drive_fault", seen_off=True)  # as long as it was away
    assert not any(event["motor_on"] for event in outcome.events("again"))


# The bus.


def link_down(stage: Stage) -> None:
    """The network goes down, and comes up again when all have stopped; then there is another session."""
    drive, session = stage.emulator(), stage.session()
    session.reach("run", _SOME)
    stage.link("down")
    session.wait()
    stage.until(lambda: switched_off(drive), "the motor stays on")
    stage.link("up")
    stage.session("second", _acknowledging).wait()


def _acknowledging(bench: Any) -> Any:
    return replace(bench, drive=replace(bench.drive, acknowledge=True))


def link_down_checked(outcome: Outcome) -> None:
    outcome.stopped("bus", seen_off=False)
    outcome.off_by_the_watchdog()
    second = outcome.session("second")
    assert second["ended"] == "done", second
    assert second["motor_off"] is True


def bus_off(stage: Stage) -> None:
    """The CAN controller reports that it has left the bus."""
    stage.emulator()
    session = stage.session()
    session.reach("run", _SOME)
    stage.send((0x40, bytes(8)), error=True)
    session.wait()


def bus_off_checked(outcome: Outcome) -> None:
    assert "bus-off" in outcome.stopped("bus", seen_off=True)["message"]
    outcome.off_by_the_session()


def flood(stage: Stage) -> None:
    """Another node sends a frame of the highest priority thousands of times."""
    drive, session = stage.emulator(), stage.session()
    session.reach("run", _SOME)
    stage.send(*(((0x001, bytes(8)),) * 3000))
    session.wait()
    stage.until(lambda: switched_off(drive), "the motor stays on")


def flood_checked(outcome: Outcome) -> None:
    session = outcome.session()
    if session["ended"] != "done":  # the kernel drops what a program does not read in time
        limits = "late_samples", "late_share", "command_echo", "host_heartbeat_lost"
        outcome.stopped(*limits, seen_off=None)
    outcome.off_in_time()


def lost_frames(stage: Stage) -> None:
    """Single answers of the drive are lost."""
    bridged(stage, lambda number: None if number % 20 == 0 else 0.0)
    stage.session(changes=_tolerant).wait()


def late_frames(stage: Stage) -> None:
    """Single answers of the drive come when their cycle is over."""
    bridged(stage, lambda number: 1.2 * PERIOD if number % 20 == 0 else 0.0)
    stage.session(changes=_tolerant).wait()


def _tolerant(bench: Any) -> Any:
    return replace(bench, limits=replace(bench.limits, late_share=0.2))


def flagged(outcome: Outcome) -> None:
    session = outcome.session()
    assert session["ended"] == "done", session
    late = outcome.recording().late
    assert late is not None
    assert (late >= 1.0).sum() >= 2
    outcome.off_by_the_session()


# Other masters.


def foreign_command(stage: Stage) -> None:
    """Another program commands a torque."""
    stage.emulator()
    session = stage.session()
    session.reach("run", _SOME)
    stage.send(*(((COMMAND, TORQUE),) * 3))
    session.wait()


def foreign_command_checked(outcome: Outcome) -> None:
    outcome.stopped("foreign_master", "command_echo", seen_off=True)
    assert outcome.cycles_after(COMMAND, TORQUE) <= 10
    outcome.off_by_the_session()


def foreign_heartbeat(stage: Stage) -> None:
    """Another node begins to beat as the session's."""
    stage.emulator()
    session = stage.session()
    session.reach("run", _SOME)
    stage.beat(MASTER)
    session.wait()


def foreign_heartbeat_checked(outcome: Outcome) -> None:
    outcome.stopped("foreign_master", seen_off=True)
    assert outcome.cycles_after(MASTER, b"\x05") <= 10
    outcome.off_by_the_session()


def heartbeat_before(stage: Stage) -> None:
    """Another node has been beating as the session's."""
    stage.emulator()
    stage.beat(MASTER)
    stage.session().wait()


def heartbeat_before_checked(outcome: Outcome) -> None:
    assert outcome.session()["ended"] == "refused", outcome.session()
    assert not any(event["motor_on"] for event in outcome.events())


def network_stop(stage: Stage) -> None:
    """Another master stops all nodes."""
    stage.emulator()
    session = stage.session()
    session.reach("run", _SOME)
    stage.send((0x000, b"\x02\x00"))
    session.wait()


def network_stop_checked(outcome: Outcome) -> None:
    outcome.stopped("foreign_master", "drive_fault", seen_off=True)
    outcome.off_in_time()


def second_session(stage: Stage) -> None:
    """A second session is started while the first one moves the joint."""
    stage.emulator()
    session = stage.session()
    session.reach("run", _SOME)
    stage.session("second").wait()
    session.wait()


def second_session_checked(outcome: Outcome) -> None:
    assert outcome.session("second")["ended"] == "refused", outcome.session("second")
    assert outcome.session()["ended"] == "done", outcome.session()
    outcome.off_by_the_session()


SCENARIOS: dict[str, Scenario] = {
    "plain": Scenario(plain, plain_checked),
    "host_killed": Scenario(host_killed, host_killed_checked),
    "host_stopped": Scenario(host_stopped, host_stopped_checked),
    "drive_killed": Scenario(drive_killed, drive_killed_checked),
    "drive_stopped": Scenario(drive_stopped, drive_stopped_checked),
    "drive_restarted": Scenario(drive_restarted, drive_restarted_checked),
    "link_down": Scenario(link_down, link_down_checked),
    "bus_off": Scenario(bus_off, bus_off_checked),
    "flood": Scenario(flood, flood_checked),
    "lost_frames": Scenario(lost_frames, flagged),
    "late_frames": Scenario(late_frames, flagged),
    "foreign_command": Scenario(foreign_command, foreign_command_checked),
    "foreign_heartbeat": Scenario(foreign_heartbeat, foreign_heartbeat_checked),
    "heartbeat_before": Scenario(heartbeat_before, heartbeat_before_checked),
    "network_stop": Scenario(network_stop, network_stop_checked),
    "second_session": Scenario(second_session, second_session_checked),
}
