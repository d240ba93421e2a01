"""Axis of a first motion: it runs cycle by cycle and checks its bounds in each."""

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

_LOST = 3  # lost samples in a row that end it; until then the torque is 0
_SETTLED = 0.1  # [s] without a count: the joint is at rest
_STOPPING = 3.0  # [s], longest time until rest
_FOLLOWED = 20  # cycles over which the drive's current is compared with the command


@dataclass(frozen=True, slots=True)
class Trace:
    """Measurements of some cycles.

    Attributes
    ----------
    time, position, torque, reading : ndarray
        Time [s]; position [rad]; torque commanded from this sample on [N·m]; raw reading of the torque sensor.
    """

    time: npt.NDArray[np.float64]
    position: npt.NDArray[np.float64]
    torque: npt.NDArray[np.float64]
    reading: npt.NDArray[np.float64]


class Axis:
    """Reads and commands a drive in turn, and refuses a bench that leaves the bounds of a first motion.

    Parameters
    ----------
    drive : Drive
        Connected drive; its motor is off at first.
    limits : SessionLimits
    options : FirstMotionOptions
    period : float
        Period of the cycles [s].
    sizes : Sizes
    interruptions : Interruptions

    Attributes
    ----------
    travel : float
        Largest distance from the start until now [rad].
    largest_torque : float
        Largest magnitude that the drive accepted [N·m].
    lost : int
        Number of samples that did not arrive in time.
    sample : DriveSample
        Last sample.
    encoder_watch : EncoderWatch or None
        Watch of the encoder; None until the breakaway torque is known.
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
        """Delay from sending a command until it acts [s]."""
        return self._drive.command_latency

    @contextmanager
    def by_hand(self) -> Iterator[None]:
        """Suspend the bounds while somebody turns the joint. Afterwards they start at its new position."""
        self._free = True
        yield
        self._free = False
        self._start, self.travel = self.sample.position, 0.0

    def enable(self) -> None:
        """Switch the motor on at zero torque."""
        self._drive.enable()
        self.on, self._switched = True, self._drive.clock.now()
        self._next = self._switched

    def read(self) -> DriveSample:
        """Return the state of the next cycle. While a sample is late, the torque is 0.

        Raises
        ------
        RefusedBenchError
            A bound is exceeded.
        DriveFaultError
            The drive has failed, or too many samples in a row are lost.
        """
        clock = self._drive.clock
        while True:
            # A late cycle is not repeated: the next one begins at least a period from now.
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
                if self.on:  # without a sample: zero torque, which is also a sign of life
                    self._drive.command(0.0)
                    self._torque = 0.0
                continue
            self._lost = 0
            self._hold(sample)
            self.sample = sample
            return sample

    def command(self, torque: float) -> None:
        """Command a torque [N·m] until the next cycle."""
        accepted = self._drive.command(torque)
        self._torque = torque
        self.largest_torque = max(self.largest_torque, abs(accepted))
        sample = self.sample
        self.rows.append((sample.time, sample.position, accepted, sample.reading))

    def rest(self) -> None:
        """Command zero torque until the joint is at rest.

        Raises
        ------
        RefusedBenchError
            The joint does not come to rest.
        """
        self.command(0.0)
        place, since, end = self.sample.position, self.now, self.now + _STOPPING
        while self.now - since < _SETTLED:
            sample = self.read()
            self.command(0.0)
            if abs(sample.position - place) > 1.5 * self.resolution:  # one count may be jitter
                place, since = sample.position, self.now
            if self.now > end:
                raise RefusedBenchError(
                    "does_not_stop",
                    f"the joint still moves {_STOPPING:g} s after the torque went to zero; does "
                    "gravity move it without a brake, or is there hardly any friction?",
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
                f"the joint is {self.travel:.5f} rad from its start; at most {self.sizes.travel:.5f} rad is allowed",
            )
        certain = abs(position - before.position) - self.resolution  # rounding adds at most a count
        speed = certain / max(sample.time - before.time, 0.5 * self.period)
        if speed > options.velocity:
            raise RefusedBenchError(
                "too_fast",
                f"the joint moves at {speed:.3f} rad/s; at most {options.velocity:g} rad/s is allowed",
            )
        watch = self.encoder_watch
        if watch is not None and watch.stands(sample.time, position, self._torque):
            raise RefusedBenchError(
                "encoder_stands",
                f"the encoder stays at {position:.5f} rad under {self._torque:.4g} N·m, although the joint "
                "moved at less torque before: the encoder hangs or is disconnected, or something blocks the joint",
            )
        if self.on and not math.isnan(sample.torque):
            self._follow(sample.torque)

    def _follow(self, torque: float) -> None:
        """Refuse a current that differs from the command for some time: an open phase, a limit in the drive."""
        apart = abs(torque - self._torque) > 0.25 * abs(self._torque) + 0.01 * self._limits.torque
        self._unfollowed = self._unfollowed + 1 if apart else 0
        if self._unfollowed > _FOLLOWED:
            raise RefusedBenchError(
                "current_does_not_follow",
                f"the drive reports a current that gives {torque:.3g} N·m, but {self._torque:.3g} N·m is commanded",
            )
