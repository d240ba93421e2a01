"""A session: a joint moved along a trajectory by a controller, through a drive, within limits."""

from __future__ import annotations

import math
from collections.abc import Callable
from contextlib import suppress
from dataclasses import replace
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

import numpy as np

from jointid import _core
from jointid.base.errors import InputError
from jointid.hardware.session.control_loop import Course, Follower, Observer, unwritten
from jointid.hardware.session.drive import Drive, DriveEnd, DriveFaultError, check_drive
from jointid.hardware.session.guard import Guard
from jointid.hardware.session.interruptions import Interruptions
from jointid.hardware.session.limits import SessionLimits
from jointid.hardware.session.metadata import session_metadata
from jointid.hardware.session.options import SessionOptions
from jointid.hardware.session.realtime import RealTime, RealTimeOptions
from jointid.hardware.session.recorder import Frame, Recorder, check_output
from jointid.hardware.session.start_checks import problems_at_rest, problems_on_paper
from jointid.hardware.session.stop import LimitError, SessionRefusedError, SessionStoppedError, Stop
from jointid.recording.recording import Recording
from jointid.simulation.arguments import Controller
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

    Every way out leaves zero torque and the motor off, and asks the drive whether it is.

    Parameters
    ----------
    drive : Drive
        Anything with a drive's methods; `open_drive` gives a bench's.
    controller : OpenLoop, Pd, Pid, CompensatedPid, AdaptiveRobust or LugreObserver
        The simulator's own; its law is computed in the core.
    trajectory : Trajectory
    limits : SessionLimits
    options : SessionOptions
    output : path, optional
        The recording grows in this .csv, the frames in a .log beside it.
    observer : callable, optional
        Called with (phase, time, sample, reference, torque) in each cycle; for a console or a plot. What
        it raises stops the session.
    real_time : RealTimeOptions, optional
        What to ask of the operating system while the motor is on; what it does not grant is in the
        recording's metadata. Default: nothing.

    Raises
    ------
    InputError
        The drive lacks a method, or the output angle of an encoder count is not known.
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
    ) -> None:
        check_drive(drive)
        self._drive, self._controller, self._trajectory = drive, controller, trajectory
        self._limits = limits
        self._options = _with_resolution(
            options if options is not None else SessionOptions(), drive
        )
        self._output = None if output is None else Path(output)
        self._observer = observer
        self._real_time = RealTime(real_time)
        self._follower: Follower | None = None
        self._end: DriveEnd | None = None

    def check(self) -> list[str]:
        """Bring the drive up and say what speaks against a start; the motor stays off."""
        options, limits = self._options, self._limits
        reasons = list(
            problems_on_paper(
                self._drive, self._controller, self._trajectory, limits, options.period
            )
        )
        if reasons:
            return reasons
        self._drive.connect(options.period)
        told: object = self._drive.problems(limits.torque)
        if not isinstance(told, list):
            raise InputError(
                f"the drive's problems() returned {told!r}; a list of sentences is expected"
            )
        reasons += told
        reasons += problems_at_rest(self._drive.read(10.0 * options.period), limits)
        return reasons

    def run(self, *, dry_run: bool = False) -> Recording | None:
        """Do it.

        Parameters
        ----------
        dry_run : bool
            Only check: the motor stays off, and nothing is returned. Default False.

        Returns
        -------
        Recording
            Of the run itself; `metadata` has timing, limits, the drive's identity, and whether the motor
            was seen off afterwards.

        Raises
        ------
        SessionRefusedError
            Something speaks against a start.
        SessionStoppedError
            A limit, a fault, or the user stopped it; with what was recorded.
        """
        recorder: Recorder | None = None
        cause: Exception | KeyboardInterrupt | None = None
        self._follower, self._end = None, None
        early: list[Frame] = []  # frames of bringing the drive up, before there is a recorder
        if self._output is not None and not dry_run:
            check_output(self._output)
            self._tap(lambda *frame: early.append(frame))
        try:
            with Interruptions() as interruptions:
                try:
                    self._refuse_or_go_on()
                    if dry_run:
                        if interruptions.reason is not None:
                            raise KeyboardInterrupt
                        return None
                    if self._output is not None:
                        recorder = self._recorder(self._output)
                        for frame in early:
                            recorder.frame(*frame)
                        self._tap(recorder.frame)
                    with self._real_time:
                        cause, moment = self._guarded(recorder, interruptions)
                finally:
                    self._leave()
            if cause is None and interruptions.reason is not None:
                cause = LimitError("user", interruptions.reason)  # it came with the end of the run
            if cause is None and self._end is not None and self._end.motor_off is False:
                cause = DriveFaultError("drive_fault", "the run is done, but the motor is not off")
            stop = None if cause is None else self._stop(cause, moment)
            if recorder is not None:
                try:
                    recorder.close(self._ending(stop))
                except OSError as error:
                    if cause is None:
                        cause = unwritten(error)
                        stop = self._stop(cause, moment)
        finally:
            if recorder is not None:
                with suppress(OSError):
                    recorder.close()
        recording = self._recording(stop)
        if stop is not None:
            raise SessionStoppedError(stop, recording) from cause
        return recording

    def _recorder(self, output: Path) -> Recorder:
        # The date is in the file only: what a session returns is the same to the bit when it is repeated.
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
        if reasons:
            raise SessionRefusedError("not started: " + "; ".join(reasons))

    def _guarded(
        self, recorder: Recorder | None, interruptions: Interruptions
    ) -> tuple[Exception | KeyboardInterrupt | None, float]:
        """Enable, move, settle and run; what ended it early, if anything, and when. The motor is off then."""
        options, limits = self._options, self._limits
        try:
            feedback = not isinstance(self._controller, _core.OpenLoop)
            law = self._controller.start(period=options.period, torque_limit=limits.torque)
            course = Course.of(self._trajectory, options.period)
            assert options.resolution is not None, "see __init__"
            follower = Follower(
                self._drive,
                law,
                Guard(limits, options.period, options.resolution),
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
            self._switch_off()
            return error, moment
        moment = self._drive.clock.now()
        self._switch_off()
        return None, moment

    def _approach(self, follower: Follower) -> None:
        """To the start of the trajectory, smoothly, and stand there."""
        options = self._options
        start = float(self._trajectory.sample(np.zeros(1))[0][0])
        here = self._drive.read(10.0 * options.period).position
        distance = start - here
        rise = max(0.2, 0.5 * math.pi * abs(distance) / options.approach_velocity)
        approach = Trajectory.sigmoid(distance, rise=rise, duration=rise + options.settle)
        follower.enter("move")
        follower.follow(Course.of(approach, options.period), None, offset=here, settled=rise)

    # Ways out.

    def _switch_off(self) -> None:
        """Torque to zero, motor off; what a drive raises now must not keep the rest from being done."""
        try:
            self._end = self._drive.disable()
        except (Exception, KeyboardInterrupt) as error:
            self._end = DriveEnd(motor_off=False, failure=f"{type(error).__name__}: {error}")

    def _leave(self) -> None:
        """Motor off, drive left."""
        if self._end is None or not self._end.motor_off:
            self._switch_off()
        try:
            self._drive.close()
        except Exception as error:  # why the session ended is not to be hidden by this
            end = self._end if self._end is not None else DriveEnd()
            self._end = replace(
                end, failure=f"{end.failure} {type(error).__name__}: {error}".strip()
            )
        self._tap(None)

    def _tap(self, tap: Callable[..., object] | None) -> None:
        if hasattr(self._drive, "tap"):
            self._drive.tap = tap

    def _stop(self, cause: Exception | KeyboardInterrupt, moment: float) -> Stop:
        follower = self._follower
        limit, message = "error", f"{type(cause).__name__}: {cause}"
        if isinstance(cause, LimitError):
            limit, message = cause.limit, str(cause)
        elif isinstance(cause, DriveFaultError):
            limit, message = cause.kind, str(cause)
        elif isinstance(cause, KeyboardInterrupt):
            limit, message = "user", "interrupted from the keyboard"
        end = self._end if self._end is not None else DriveEnd()
        if end.failure:
            message = f"{message}; the drive says: {end.failure}"
        if end.motor_off is False:
            message = f"{message}; THE MOTOR WAS NOT SEEN OFF"
        return Stop(
            limit=limit,
            phase="check" if follower is None else follower.phase,
            time=0.0 if follower is None else moment - follower.began,
            moment=moment,
            message=message,
            measured=_finite(getattr(cause, "measured", None)),
            allowed=_finite(getattr(cause, "allowed", None)),
            motor_off=end.motor_off,
        )

    # What is left.

    def _metadata(self) -> dict[str, Any]:
        return session_metadata(
            self._drive, self._controller, self._trajectory, self._limits, self._options
        )

    def _ending(self, stop: Stop | None) -> dict[str, Any]:
        late = np.array(() if self._follower is None else self._follower.late)
        timing = None
        if len(late):
            timing = {
                "cycles": len(late),
                "missed": int((late > 0.0).sum()),
                "slack_least": float(-late.max()),
                "slack_median": float(-np.median(late)),
            }
        return {
            "cycles_before": 0 if self._follower is None else self._follower.cycles_before,
            "stop": None if stop is None else str(stop),
            "stopped": None if stop is None else stop.to_dict(),
            "real_time": list(self._real_time.notes),
            "motor_off": None if self._end is None else self._end.motor_off,
            "timing": timing,
        }

    def _recording(self, stop: Stop | None) -> Recording | None:
        follower = self._follower
        if follower is None or len(follower.rows) < 8:
            return None
        time, position, torque, sensor, reference, current = map(
            np.array, zip(*follower.rows, strict=True)
        )
        return Recording(
            time=time,
            position=position,
            torque=torque,
            sensor=sensor if sensor.any() else None,  # 0 throughout: there is none
            reference=reference,
            current=None if np.isnan(current).any() else current,
            torque_hold="zoh",
            name="" if self._output is None else self._output.stem,
            metadata={
                **self._metadata(),
                "session": True,
                **self._ending(stop),
            },
        )


def _with_resolution(options: SessionOptions, drive: object) -> SessionOptions:
    """Options whose resolution is known: their own, or the drive's."""
    if options.resolution is not None:
        return options
    resolution = getattr(drive, "resolution", None)
    if resolution is None:
        raise InputError(
            "not known: neither the session's options nor the drive give the output angle of an encoder count",
            argument="resolution",
        )
    return replace(options, resolution=float(resolution))


def _finite(value: Any) -> float | None:
    """A number that a recording can keep; what is none is told in the message."""
    number = math.nan if value is None else float(value)
    return number if math.isfinite(number) else None
