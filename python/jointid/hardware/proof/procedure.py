"""A first motion: what can be told of a bench with a fraction of a degree and little more than breakaway."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any

import numpy as np

from jointid.base.argument_checks import require_kind
from jointid.base.errors import InputError
from jointid.hardware.bench.bench import Bench
from jointid.hardware.bench.opened_drive import open_drive
from jointid.hardware.proof.axis import Axis
from jointid.hardware.proof.breakaway import Breakaway, find_breakaway
from jointid.hardware.proof.control import small_move
from jointid.hardware.proof.expected import Expected, expected_of, scale_fault
from jointid.hardware.proof.pushes import (
    STRENGTH,
    Motion,
    Push,
    SensorResponse,
    motion_of,
    push,
    sensor_response,
)
from jointid.hardware.proof.refusal import RefusedBenchError
from jointid.hardware.proof.result import FirstMotion
from jointid.hardware.session.drive import Drive, DriveEnd, DriveFaultError
from jointid.hardware.session.interruptions import Interruptions
from jointid.hardware.session.start_checks import problems_at_rest

_CAP = 5.0  # times the stated breakaway: a torque constant wrong by 3, stated within 1.5, is still found
_FEWEST, _MOST = 5, 25  # pairs of pushes
_CLEAR = 6.0  # standard errors of a sign
_REACH, _FARTHEST = math.radians(0.02), math.radians(0.12)  # of the first push and of the last
_WIDE = math.radians(0.2)  # pushes that went so far are not made longer
_FEW_PUSHES = 4  # pairs that only tell a wrong torque constant from a wrong gear ratio
_DRIFT = 5.0  # counts: a joint that stands moves less
_FARTHER = 2.0  # measured over stated inertia, where nothing else is known


def first_motion(
    bench: Bench,
    *,
    emulate: bool = False,
    seed: int = 0,
    drive: Drive | None = None,
    callback: Callable[[str], object] | None = None,
) -> FirstMotion:
    """Move a joint for the first time: signs, breakaway and scales, before anything can go far.

    Still, motor off; still, motor on at no torque; the torque up from zero until the first counts, in both
    directions; short pushes just above breakaway; small slow motions under control. Every step has its own
    stop, and the first thing that is wrong ends it with the motor off.

    Parameters
    ----------
    bench : Bench
    emulate : bool
        An emulated drive and joint on virtual time. Default False: the real ones.
    seed : int
        Of the emulated noise. Default 0.
    drive : Drive, optional
        One that is open already; it is left closed. Default: the bench's.
    callback : callable, optional
        Called with each line as it is known.

    Returns
    -------
    FirstMotion
        A bench that is refused is a result, not an exception.

    Raises
    ------
    InputError
        This is no Bench, or its drive cannot be opened.
    Exception
        A bug in the drive; the motor is switched off first.

    Examples
    --------
    >>> result = jid.hardware.first_motion(bench, emulate=True)
    >>> result.passed, result.reason
    (True, None)
    """
    require_kind("bench", bench, Bench)
    if drive is not None:
        return _Procedure(bench, drive, callback).run()
    with open_drive(bench, emulate=emulate, seed=seed) as opened:
        return _Procedure(bench, opened, callback).run()


class _Procedure:
    """The steps, and what they have found until one of them refuses."""

    def __init__(
        self, bench: Bench, drive: Drive, callback: Callable[[str], object] | None
    ) -> None:
        self._bench, self._drive, self._callback = bench, drive, callback
        self._options = bench.first_motion
        self._expected: Expected = expected_of(bench.joint)
        if not self._options.compare_friction:
            self._expected = Expected(
                breakaway=None,
                drive_inertia=self._expected.drive_inertia,
                link_inertia=self._expected.link_inertia,
                sensor=self._expected.sensor,
                sensor_sign=self._expected.sensor_sign,
            )
        self._axis: Axis | None = None
        self._steps: list[str] = []
        self._found: dict[str, Any] = {
            "stated_breakaway": self._expected.breakaway,
            "stated_inertia": self._expected.inertia,
        }
        self._signs: dict[str, int | None] = {"torque_and_encoder": None, "sensor": None}
        self._unchecked = ["positive_direction", "homing", "backlash", "watchdog", "emergency_stop"]

    def run(self) -> FirstMotion:
        reason, message = None, ""
        end: DriveEnd | None = None
        identity: dict[str, Any] = {}
        try:
            with Interruptions() as interruptions, self._switched_off() as ended:
                try:
                    self._steps_in_order(interruptions)
                except RefusedBenchError as refusal:
                    reason, message = refusal.reason, str(refusal)
                except DriveFaultError as error:
                    reason, message = error.kind, str(error)
                except (OSError, InputError) as error:
                    if self._axis is None and isinstance(error, InputError):
                        raise
                    reason, message = "error", f"{type(error).__name__}: {error}"
                except KeyboardInterrupt:
                    reason, message = "user", "interrupted from the keyboard"
                identity = self._drive.identity()
            end = ended[0] if ended else None
        finally:
            self._drive.close()
        off = None if end is None else end.motor_off
        if off is False and reason is None:
            reason, message = "drive_fault", "the motor was not seen off at the end"
        axis = self._axis
        return FirstMotion(
            passed=reason is None,
            reason=reason,
            message=message,
            travel=0.0 if axis is None else axis.travel,
            largest_torque=0.0 if axis is None else axis.largest_torque,
            duration=0.0 if axis is None else axis.now,
            signs=self._signs,
            unchecked=tuple(self._unchecked),
            motor_off=off,
            identity=identity,
            steps=tuple(self._steps),
            **self._found,
        )

    @contextmanager
    def _switched_off(self) -> Iterator[list[DriveEnd]]:
        """The motor off on every way out."""
        ended: list[DriveEnd] = []
        try:
            yield ended
        finally:
            ended.append(self._drive.disable() or DriveEnd())

    def _say(self, line: str) -> None:
        self._steps.append(line)
        if self._callback is not None:
            self._callback(line)

    # The steps.

    def _steps_in_order(self, interruptions: Interruptions) -> None:
        cap = self._cap()
        axis = self._ready(interruptions)
        self._stands(axis, "motor off")
        axis.enable()
        self._stands(axis, "motor on, no torque")
        found = [self._breakaway(axis, direction, cap) for direction in (1.0, -1.0)]
        self._judge_signs(found)
        breakaway = (found[0].torque, found[1].torque)
        self._judge_scales(axis, breakaway)
        motion = self._judge_sensor(axis, breakaway)
        self._under_control(axis, breakaway, motion)

    def _cap(self) -> float:
        """The torque at which the search for motion ends [N·m]."""
        given, limit = self._options.largest_torque, self._bench.limits.torque
        if given is None:
            stated = self._expected.breakaway
            given = math.inf if stated is None else _CAP * stated
        cap = min(given, limit)
        if not math.isfinite(cap):
            raise RefusedBenchError(
                "not_ready",
                "there is no torque to end at: give the joint file a torque or current limit, or its friction",
            )
        return cap

    def _ready(self, interruptions: Interruptions) -> Axis:
        """Connect; the axis, motor off."""
        bench, drive = self._bench, self._drive
        period = bench.options.period
        drive.connect(period)
        problems = list(drive.problems(bench.limits.torque))
        if problems:
            raise RefusedBenchError("not_ready", "; ".join(problems))
        resolution = bench.options.resolution or getattr(drive, "resolution", None)
        if resolution is None:
            raise InputError("missing; this drive has none", argument="resolution")
        axis = Axis(
            drive,
            bench.limits,
            self._options,
            period=period,
            resolution=resolution,
            interruptions=interruptions,
        )
        self._axis = axis
        reasons = list(problems_at_rest(axis.sample, bench.limits))
        low, high = bench.limits.position
        if not low + self._options.travel <= axis.sample.position <= high - self._options.travel:
            reasons.append(
                f"the joint stands at {axis.sample.position:.4f} rad, too near to the end of its window, "
                f"{low:.4f} to {high:.4f} rad, to be moved by {self._options.travel:.4f} rad"
            )
        if reasons:
            raise RefusedBenchError("not_ready", "; ".join(reasons))
        return axis

    def _stands(self, axis: Axis, when: str) -> None:
        """See that the joint stands."""
        start, end = axis.sample.position, axis.now + self._options.still_time
        readings = []
        while axis.now < end:
            sample = axis.read()
            if axis.on:
                axis.command(0.0)
            readings.append(sample.reading)
            moved = abs(sample.position - start) / axis.resolution
            if moved > _DRIFT:
                raise RefusedBenchError(
                    "moves_at_zero_torque" if axis.on else "moving",
                    f"{when}, the joint moved {moved:.0f} counts within {self._options.still_time:g} s; "
                    + (
                        "gravity that only the brake has held, a current that is not zero, or another program"
                        if axis.on
                        else "hold it still, and support it against gravity"
                    ),
                )
        if self._expected.sensor:
            self._found["sensor_zero"] = float(np.mean(readings))
        self._say(f"stands, {when}: {axis.sample.position:+.5f} rad")

    def _breakaway(self, axis: Axis, direction: float, cap: float) -> Breakaway:
        side = "positive" if direction > 0.0 else "negative"
        try:
            found = find_breakaway(axis, direction, cap, self._options)
        except RefusedBenchError as refusal:
            self._say(f"{side} torque: {refusal.reason}")
            raise
        torques = list(self._found.get("breakaway", (None, None)))
        torques[direction < 0.0] = found.torque
        self._found["breakaway"] = tuple(torques)
        way = "along" if found.along else "AGAINST"
        self._say(
            f"{side} torque: moves at {found.torque:.3f} N·m, {way} the torque"
            + (f", after yielding by {found.wind_up:.5f} rad" if found.wind_up > 2e-4 else "")
        )
        return found

    def _judge_signs(self, found: list[Breakaway]) -> None:
        along = [each.along for each in found]
        if all(along):
            self._signs["torque_and_encoder"] = 1
            return
        if any(along):
            raise RefusedBenchError(
                "moves_one_way",
                "the joint moves the same way under a positive and under a negative torque: something else "
                "moves it, gravity or a spring, or another program commands the drive",
            )
        self._signs["torque_and_encoder"] = -1
        raise RefusedBenchError(
            "torque_and_encoder_disagree",
            "a positive torque makes the encoder count down, and a negative one up: either the torque or the "
            "encoder is inverted. See which way the link goes under a positive torque: if it is the one that you "
            "call positive, the encoder is inverted, else the torque",
        )

    def _judge_scales(self, axis: Axis, breakaway: tuple[float, float]) -> None:
        expected, friction = self._expected, 0.5 * (breakaway[0] + breakaway[1])
        stated = expected.breakaway
        if stated is None:
            return
        if scale_fault(expected, friction, math.nan) is None:
            self._say(
                f"friction at a stand {friction:.3f} N·m; the joint file states {stated:.3f} N·m"
            )
            return
        inertia = math.nan
        if expected.inertia is not None:
            pushes = self._pushes(
                axis, breakaway, _FEW_PUSHES, _REACH / max(1.0, friction / stated)
            )
            inertia = motion_of(pushes, axis.latency, axis.resolution).inertia
            self._found["inertia"] = inertia if math.isfinite(inertia) else None
        code = scale_fault(expected, friction, inertia)
        assert code is not None
        raise RefusedBenchError(
            code,
            f"the joint moves at {friction:.4g} N·m by the joint file's constants, {friction / stated:.3g} times "
            f"the {stated:.4g} N·m that it states"
            + ("" if math.isnan(inertia) else f", with an inertia of {inertia:.3g} kg·m²")
            + "; where the stated friction is only a guess, set compare_friction = false in "
            "[session.first_motion]",
        )

    def _pushes(
        self, axis: Axis, breakaway: tuple[float, float], pairs: int, reach: float
    ) -> list[Push]:
        return [
            push(axis, direction, STRENGTH * breakaway[direction < 0.0], reach)
            for _ in range(pairs)
            for direction in (1.0, -1.0)
        ]

    def _judge_sensor(self, axis: Axis, breakaway: tuple[float, float]) -> Motion:
        """Push until inertia and sensor are clear; returns what they say of the joint."""
        expected, reach = self._expected, _REACH
        pushes: list[Push] = []
        motion, response = Motion(math.nan, 0.0, 0.0), SensorResponse(0.0, math.inf)
        for pair in range(_MOST):
            pushes += self._pushes(axis, breakaway, 1, reach)
            widest = max(float(np.ptp(each.trace.position)) for each in pushes[-2:])
            if widest < _WIDE:
                reach = min(reach + _REACH, _FARTHEST)
            if pair + 1 < _FEWEST:
                continue
            motion = motion_of(pushes, axis.latency, axis.resolution)
            if not expected.sensor:
                break
            response = sensor_response(pushes, motion, axis.latency, axis.resolution)
            if abs(response.significance) > _CLEAR:
                break
        if math.isfinite(motion.inertia):
            self._found["inertia"] = motion.inertia
            stated = expected.inertia
            beside = "" if stated is None else f"; the joint file states {stated:.3g} kg·m²"
            self._say(f"inertia {motion.inertia:.3g} kg·m²{beside}")
        self._judge_inertia(motion.inertia)
        if expected.sensor:
            self._judge_response(response)
        return motion

    def _judge_inertia(self, inertia: float) -> None:
        """Without a stated friction the inertia alone tells of the torque constant, and nothing of the gear ratio."""
        expected = self._expected
        if expected.breakaway is not None:
            return
        self._unchecked.append("gear_ratio")
        stated = expected.inertia
        if stated is None or not math.isfinite(inertia):
            self._unchecked.append("torque_constant")
            return
        if not 1.0 / _FARTHER <= inertia / stated <= _FARTHER:
            raise RefusedBenchError(
                "torque_constant",
                f"the joint's inertia is {inertia:.3g} kg·m² by the joint file's constants, {inertia / stated:.3g} "
                f"times the {stated:.3g} kg·m² that it states: the torque constant is wrong, or the stated inertia",
            )

    def _judge_response(self, response: SensorResponse) -> None:
        z = response.significance * self._expected.sensor_sign
        if abs(z) <= _CLEAR:
            self._unchecked.append("sensor_sign")
            self._say(f"torque sensor: its sign does not show ({abs(z):.1f} standard errors)")
            return
        self._signs["sensor"] = 1 if z > 0.0 else -1
        if z < 0.0:
            raise RefusedBenchError(
                "sensor_sign",
                f"the torque sensor's reading falls where the link is accelerated in the positive direction "
                f"({abs(z):.0f} standard errors): it is inverted, or sensor_gain has the wrong sign",
            )
        self._say(f"torque sensor: right sign ({z:.0f} standard errors)")

    def _under_control(self, axis: Axis, breakaway: tuple[float, float], motion: Motion) -> None:
        inertia = motion.inertia if math.isfinite(motion.inertia) else self._expected.inertia
        if inertia is None:
            self._unchecked.append("control")
            return
        for amplitude in self._options.moves:
            way = 1.0
            worst = small_move(axis, way * amplitude, breakaway, inertia)
            self._say(
                f"under control: {math.degrees(amplitude):.2f}° and back, largest error {math.degrees(worst):.3f}°"
            )
