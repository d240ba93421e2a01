"""Control loop of a session: in each cycle measure, check the limits, command."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from jointid import _core
from jointid.hardware.session.cycle import capped, held_torque, target_at
from jointid.hardware.session.drive import Drive, DriveFaultError, DriveSample
from jointid.hardware.session.guard import Guard
from jointid.hardware.session.interruptions import Interruptions
from jointid.hardware.session.lateness import Lateness
from jointid.hardware.session.options import SessionOptions
from jointid.hardware.session.recorder import Recorder
from jointid.hardware.session.stop import LimitError
from jointid.hardware.session.velocity_estimator import VelocityEstimator
from jointid.simulation.trajectory import Trajectory

Observer = Callable[[str, float, DriveSample, float, float], object]
UNCONFIRMED = 0.5
"""Amount that an unconfirmed command adds to `Recording.late`. Whole numbers are cycles without a sample."""


@dataclass(frozen=True, slots=True)
class Course:
    """Trajectory, sampled at each cycle.

    It is computed before the motor is on. For a long trajectory this takes longer than a drive waits for the host's
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
        Running controller.
    guard : Guard
    options : SessionOptions
    interruptions : Interruptions
    observer : callable, optional
    feedback : bool
        False if the trajectory is a torque; there is no tracking error then.
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
        assert options.resolution is not None, "the session checks the resolution before"
        self._estimate = VelocityEstimator(
            options.resolution, options.velocity_counts, options.velocity_time
        )
        self._stamp = -math.inf  # time of the last sample [s]
        self.phase, self.began = "check", drive.clock.now()
        self.rows: list[tuple[float, ...]] = []
        self.late: list[float] = []  # end of each cycle relative to the start of the next [s]
        self.woke: list[float] = []  # start of each cycle relative to its due time [s]
        self.cycles = self.cycles_before = 0  # with a commanded torque; before the run
        self.newest: DriveSample | None = None
        self.velocity = 0.0  # estimate at the newest sample [rad/s]
        self.velocity_measured = False  # whether the controller used the drive's velocity
        self._held = 0.0  # last command [N·m]; enabling commands zero
        self._first: float | None = None  # delay of the first sample after the start of its cycle
        self._missing = 0.0  # cycles without a sample before the next one
        self._waited = False  # whether the last cycle waited for a sample in vain

    @property
    def lateness(self) -> Lateness:
        """Counter of the cycles without a sample."""
        return self._guard.lateness

    def enter(self, phase: str) -> None:
        """Begin a phase. A stop reports the phase and the time since its begin."""
        self.phase, self.began = phase, self._drive.clock.now()

    def follow(
        self,
        course: Course,
        recorder: Recorder | None,
        *,
        offset: float = 0.0,
        settled: float | None = None,
    ) -> None:
        """Follow a course. During the phase "run", keep a row of each cycle.

        Parameters
        ----------
        course : Course
        recorder : Recorder or None
        offset : float
            Added to the reference [rad].
        settled : float, optional
            Time at which the phase "settle" begins [s].

        Raises
        ------
        LimitError, DriveFaultError
        Exception
            An error in the controller or the observer.
        """
        options, clock, lateness = self._options, self._drive.clock, self._guard.lateness
        period = options.period
        timeout = options.timeout
        running = self.phase == "run"
        begin = clock.now() + period
        self._first, self._missing, self._waited = None, 0.0, False
        if running and recorder is not None:
            recorder.begin({"cycles_before": self.cycles})
        if running:
            self.cycles_before = self.cycles
        k = 0
        while k < len(course.reference):
            clock.sleep_until(begin + k * period)
            if self._interruptions.reason is not None:
                raise LimitError("user", self._interruptions.reason)
            woke = clock.now() - begin - k * period
            self.woke.append(woke)
            # Skipped cycles are not repeated: the reference is always that of the current time.
            passed = int(woke / period)
            k += passed
            if k >= len(course.reference):
                self._sample(timeout)  # a drive that has stopped reports the reason here
                lateness.skip(passed, woke)
                break
            if settled is not None and self.phase == "move" and k * period > settled:
                self.enter("settle")
            sample = self._sample(timeout)
            if passed:  # after the reading: a drive that has stopped reports the reason there
                lateness.skip(passed, woke)
            self._missing += passed
            if isinstance(sample, str):
                lateness.late(sample)
                self._missing += 1.0
                self._waited = True
                self._hold()
            else:
                # After a late answer the bus is not quiet, so the time of this sample is less certain.
                kept = running and not self._waited
                self._waited = False
                lateness.on_time()
                wanted = (course.reference[k] + offset, course.velocity[k], course.acceleration[k])
                self._answer(sample, k * period, begin, wanted, recorder if kept else None, kept)
            k += 1
            missed = clock.now() - (begin + k * period)
            self.late.append(missed)
            self._guard.timed(missed)

    def _answer(
        self,
        sample: DriveSample,
        due: float,
        begin: float,
        wanted: tuple[float, float, float],
        recorder: Recorder | None,
        kept: bool,
    ) -> None:
        """Check a sample, command a torque and keep the row. A sample that ends the session is kept, too."""
        guard, clock, period = self._guard, self._drive.clock, self._options.period
        self.newest = sample
        estimated = self._estimate(sample.time, sample.position)
        self.velocity = estimated
        measures = not math.isnan(sample.velocity)
        speed = sample.velocity if measures else estimated
        self.velocity_measured = self.velocity_measured or measures
        # The limit uses the larger velocity, so that an outdated velocity of the drive cannot disable it.
        fastest = estimated if abs(estimated) > abs(speed) else speed
        late = sample.time - begin - due
        self._first = late if self._first is None else self._first
        # Rounded to 1 ns: rounding errors would change the sign of a velocity of 0.
        shift = round(late - self._first, 9)
        elapsed = due + shift
        reference, velocity, acceleration = wanted
        ahead = capped(shift, period)
        pace = velocity + ahead * acceleration
        target = target_at(reference, velocity, acceleration, ahead)
        if not sample.confirmed:
            self._missing += UNCONFIRMED
        accepted, held = self._held, self._held
        try:
            guard.measured(sample, fastest, sample.position - target if self._feedback else None)
            aim = target, pace, acceleration
            torque = self._asked(elapsed, sample, speed, aim)
            guard.commanded(torque, self._law.saturations, aim if self._feedback else None)
            accepted = self._accepted(torque)
            acted = clock.now() - sample.time + self._drive.command_latency
            self.cycles += 1
            held = held_torque(self._held, accepted, acted, period)
            guard.accepted(torque, accepted)
        finally:
            if kept and math.isfinite(sample.position + sample.reading):
                row = (elapsed, sample.position, held, sample.reading, target, sample.current)
                self._keep((*row, self._missing), recorder)
        # After a lost command, or one that acts only in the next cycle, the next torque is uncertain, too.
        doubtful = acted > period or not sample.confirmed
        self._missing = (UNCONFIRMED if doubtful else 0.0) + (
            0.0 if kept else math.floor(self._missing) + 1.0
        )
        self._held = accepted
        if self._observer is not None:
            self._observer(self.phase, elapsed, sample, target, accepted)

    def _keep(self, row: tuple[float, ...], recorder: Recorder | None) -> None:
        """Keep a row of the run."""
        self.rows.append(row)
        if recorder is not None:
            recorder.sample(row)
            if recorder.failure is not None:
                raise unwritten(recorder.failure)

    def _sample(self, timeout: float) -> DriveSample | str:
        """Return the drive's state, or the reason if none arrived in time."""
        try:
            sample = self._drive.read(timeout)
        except DriveFaultError as error:
            if error.kind != "stale_position":
                raise
            return str(error)
        self._check_stamp(sample.time)
        return sample

    def _hold(self) -> None:
        """Command the last torque again; this also shows the drive that the host is alive."""
        if self.newest is not None:
            self._guard.unseen(self._drive.clock.now() - self.newest.time)
        self._held = self._accepted(self._held)
        self.cycles += 1

    def _check_stamp(self, stamp: float) -> None:
        """Check that a sample is newer than the previous one. Otherwise it does not belong to this cycle."""
        if not self._stamp < stamp < math.inf:
            raise DriveFaultError(
                "stale_position",
                f"the drive's time stamp is {stamp:.6f} s, but the previous stamp was {self._stamp:.6f} s; stamps "
                "must increase",
                measured=stamp,
                allowed=self._stamp,
            )
        self._stamp = stamp

    def _accepted(self, torque: float) -> float:
        """Command the drive and return the torque that it accepted [N·m]."""
        accepted = self._drive.command(torque)
        if not isinstance(accepted, int | float):
            raise DriveFaultError(
                "drive_fault",
                f"the drive's command() returned {accepted!r}; the accepted torque is expected",
            )
        return accepted

    def _asked(
        self, time: float, sample: DriveSample, speed: float, wanted: tuple[float, float, float]
    ) -> float:
        """Return the torque that the controller requests [N·m]."""
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
    """Return a stop because the recording cannot be written. Return a bug in the writer unchanged."""
    if not isinstance(failure, OSError):
        return failure
    return LimitError(
        "recording", f"the recording cannot be written: {failure.strerror or failure}"
    )
