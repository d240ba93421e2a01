"""Session: a controller moves a joint along a trajectory, through a drive, within limits."""

from __future__ import annotations

from collections.abc import Callable
from contextlib import suppress
from dataclasses import replace
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

import numpy as np

from jointid import _core
from jointid.hardware.session.braking import Braked, brake_after
from jointid.hardware.session.control_loop import Course, Follower, Observer, unwritten
from jointid.hardware.session.drive import Drive, DriveEnd, DriveFaultError, check_drive
from jointid.hardware.session.foresight import foresight_of
from jointid.hardware.session.gains import doubt_of_gains
from jointid.hardware.session.guard import Guard
from jointid.hardware.session.interruptions import Interruptions
from jointid.hardware.session.limits import SessionLimits
from jointid.hardware.session.metadata import motion_metadata, plain, session_metadata
from jointid.hardware.session.moving_joint import MovingJoint, breakaway
from jointid.hardware.session.options import SessionOptions, check_cycles, with_resolution
from jointid.hardware.session.outcome import ending_of, recording_of, stop_of
from jointid.hardware.session.realtime import RealTime, RealTimeOptions
from jointid.hardware.session.recorder import Recorder, check_output
from jointid.hardware.session.start_checks import (
    approach_time,
    approach_to,
    check_approach,
    problems_at_rest,
    problems_of_drive,
    problems_on_paper,
)
from jointid.hardware.session.stop import (
    LimitError,
    SessionRefusedError,
    SessionStoppedError,
    Stop,
    is_bug,
    noted,
)
from jointid.hardware.session.watchdog_check import slow_watchdog
from jointid.joint.joint import Joint
from jointid.recording.recording import Recording
from jointid.simulation.arguments import Controller
from jointid.simulation.designed_for import DesignedFor
from jointid.simulation.trajectory import Trajectory

__all__ = [
    "Session",
    "SessionLimits",
    "SessionOptions",
    "SessionRefusedError",
    "SessionStoppedError",
    "Stop",
]


class Session:
    """One run on a joint: check, enable, move to the start, settle, run, stop.

    At the end, also after an error, the session commands zero torque and switches the motor off. Then it asks the
    drive to confirm that the motor is off.

    Parameters
    ----------
    drive : Drive
        Any object with the methods of `Drive`. `open_drive` opens the drive of a bench.
    controller : OpenLoop, Pd, Pid, CompensatedPid, AdaptiveRobust or LugreObserver
        A controller of the simulator. The core computes its control law.
    trajectory : Trajectory
    limits : SessionLimits
    options : SessionOptions
    output : path, optional
        Name of the .csv file of the recording. The frames are written to a .log file with the same name.
    observer : callable, optional
        Function that is called with (phase, time, sample, reference, torque) in each cycle, e.g. for a plot. An
        exception in this function ends the session.
    real_time : RealTimeOptions, optional
        Settings of the operating system while the motor is on. The recording's metadata list the settings that the
        system did not grant. Default: none.
    joint : Joint, optional
        Joint of the limits that predict the motion from inertia, friction and weight. Default: the drive's `joint`.
    designed_for : DesignedFor, optional
        Joint, controller and period that the motion was designed for. The recording's metadata list the differences
        of the session. Default: not known.

    Attributes
    ----------
    recording : Recording or None
        Recording of the last run, also after an error; None before a run or with too few samples.

    Raises
    ------
    InputError
        The drive lacks a method, or the encoder's resolution is not known.
    """

    def __init__(
        self,
        drive: Drive,
        controller: Controller,
        trajectory: Trajectory,
        limits: SessionLimits,
        *,
        options: SessionOptions | None = None,
        output: str | Path | None = None,
        observer: Observer | None = None,
        real_time: RealTimeOptions | None = None,
        joint: Joint | None = None,
        designed_for: DesignedFor | None = None,
    ) -> None:
        check_drive(drive)
        self._drive, self._controller, self._trajectory = drive, controller, trajectory
        self._limits = limits
        moved = getattr(drive, "joint", None) if joint is None else joint
        self._joint = moved if isinstance(moved, Joint) else None
        self._moved, self._breakaway = MovingJoint.of(moved), breakaway(moved)
        self._options = with_resolution(options if options is not None else SessionOptions(), drive)
        self._designed = motion_metadata(
            designed_for, trajectory, moved, controller, self._options.period
        )
        self._output = None if output is None else Path(output)
        self._observer = observer
        self._real_time = RealTime(real_time)
        self._follower: Follower | None = None
        self._end: DriveEnd | None = None
        self._bug: Exception | None = None
        self._braked: Braked | None = None
        self.recording: Recording | None = None

    def check(self) -> list[str]:
        """Connect the drive and return the reasons not to enable the motor. The motor stays off.

        Returns
        -------
        list of str
            Reasons as sentences; empty if all pre-flight checks pass.

        Raises
        ------
        InputError
            The trajectory or the motion to its start has more cycles than a session can record.
        """
        options, limits = self._options, self._limits
        check_cycles("trajectory.duration", self._trajectory.duration, options.period)
        reasons = list(
            problems_on_paper(
                self._drive, self._controller, self._trajectory, limits, options, self._moved
            )
        )
        if reasons:
            return reasons
        self._drive.connect(options.period)
        reasons += problems_of_drive(self._drive, limits)
        sample = self._drive.read(10.0 * options.period)
        reasons += problems_at_rest(sample, limits)
        if not isinstance(self._controller, _core.OpenLoop):
            check_approach(self._start() - sample.position, options)
        watched = (self._joint, self._controller, self._trajectory, limits, options)
        return reasons + slow_watchdog(self._drive, *watched, position=sample.position)

    def run(self, *, dry_run: bool = False) -> Recording | None:
        """Run the session.

        Parameters
        ----------
        dry_run : bool
            Whether to check only: the motor stays off, and the result is None. Default False.

        Returns
        -------
        Recording
            Recording of the run. Its `metadata` has timing, limits, the drive's identity, and whether the motor is
            confirmed off.

        Raises
        ------
        InputError
            As in `check`.
        SessionRefusedError
            A pre-flight check failed, or the drive raised a DriveFaultError or an OSError during the check.
        SessionStoppedError
            A limit, a fault or the user stopped the session. The error holds the recording.
        Exception
            A bug in drive, controller, observer or session. The exception is raised again after the motor is off and
            the recording is closed. A note in the exception states how the session ended. The attribute `recording`
            has the samples.

        Examples
        --------
        >>> recording = jid.hardware.Session(drive, bench.controller, bench.trajectory, bench.limits).run()
        """
        recorder: Recorder | None = None
        cause: Exception | KeyboardInterrupt | None = None
        self._follower, self._end, self._bug, self.recording = None, None, None, None
        self._braked = None
        early: list[tuple[Any, dict[str, Any]]] = []  # frames before the recorder exists
        if self._output is not None and not dry_run:
            check_output(self._output)
            self._tap(lambda *frame, **kind: early.append((frame, kind)))
        try:
            with Interruptions() as interruptions:
                try:
                    self._refuse_or_go_on()
                    if dry_run:
                        if interruptions.reason is not None:
                            raise KeyboardInterrupt
                    else:
                        if self._output is not None:
                            recorder = self._recorder(self._output)
                            for frame, kind in early:
                                recorder.frame(*frame, **kind)
                            self._tap(recorder.frame)
                        with self._real_time:
                            cause, moment = self._guarded(recorder, interruptions)
                finally:
                    self._leave()
            if dry_run:
                if self._bug is not None:
                    raise self._bug
                return None
            if cause is None and interruptions.reason is not None:
                cause = LimitError("user", interruptions.reason)  # requested at the end of the run
            if cause is None and self._end is not None and self._end.motor_off is False:
                cause = DriveFaultError(
                    "drive_fault", "the run has ended, but the motor is not off"
                )
            stop = None if cause is None else stop_of(cause, moment, self._follower, self._end)
            if recorder is not None:
                try:
                    recorder.close(self._ending(stop))
                except Exception as error:
                    self._note_bug(error)
                    if cause is None:
                        cause = unwritten(error)
                        stop = stop_of(cause, moment, self._follower, self._end)
        finally:
            if recorder is not None:
                with suppress(Exception):  # another exception follows, or this error is known
                    recorder.close()
        if cause is not None:
            self._note_bug(cause)
        try:
            self.recording = self._recording(stop)
        except Exception as error:  # it must not hide a bug or a stop
            unmade = f"the recording cannot be made: {type(error).__name__}: {error}"
            self._note_bug(error)
            if cause is None:
                cause = LimitError("recording", unmade)
                stop = stop_of(cause, moment, self._follower, self._end)
        else:
            unmade = ""
        if self._bug is not None:
            self._bug.add_note(
                "the session was completed" if stop is None else f"the session was {stop}"
            )
            raise noted(self._bug, unmade)
        if stop is not None:
            raise noted(SessionStoppedError(stop, self.recording), unmade) from cause
        return self.recording

    def _recorder(self, output: Path) -> Recorder:
        # The date is only in the file, so that a repeated session returns identical bits.
        started = datetime.now(UTC).isoformat(timespec="milliseconds")
        try:
            return Recorder(output, {**self._metadata(), "started": started}, output.stem)
        except OSError as error:
            raise SessionRefusedError(f"not started: {unwritten(error)}") from error

    # The phases.

    def _refuse_or_go_on(self) -> None:
        try:
            reasons = self.check()
        except DriveFaultError as error:
            raise SessionRefusedError(f"not started: {error}") from error
        except OSError as error:  # from the drive; nothing else is open at this point
            raise SessionRefusedError(f"not started: {type(error).__name__}: {error}") from error
        if reasons:
            raise SessionRefusedError("not started: " + "; ".join(reasons))

    def _guarded(
        self, recorder: Recorder | None, interruptions: Interruptions
    ) -> tuple[Exception | KeyboardInterrupt | None, float]:
        """Enable, move, settle and run. Return the cause and time of an early end, if any. The motor is off then."""
        options, limits = self._options, self._limits
        try:
            feedback = not isinstance(self._controller, _core.OpenLoop)
            law = self._controller.start(period=options.period, torque_limit=limits.torque)
            course = Course.of(self._trajectory, options.period)
            assert options.resolution is not None, "see __init__"
            watching = foresight_of(self._moved, self._drive, limits, options)
            doubt = doubt_of_gains(self._controller, self._moved, options.period)
            follower = Follower(
                self._drive,
                law,
                Guard(limits, options.period, options.resolution, watching, self._breakaway, doubt),
                options,
                interruptions=interruptions,
                observer=self._observer,
                feedback=feedback,
            )
            self._follower = follower
            if interruptions.reason is not None:
                raise LimitError("user", interruptions.reason)
            follower.enter("enable")
            self._drive.enable()
            if feedback:
                self._approach(follower)
            follower.enter("run")
            follower.follow(course, recorder)
        except (Exception, KeyboardInterrupt) as error:
            moment = self._drive.clock.now()
            self._brake(error)
            self._switch_off()
            return error, moment
        moment = self._drive.clock.now()
        self._switch_off()
        return None, moment

    def _approach(self, follower: Follower) -> None:
        """Move smoothly to the start of the trajectory and stop there."""
        options = self._options
        here = self._drive.read(10.0 * options.period).position
        distance = self._start() - here
        course = Course.of(approach_to(distance, options), options.period)
        follower.enter("move")
        follower.follow(course, None, offset=here, settled=approach_time(distance, options))

    def _start(self) -> float:
        """Return the first position of the trajectory [rad]."""
        return float(self._trajectory.sample(np.zeros(1))[0][0])

    # Endings.

    def _brake(self, cause: BaseException) -> None:
        """Brake the joint to rest if this is safe. The motor is switched off next in any case."""
        try:
            self._braked = brake_after(
                cause, self._drive, self._moved, self._limits, self._options, self._follower
            )
        except (DriveFaultError, OSError, KeyboardInterrupt):
            return  # the drive has failed, or the user pressed Ctrl-C repeatedly
        except Exception as bug:
            self._note_bug(bug)

    def _switch_off(self) -> None:
        """Command zero torque and switch the motor off. An exception of the drive must not prevent the next steps."""
        try:
            self._end = self._drive.disable()
        except (Exception, KeyboardInterrupt) as error:
            self._note_bug(error)
            self._end = DriveEnd(state="on", failure=f"{type(error).__name__}: {error}")

    def _leave(self) -> None:
        """Switch the motor off and close the drive."""
        if self._end is None or not self._end.motor_off:
            self._switch_off()
        try:
            self._drive.close()
        except Exception as error:  # it must not hide the reason of the session's end
            self._note_bug(error)
            end = self._end if self._end is not None else DriveEnd()
            self._end = replace(
                end, failure=f"{end.failure} {type(error).__name__}: {error}".strip()
            )
        self._tap(None)

    def _note_bug(self, error: BaseException) -> None:
        """Keep the first bug. It is raised after the motor is off and everything is closed."""
        if self._bug is None and isinstance(error, Exception) and is_bug(error):
            self._bug = error

    def _tap(self, tap: Callable[..., object] | None) -> None:
        if hasattr(self._drive, "tap"):
            self._drive.tap = tap

    # Recording and metadata.

    def _metadata(self) -> dict[str, Any]:
        known = session_metadata(
            self._drive, self._controller, self._trajectory, self._limits, self._options
        )
        return known | self._designed

    def _ending(self, stop: Stop | None) -> dict[str, Any]:
        ending = ending_of(self._follower, self._end, stop, self._real_time.notes)
        return ending if self._braked is None else {**ending, "braked": plain(self._braked)}

    def _recording(self, stop: Stop | None) -> Recording | None:
        metadata = {**self._metadata(), "session": True, **self._ending(stop)}
        name = "" if self._output is None else self._output.stem
        return recording_of(self._follower, name, metadata)
