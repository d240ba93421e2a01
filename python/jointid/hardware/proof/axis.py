"""A joint in the hands of a first motion: one cycle after the other, each within its bounds."""

from __future__ import annotations

import math
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from jointid.hardware.bench.first_motion_options import FirstMotionOptions
from jointid.hardware.proof.encoder_watch import EncoderWatch
from jointid.hardware.proof.refusal import RefusedBenchError
from jointid.hardware.proof.sizes import Sizes
from jointid.hardware.session.drive import Drive, DriveFaultError, DriveSample
from jointid.hardware.session.interruptions import Interruptions
from jointid.hardware.session.limits import SessionLimits

_LOST = 3  # samples in a row that do not come end it; until then there is no torque
_SETTLED = 0.1  # [s] without a count: the joint stands
_STOPPING = 3.0  # [s] that it may take to
_FOLLOWED = 20  # cycles over which the drive's current is compared with the command


@dataclass(frozen=True, slots=True)
class Trace:
    """What some cycles measured.

    Attributes
    ----------
    time, position, torque, reading : ndarray
        [s]; [rad]; commanded from this sample on [N·m]; raw reading of the torque sensor.
    """

    time: npt.NDArray[np.float64]
    position: npt.NDArray[np.float64]
    torque: npt.NDArray[np.float64]
    reading: npt.NDArray[np.float64]


class Axis:
    """Reads and commands a drive in turn, and refuses whatever is beyond the bounds of a first motion.

    Parameters
    ----------
    drive : Drive
        Connected; its motor is off at first.
    limits : SessionLimits
    options : FirstMotionOptions
    period : float
        [s]
    sizes : Sizes
    interruptions : Interruptions

    Attributes
    ----------
    travel : float
        Farthest from the start until now [rad].
    largest_torque : float
        Largest magnitude that was accepted by the drive [N·m].
    lost : int
        Samples that did not come in time.
    sample : DriveSample
        The last one.
    encoder_watch : EncoderWatch or None
        From when the breakaway is known.
    """

    def __init__(
        self,
        drive: Drive,
        limits: SessionLimits,
        options: FirstMotionOptions,
        *,
        period: float,
        sizes: Sizes,
        interruptions: Interruptions,
    ) -> None:
        self._drive, self._limits, self._options = drive, limits, options
        self._interruptions = interruptions
        self.period, self.sizes, self.resolution = period, sizes, sizes.resolution
        self.travel = self.largest_torque = 0.0
        self.on = self._free = False
        self.encoder_watch: EncoderWatch | None = None
        self._torque = 0.0
        self._lost = self.lost = 0
        self._unfollowed = 0
        self._begin = self._switched = drive.clock.now()
        self.rows: list[tuple[float, float, float, float]] = []
        self.sample = drive.read(10.0 * period)
        self._start = self.sample.position

    @property
    def now(self) -> float:
        """Time since the first motion began [s]."""
        return self._drive.clock.now() - self._begin

    @property
    def latency(self) -> float:
        """From sending a command until it acts [s]."""
        return self._drive.command_latency

    @contextmanager
    def by_hand(self) -> Iterator[None]:
        """Without bounds, for as long as somebody turns the joint; they begin anew where it is left."""
        self._free = True
        yield
        self._free = False
        self._start, self.travel = self.sample.position, 0.0

    def enable(self) -> None:
        """Switch the motor on, at no torque."""
        self._drive.enable()
        self.on, self._switched = True, self._drive.clock.now()
        self._next = self._switched

    def read(self) -> DriveSample:
        """Return the state of the next cycle; a sample that does not come is awaited at no torque.

        Raises
        ------
        RefusedBenchError
            Beyond the bounds.
        DriveFaultError
            The drive has failed, or samples are lost one after the other.
        """
        clock = self._drive.clock
        while True:
            # A late cycle is not caught up with: the next one is a period from now at least.
            self._next = (
                max(self._next + self.period, clock.now()) if self.on else clock.now() + self.period
            )
            clock.sleep_until(self._next)
            if self._interruptions.reason is not None:
                raise RefusedBenchError("user", self._interruptions.reason)
            if self.on and clock.now() - self._switched > self._options.longest:
                raise RefusedBenchError(
                    "too_long", f"the motor has been on for {self._options.longest:g} s"
                )
            try:
                sample = self._drive.read(0.75 * self.period)
            except DriveFaultError as error:
                self._lost, self.lost = self._lost + 1, self.lost + 1
                if error.kind != "stale_position" or self._lost >= _LOST:
                    raise
                if self.on:  # nobody sees the joint: no torque, and a sign of life with it
                    self._drive.command(0.0)
                    self._torque = 0.0
                continue
            self._lost = 0
            self._hold(sample)
            self.sample = sample
            return sample

    def command(self, torque: float) -> None:
        """Command a torque until the next cycle [N·m]."""
        accepted = self._drive.command(torque)
        self._torque = torque
        self.largest_torque = max(self.largest_torque, abs(accepted))
        sample = self.sample
        self.rows.append((sample.time, sample.position, accepted, sample.reading))

    def rest(self) -> None:
        """Command no torque until the joint stands.

        Raises
        ------
        RefusedBenchError
            It does not.
        """
        self.command(0.0)
        place, since, end = self.sample.position, self.now, self.now + _STOPPING
        while self.now - since < _SETTLED:
            sample = self.read()
            self.command(0.0)
            if abs(sample.position - place) > 1.5 * self.resolution:  # a count of jitter is none
                place, since = sample.position, self.now
            if self.now > end:
                raise RefusedBenchError(
                    "does_not_stop",
                    f"the joint still moves {_STOPPING:g} s after the torque went to zero; is there "
                    "gravity without a brake, or hardly any friction?",
                )

    def trace(self, begin: int = 0) -> Trace:
        """Return the cycles from a row on."""
        return Trace(*np.array(self.rows[begin:], dtype=float).reshape(-1, 4).T)

    def _hold(self, sample: DriveSample) -> None:
        """Refuse a state beyond the bounds."""
        options, before = self._options, self.sample
        position = sample.position
        if not math.isfinite(position):
            raise RefusedBenchError("not_ready", f"the position is {position}")
        if self._free:
            return
        self.travel = max(self.travel, abs(position - self._start))
        if self.travel > self.sizes.travel:
            raise RefusedBenchError(
                "too_far",
                f"the joint is {self.travel:.5f} rad from its start, more than {self.sizes.travel:.5f} rad",
            )
        certain = (
            abs(position - before.position) - self.resolution
        )  # a count is as much as rounding adds
        speed = certain / max(sample.time - before.time, 0.5 * self.period)
        if speed > options.velocity:
            raise RefusedBenchError(
                "too_fast",
                f"the joint moves at {speed:.3f} rad/s, more than {options.velocity:g} rad/s",
            )
        watch = self.encoder_watch
        if watch is not None and watch.stands(sample.time, position, self._torque):
            raise RefusedBenchError(
                "encoder_stands",
                f"the encoder stays at {position:.5f} rad under {self._torque:.4g} N·m, although the joint "
                "moved at less before: the encoder hangs or is disconnected, or something blocks the joint",
            )
        if self.on and not math.isnan(sample.torque):
            self._follow(sample.torque)

    def _follow(self, torque: float) -> None:
        """Refuse a current that stays away from the command: a phase that is open, a limit in the drive."""
        apart = abs(torque - self._torque) > 0.25 * abs(self._torque) + 0.01 * self._limits.torque
        self._unfollowed = self._unfollowed + 1 if apart else 0
        if self._unfollowed > _FOLLOWED:
            raise RefusedBenchError(
                "current_does_not_follow",
                f"the drive reports a current of {torque:.3g} N·m where {self._torque:.3g} N·m are commanded",
            )
