"""The control loop of a session: in each cycle measure, check the limits, command."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from jointid import _core
from jointid.hardware.session.cycle import held_torque, target_at
from jointid.hardware.session.drive import Drive, DriveFaultError, DriveSample
from jointid.hardware.session.guard import Guard
from jointid.hardware.session.interruptions import Interruptions
from jointid.hardware.session.options import SessionOptions
from jointid.hardware.session.recorder import Recorder
from jointid.hardware.session.stop import LimitError
from jointid.hardware.session.velocity_estimator import VelocityEstimator
from jointid.simulation.trajectory import Trajectory

Observer = Callable[[str, float, DriveSample, float, float], object]


@dataclass(frozen=True, slots=True)
class Course:
    """A trajectory at each cycle.

    It is computed before the motor is on: for a long one that takes longer than a drive waits for our
    heartbeat.

    Attributes
    ----------
    reference, velocity, acceleration : list of float
        [rad], [rad/s], [rad/s²]
    """

    reference: list[float]
    velocity: list[float]
    acceleration: list[float]

    @classmethod
    def of(cls, trajectory: Trajectory, period: float) -> Course:
        """Sample a trajectory for cycles of a period [s]."""
        count = round(trajectory.duration / period)
        return cls(*(each.tolist() for each in trajectory.sample(np.arange(count) * period)))


class Follower:
    """Moves a joint along trajectories and keeps the samples of the last one.

    Parameters
    ----------
    drive : Drive
    law : ControlRun
        A controller at work.
    guard : Guard
    options : SessionOptions
    interruptions : Interruptions
    observer : callable, optional
    feedback : bool
        False: the trajectory is a torque, and there is no tracking error.
    """

    def __init__(
        self,
        drive: Drive,
        law: _core.ControlRun,
        guard: Guard,
        options: SessionOptions,
        *,
        interruptions: Interruptions,
        observer: Observer | None = None,
        feedback: bool = True,
    ) -> None:
        self._drive, self._law, self._guard, self._options = drive, law, guard, options
        self._interruptions = interruptions
        self._observer, self._feedback = observer, feedback
        assert options.resolution is not None, "the session has seen to it"
        self._estimate = VelocityEstimator(
            options.resolution, options.velocity_counts, options.velocity_time
        )
        self._stamp = -math.inf  # of the last sample [s]
        self.phase, self.began = "check", drive.clock.now()
        self.rows: list[tuple[float, ...]] = []
        self.late: list[float] = []
        self.cycles = self.cycles_before = 0  # in which a torque was commanded; before the run
        self.velocity_measured = False  # by the drive; the controller got it in some cycle
        self._held = 0.0  # of the last command [N·m]: enabling commands zero

    def enter(self, phase: str) -> None:
        """Begin a phase: a stop names it and the time since."""
        self.phase, self.began = phase, self._drive.clock.now()

    def follow(
        self,
        course: Course,
        recorder: Recorder | None,
        *,
        offset: float = 0.0,
        settled: float | None = None,
    ) -> None:
        """Follow a course; while the phase is "run", keep a row of each cycle.

        Parameters
        ----------
        course : Course
        recorder : Recorder or None
        offset : float
            Added to the reference [rad].
        settled : float, optional
            From this time on the phase is "settle" [s].

        Raises
        ------
        LimitError, DriveFaultError
        Exception
            Of the controller or the observer.
        """
        options, clock, guard = self._options, self._drive.clock, self._guard
        period = options.period
        timeout = 0.75 * period if options.answer_timeout is None else options.answer_timeout
        reference, velocity, acceleration = course.reference, course.velocity, course.acceleration
        running = self.phase == "run"
        begin = clock.now() + period
        first: float | None = None  # how long after a cycle's begin the first sample was taken
        if running and recorder is not None:
            recorder.begin({"cycles_before": self.cycles})
        if running:
            self.cycles_before = self.cycles
        for k in range(len(reference)):
            if settled is not None and self.phase == "move" and k * period > settled:
                self.enter("settle")
            clock.sleep_until(begin + k * period)
            if self._interruptions.reason is not None:
                raise LimitError("user", self._interruptions.reason)
            sample = self._drive.read(timeout)
            self._check_stamp(sample.time)
            estimated = self._estimate(sample.time, sample.position)
            measures = not math.isnan(sample.velocity)
            speed = sample.velocity if measures else estimated
            self.velocity_measured = self.velocity_measured or measures
            # The larger one for the limit: a velocity that a drive no longer updates must not disarm it.
            fastest = estimated if abs(estimated) > abs(speed) else speed
            late = sample.time - begin - k * period
            first = late if first is None else first
            # To the nanosecond: rounding errors would turn the sign of a velocity of 0.
            shift = round(late - first, 9)
            pace = velocity[k] + shift * acceleration[k]
            target = target_at(reference[k] + offset, velocity[k], acceleration[k], shift)
            elapsed = k * period + shift
            error = sample.position - target if self._feedback else None
            guard.measured(sample, fastest, error)
            torque = self._asked(elapsed, sample, speed, (target, pace, acceleration[k]))
            guard.commanded(torque, self._law.saturations)
            accepted = self._accepted(torque)
            acted = clock.now() - sample.time + self._drive.command_latency
            self.cycles += 1
            guard.accepted(torque, accepted)
            if running:
                held = held_torque(self._held, accepted, acted, period)
                row = (elapsed, sample.position, held, sample.reading, target, sample.current)
                self.rows.append(row)
                if recorder is not None:
                    recorder.sample(row)
                    if recorder.failure is not None:
                        raise unwritten(recorder.failure)
            self._held = accepted
            if self._observer is not None:
                self._observer(self.phase, elapsed, sample, target, accepted)
            missed = clock.now() - (begin + (k + 1) * period)
            self.late.append(missed)
            guard.timed(missed)

    def _check_stamp(self, stamp: float) -> None:
        """See that a sample is younger than the one before it: else it is not of this cycle."""
        if not self._stamp < stamp < math.inf:
            raise DriveFaultError(
                "stale_position",
                f"the drive stamped a sample {stamp:.6f} s, the one before {self._stamp:.6f} s; stamps must increase",
                measured=stamp,
                allowed=self._stamp,
            )
        self._stamp = stamp

    def _accepted(self, torque: float) -> float:
        """Command the drive; the torque that it accepted [N·m]."""
        accepted = self._drive.command(torque)
        if not isinstance(accepted, int | float):
            raise DriveFaultError(
                "drive_fault",
                f"the drive's command() returned {accepted!r}; the torque that it accepted is expected",
            )
        return accepted

    def _asked(
        self, time: float, sample: DriveSample, speed: float, wanted: tuple[float, float, float]
    ) -> float:
        """Torque that the controller asks for [N·m]."""
        return self._law.step(
            time=time,
            position=sample.position,
            velocity=speed,
            sensor=sample.reading,
            reference=wanted[0],
            reference_velocity=wanted[1],
            reference_acceleration=wanted[2],
        )


def unwritten(failure: Exception) -> Exception:
    """Return a stop because the recording cannot be written; a bug in the writer as it is."""
    if not isinstance(failure, OSError):
        return failure
    return LimitError(
        "recording", f"the recording cannot be written: {failure.strerror or failure}"
    )
