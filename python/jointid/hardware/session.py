"""A session: a joint moved along a trajectory by a controller, through a drive, within limits."""

from __future__ import annotations

import math
import signal
import threading
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from types import FrameType
from typing import Any

import numpy as np

from jointid import _core
from jointid.errors import InputError
from jointid.hardware.drive import Drive, DriveFaultError, DriveSample, check_drive
from jointid.hardware.limits import Guard, LimitError, SessionLimits, Stop
from jointid.hardware.realtime import RealTime, RealTimeOptions
from jointid.hardware.recorder import Recorder
from jointid.hardware.velocity_estimator import VelocityEstimator
from jointid.recording.recording import Recording
from jointid.simulation.arguments import Controller
from jointid.simulation.trajectory import Trajectory

_FULLEST_BUS = 0.8


class SessionRefusedError(RuntimeError):
    """The session was not begun: the motor has not been on."""


class SessionStoppedError(RuntimeError):
    """A limit stopped the session; torque and motor are off.

    Parameters
    ----------
    stop : Stop
    recording : Recording or None
        What was recorded until then, if it is long enough to be one.
    """

    def __init__(self, stop: Stop, recording: Recording | None) -> None:
        super().__init__(str(stop))
        self.stop, self.recording = stop, recording


@dataclass(frozen=True, slots=True, kw_only=True)
class SessionOptions:
    """How a session goes.

    Attributes
    ----------
    period : float
        Between commands [s].
    approach_velocity : float
        Largest, on the way to the start [rad/s].
    settle : float
        Time of standing at the start [s].
    velocity_counts, velocity_time : int, float
        Of the velocity estimator (6.3.1): counts at least, [s] at most.
    resolution : float
        Output angle of an encoder count [rad].
    answer_timeout : float, optional
        For the drive's state in a cycle [s]; beyond, the position is stale. Default: half a period.
    """

    period: float = 2e-3
    approach_velocity: float = 0.3
    settle: float = 0.5
    velocity_counts: int = 5
    velocity_time: float = 0.01
    resolution: float = 2.0 * math.pi / 808_000
    answer_timeout: float | None = None

    def __post_init__(self) -> None:
        for name in ("period", "approach_velocity", "velocity_time", "resolution"):
            value = getattr(self, name)
            if not 0.0 < value < math.inf:
                raise InputError(f"SessionOptions: {name} is {value!r}; more than 0 is expected")
        if not 0.0 <= self.settle < math.inf:
            raise InputError(f"SessionOptions: settle is {self.settle!r}; at least 0 is expected")
        if self.answer_timeout is not None and not 0.0 < self.answer_timeout < math.inf:
            raise InputError(
                f"SessionOptions: answer_timeout is {self.answer_timeout!r}; more than 0 is expected"
            )


class Session:
    """One run on a joint: check, enable, move to the start, settle, run, stop.

    Every way out leaves zero torque and the motor off.

    Parameters
    ----------
    drive : Drive
        An `ElmoDrive`, or anything with a drive's methods.
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
        The drive lacks a method.
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
        observer: Callable[[str, float, DriveSample, float, float], object] | None = None,
        real_time: RealTimeOptions | None = None,
    ) -> None:
        check_drive(drive)
        self._drive, self._controller, self._trajectory = drive, controller, trajectory
        self._limits = limits
        self._options = options if options is not None else SessionOptions()
        self._output = None if output is None else Path(output)
        self._observer = observer
        self._real_time = RealTime(real_time)
        self._phase, self._began = "check", 0.0
        self._rows: list[tuple[float, ...]] = []
        self._late: list[float] = []
        self._interrupt: str | None = None
        self._estimate = VelocityEstimator(
            self._options.resolution, self._options.velocity_counts, self._options.velocity_time
        )

    def check(self) -> list[str]:
        """Bring the drive up and say what speaks against a start; the motor stays off."""
        load = self._drive.bus_load(self._options.period)
        if load > _FULLEST_BUS:
            return [
                f"a cycle takes {100.0 * load:.0f} % of the bus, more than {100.0 * _FULLEST_BUS:.0f} %; "
                "take a longer period"
            ]
        self._drive.connect(self._options.period)
        reasons = self._drive.problems(self._limits.torque)
        sample = self._drive.read(10.0 * self._options.period)
        low, high = self._limits.position
        if not low <= sample.position <= high:
            reasons.append(
                f"the joint stands at {sample.position:.4f} rad, outside {low:.4f} to {high:.4f} rad: is it "
                "homed?"
            )
        wanted = self._trajectory.sample(np.linspace(0.0, self._trajectory.duration, 2000))[0]
        if wanted.min() < low or wanted.max() > high:
            reasons.append(
                f"the trajectory goes from {wanted.min():.4f} to {wanted.max():.4f} rad, outside {low:.4f} "
                f"to {high:.4f} rad"
            )
        if sample.clipped:
            reasons.append("the torque sensor is at the end of its range")
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
            Of the run itself; `metadata` has timing, limits and the drive's identity.

        Raises
        ------
        SessionRefusedError
            Something speaks against a start.
        SessionStoppedError
            A limit, a fault, or the user stopped it; with what was recorded.
        """
        recorder: Recorder | None = None
        stop: Stop | None = None
        try:
            try:
                reasons = self.check()
            except DriveFaultError as error:
                raise SessionRefusedError(f"not started: {error}") from error
            if reasons:
                raise SessionRefusedError("not started: " + "; ".join(reasons))
            if dry_run:
                return None
            if self._output is not None:
                recorder = Recorder(self._output, self._metadata(), self._output.stem)
                if hasattr(self._drive, "tap"):
                    self._drive.tap = recorder.frame
            with _Interruptions(self._interrupted), self._real_time:
                stop = self._guarded(recorder)
        finally:
            self._drive.disable()
            self._drive.close()
            if hasattr(self._drive, "tap"):
                self._drive.tap = None
            if recorder is not None:
                recorder.close()
        recording = self._recording(stop)
        if stop is not None:
            raise SessionStoppedError(stop, recording)
        return recording

    # The phases.

    def _guarded(self, recorder: Recorder | None) -> Stop | None:
        """Move, settle and run; why it ended early, if it did. The motor is off afterwards."""
        try:
            self._enter("enable")
            self._drive.enable()
            start = float(self._trajectory.sample(np.zeros(1))[0][0])
            here = self._drive.read(10.0 * self._options.period).position
            law = self._controller.start(
                period=self._options.period, torque_limit=self._limits.torque
            )
            guard = Guard(self._limits, self._options.period)
            self._move(law, guard, here, start)
            self._enter("run")
            self._follow(law, guard, self._trajectory, recorder)
        except LimitError as error:
            return self._stop(error.limit, str(error))
        except DriveFaultError as error:
            return self._stop(error.kind, str(error))
        except KeyboardInterrupt:
            return self._stop("user", "interrupted from the keyboard")
        except Exception as error:
            self._drive.disable()
            return self._stop("error", f"{type(error).__name__}: {error}")
        return None

    def _stop(self, limit: str, message: str) -> Stop:
        self._drive.disable()
        now = self._drive.clock.now()
        return Stop(limit=limit, phase=self._phase, time=now - self._began, message=message)

    def _enter(self, phase: str) -> None:
        self._phase, self._began = phase, self._drive.clock.now()

    def _move(self, law: _core.ControlRun, guard: Guard, here: float, start: float) -> None:
        """To the start of the trajectory, smoothly, and stand there."""
        distance = start - here
        rise = max(0.2, 0.5 * math.pi * abs(distance) / self._options.approach_velocity)
        approach = Trajectory.sigmoid(distance, rise=rise, duration=rise + self._options.settle)
        self._enter("move")
        self._follow(law, guard, approach, None, offset=here, settled=rise)

    def _follow(
        self,
        law: _core.ControlRun,
        guard: Guard,
        trajectory: Trajectory,
        recorder: Recorder | None,
        *,
        offset: float = 0.0,
        settled: float | None = None,
    ) -> None:
        options, clock = self._options, self._drive.clock
        period = options.period
        timeout = 0.5 * period if options.answer_timeout is None else options.answer_timeout
        count = round(trajectory.duration / period)
        wanted = trajectory.sample(np.arange(count) * period)
        reference, velocity, acceleration = (each.tolist() for each in wanted)
        open_loop = isinstance(self._controller, _core.OpenLoop)
        running = self._phase == "run"
        begin = clock.now() + period
        before = 0.0
        for k in range(count):
            if settled is not None and self._phase == "move" and k * period > settled:
                self._phase = "settle"
            clock.sleep_until(begin + k * period)
            if self._interrupt is not None:
                raise LimitError("user", self._interrupt)
            sample = self._drive.read(timeout)
            speed = self._estimate(sample.time, sample.position)
            target = reference[k] + offset
            error = None if open_loop else sample.position - target
            guard.measured(sample.position, speed, error, clipped=sample.clipped)
            torque = law.step(
                time=k * period,
                position=sample.position,
                velocity=speed,
                sensor=sample.reading,
                reference=target,
                reference_velocity=velocity[k],
                reference_acceleration=acceleration[k],
            )
            guard.commanded(torque, law.saturations)
            told = self._drive.command(torque)
            now = clock.now()
            if running:
                # Until the drive acts, the last command holds: the mean over the cycle is kept.
                share = min(1.0, (now - sample.time + self._drive.command_latency) / period)
                held = share * before + (1.0 - share) * told
                row = (k * period, sample.position, held, sample.reading, target, sample.current)
                self._rows.append(row)
                if recorder is not None:
                    recorder.sample(row)
                    if recorder.failure is not None:
                        raise recorder.failure
            before = told
            if self._observer is not None:
                self._observer(self._phase, k * period, sample, target, told)
            late = clock.now() - (begin + (k + 1) * period)
            self._late.append(late)
            guard.timed(late)

    # What is left.

    def _interrupted(self, reason: str) -> None:
        self._interrupt = reason

    def _metadata(self) -> dict[str, Any]:
        limits = {name: getattr(self._limits, name) for name in self._limits.__slots__}
        return {
            "controller": repr(self._controller),
            "trajectory": self._trajectory.form,
            "control_period": self._options.period,
            "limits": {name: _json(value) for name, value in limits.items()},
            "drive": self._drive.identity(),
            "version": _core.__version__,
        }

    def _recording(self, stop: Stop | None) -> Recording | None:
        if len(self._rows) < 8:
            return None
        time, position, torque, sensor, reference, current = map(
            np.array, zip(*self._rows, strict=True)
        )
        late = np.array(self._late)
        return Recording(
            time=time,
            position=position,
            torque=torque,
            sensor=sensor,
            reference=reference,
            current=None if np.isnan(current).any() else current,
            torque_hold="zoh",
            name="" if self._output is None else self._output.stem,
            metadata={
                **self._metadata(),
                "session": True,
                "real_time": list(self._real_time.notes),
                "stop": None if stop is None else str(stop),
                "timing": {
                    "cycles": len(late),
                    "missed": int((late > 0.0).sum()),
                    "slack_least": float(-late.max()),
                    "slack_median": float(-np.median(late)),
                },
            },
        )


def _json(value: Any) -> Any:
    if isinstance(value, tuple):
        return list(value)
    return None if isinstance(value, float) and math.isinf(value) else value


class _Interruptions:
    """SIGINT and SIGTERM as a wish to stop, for the time of a session on the main thread."""

    def __init__(self, tell: Callable[[str], None]) -> None:
        self._tell = tell
        self._before: dict[int, Any] = {}

    def __enter__(self) -> None:
        if threading.current_thread() is not threading.main_thread():
            return
        for number in (signal.SIGINT, signal.SIGTERM):
            self._before[number] = signal.signal(number, self._caught)

    def __exit__(self, *_: object) -> None:
        for number, handler in self._before.items():
            signal.signal(number, handler)

    def _caught(self, number: int, frame: FrameType | None) -> None:
        del frame
        self._tell(f"stopped by {signal.Signals(number).name}")
