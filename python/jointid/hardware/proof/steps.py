"""Steps of a first motion, in order. Each has its own stop."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np

from jointid.hardware.bench.bench import Bench
from jointid.hardware.proof.axis import Axis
from jointid.hardware.proof.breakaway import Breakaway, find_breakaway
from jointid.hardware.proof.control import small_move
from jointid.hardware.proof.encoder_watch import EncoderWatch
from jointid.hardware.proof.expected import Expected, expected_of, scale_fault
from jointid.hardware.proof.hand_turn import await_hand_turn
from jointid.hardware.proof.pushes import (
    STRENGTH,
    Motion,
    Push,
    SensorResponse,
    informed,
    motion_of,
    push,
    sensor_response,
)
from jointid.hardware.proof.refusal import RefusedBenchError
from jointid.hardware.proof.sizes import resolution_of, sizes_of
from jointid.hardware.proof.watchdog_reach import slow_on_bench
from jointid.hardware.session.drive import Drive
from jointid.hardware.session.drive_report import DriveReport
from jointid.hardware.session.interruptions import Interruptions
from jointid.hardware.session.start_checks import FULLEST_BUS, problems_at_rest

# Multiple of the stated breakaway. With 5, a torque constant wrong by 3 is still found if the stated friction is
# correct within 1.5. Without a sensor, nothing shows the motion of a joint with a frozen encoder.
_CAP, _CAP_UNWATCHED = 5.0, 2.0
_SLOWEST = 0.005  # [s], longest period; at twice that, correct benches moved too far
_FEWEST, _MOST = 5, 25  # pairs of pushes
_CLEAR = 6.0  # standard errors that make a sign certain
_REACH, _FARTHEST = 0.05, 0.3  # of the span, for the first push and for the last
_WIDE = 0.5  # of the span; longer pushes do not grow further
_QUICK = 0.3  # of the allowed velocity; faster pushes do not grow further
_PUSHED = 0.6  # of the allowed time, after which no more pushes begin
_FEW_PUSHES = 4  # pairs that distinguish a wrong torque constant from a wrong gear ratio
_DRIFT = 5.0  # counts; a joint at rest moves less
_SURE, _SURE_WOUND = 1.02, 1.1  # of the breakaway, at which the joint slides
_WOUND = 2e-4  # [rad], elastic angle
_FARTHER = 2.0  # measured over stated inertia, if nothing more is known


class Steps:
    """Steps of a first motion, with their results until one of them refuses the bench.

    Parameters
    ----------
    bench : Bench
    drive : Drive
    callback : callable, optional
        Called with each line of the report.

    Attributes
    ----------
    axis : Axis or None
        None until the drive is connected.
    lines : list of str
        Tests and measurements.
    found : dict
        Fields of the result.
    signs : dict
    unchecked : list of str
    """

    def __init__(
        self, bench: Bench, drive: Drive, callback: Callable[[str], object] | None
    ) -> None:
        self._bench, self._drive, self._callback = bench, drive, callback
        self._options = bench.first_motion
        self._expected: Expected = expected_of(bench.joint)
        if not self._options.compare_friction:
            self._expected = replace(self._expected, breakaway=None)
        self._watched = self._expected.sensor and self._options.watch_sensor
        self._sure = (math.inf, math.inf)  # torques at which the joint slides [N·m]
        self._deviation = math.nan  # standard deviation of the torque sensor's readings at rest
        self.axis: Axis | None = None
        self.lines: list[str] = []
        self.found: dict[str, Any] = {
            "stated_breakaway": self._expected.breakaway,
            "stated_inertia": self._expected.inertia,
        }
        self.signs: dict[str, int | None] = {"torque_and_encoder": None, "sensor": None}
        self.unchecked = ["positive_direction", "homing", "backlash", "watchdog", "emergency_stop"]
        if not self._watched and self._options.hand_turn is None:
            self.unchecked.append("encoder")

    def _say(self, line: str) -> None:
        self.lines.append(line)
        if self._callback is not None:
            self._callback(line)

    def run(self, interruptions: Interruptions) -> None:
        """Take all steps.

        Raises
        ------
        RefusedBenchError
            The bench is wrong, or a bound is exceeded.
        DriveFaultError
        """
        cap = self._cap()
        axis = self._ready(interruptions)
        self._stands(axis, "motor off")
        axis.enable()
        self._stands(axis, "motor on, no torque")
        found = [self._breakaway(axis, direction, cap) for direction in (1.0, -1.0)]
        if "encoder" in self.unchecked:
            self.unchecked.remove("encoder")  # it has counted in both directions
        self._judge_signs(found)
        breakaway = (found[0].torque, found[1].torque)
        # An elastic gear seems to slide a little before it does.
        wound = max(each.wind_up for each in found) > _WOUND
        sure = tuple((_SURE_WOUND if wound else _SURE) * each for each in breakaway)
        self._sure = (sure[0], sure[1])
        if self._expected.inertia is not None:
            stated = self._expected.breakaway or math.inf
            # If the joint file's torque constant is too large, it makes both larger.
            inertia = self._expected.inertia * max(1.0, 0.5 * sum(breakaway) / stated)
            axis.encoder_watch = EncoderWatch(self._sure, inertia, axis.resolution)
        self._judge_scales(axis, breakaway)
        motion = self._judge_sensor(axis, breakaway)
        self._under_control(axis, breakaway, motion, max(each.wind_up for each in found))

    def _cap(self) -> float:
        """Return the torque at which the search for motion ends [N·m]."""
        given, limit = self._options.largest_torque, self._bench.limits.torque
        if given is None:
            stated = self._expected.breakaway
            if stated is None and not self._watched:
                # With a frozen encoder, the torque limit would turn the joint many times, and nothing would show it.
                raise RefusedBenchError(
                    "not_ready",
                    "if the encoder hangs, neither a known friction nor a torque sensor ends the search for "
                    "motion: state the friction in the joint file, or set largest_torque (--largest-torque) to at "
                    "most twice the torque at which you expect motion",
                )
            factor = _CAP if self._watched else _CAP_UNWATCHED
            given = math.inf if stated is None else factor * stated
        cap = min(given, limit)
        if not math.isfinite(cap):
            raise RefusedBenchError(
                "not_ready",
                "the largest torque is not known: state a torque limit, current limit or friction in the joint file",
            )
        return cap

    def _ready(self, interruptions: Interruptions) -> Axis:
        """Connect the drive. Return its axis with the motor off."""
        bench, drive = self._bench, self._drive
        period = bench.options.period
        self._refuse_period(period)
        drive.connect(period)
        problems = list(drive.problems(bench.limits.torque))
        ask = getattr(drive, "report", None)
        report = ask() if callable(ask) else None
        if isinstance(report, DriveReport):
            problems += [str(each) for each in report.differences]
        if problems:
            raise RefusedBenchError("not_ready", "; ".join(problems))
        sizes = sizes_of(self._options, resolution_of(bench, drive))
        axis = Axis(
            drive,
            bench.limits,
            self._options,
            period=period,
            sizes=sizes,
            interruptions=interruptions,
        )
        self.axis = axis
        if self._options.hand_turn is not None:
            self._say(f"turn the joint by hand within {self._options.hand_turn:g} s, then let go")
            turned = await_hand_turn(axis, self._options.hand_turn)
            self._say(f"the encoder counts: the joint was turned by {turned:.5f} rad")
        reasons = [*problems_at_rest(axis.sample, bench.limits), *slow_on_bench(bench, drive, axis)]
        low, high = bench.limits.position
        if not low + sizes.travel <= axis.sample.position <= high - sizes.travel:
            reasons.append(
                f"the joint is at {axis.sample.position:.4f} rad, too near to the end of its window "
                f"({low:.4f} to {high:.4f} rad) for a motion of {sizes.travel:.4f} rad"
            )
        if reasons:
            raise RefusedBenchError("not_ready", "; ".join(reasons))
        return axis

    def _refuse_period(self, period: float) -> None:
        """Refuse a period that overloads the bus, or in which a push goes too far between two samples."""
        load = self._drive.bus_load(period)
        if not load <= FULLEST_BUS:
            raise RefusedBenchError(
                "not_ready",
                f"the bus load is {100.0 * load:.0f} %, more than {100.0 * FULLEST_BUS:.0f} %; state a longer "
                "period",
            )
        if period > _SLOWEST:
            raise RefusedBenchError(
                "not_ready",
                f"a period of {period:g} s is too long for a first motion: the joint goes too far between samples; "
                f"at most {_SLOWEST:g} s is expected",
            )

    def _stands(self, axis: Axis, when: str) -> None:
        """Check that the joint is at rest."""
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
                        "likely: gravity after the brake has opened, a current that is not zero, or another program"
                        if axis.on
                        else "hold the joint still, and support it against gravity"
                    ),
                )
        if self._expected.sensor:
            self.found["sensor_zero"] = float(np.mean(readings))
            if self._watched:
                self._deviation = float(np.std(readings))
        self._say(f"at rest, {when}: {axis.sample.position:+.5f} rad")

    def _breakaway(self, axis: Axis, direction: float, cap: float) -> Breakaway:
        side = "positive" if direction > 0.0 else "negative"
        try:
            found = find_breakaway(axis, direction, cap, self._options, self._deviation)
        except RefusedBenchError as refusal:
            self._say(f"{side} torque: ended by {refusal.reason}")
            raise
        torques = list(self.found.get("breakaway", (None, None)))
        torques[direction < 0.0] = found.torque
        self.found["breakaway"] = tuple(torques)
        way = "along" if found.along else "AGAINST"
        self._say(
            f"{side} torque: the joint moves at {found.torque:.3f} N·m, {way} the torque"
            + (f", after yielding by {found.wind_up:.5f} rad" if found.wind_up > 2e-4 else "")
        )
        return found

    def _judge_signs(self, found: list[Breakaway]) -> None:
        along = [each.along for each in found]
        if all(along):
            self.signs["torque_and_encoder"] = 1
            return
        if any(along):
            raise RefusedBenchError(
                "moves_one_way",
                "positive and negative torque move the joint in the same direction: gravity or a spring moves it, "
                "or another program commands the drive",
            )
        self.signs["torque_and_encoder"] = -1
        raise RefusedBenchError(
            "torque_and_encoder_disagree",
            "a positive torque makes the encoder count down, a negative torque up: torque or encoder is "
            "inverted. Look in which direction a positive torque moves the link: if this is your positive direction, "
            "the encoder is inverted, otherwise the torque is inverted",
        )

    def _judge_scales(self, axis: Axis, breakaway: tuple[float, float]) -> None:
        expected, friction = self._expected, 0.5 * (breakaway[0] + breakaway[1])
        stated = expected.breakaway
        if stated is None:
            return
        if scale_fault(expected, friction, math.nan) is None:
            self._say(
                f"friction at rest {friction:.3f} N·m; the joint file states {stated:.3f} N·m"
            )
            return
        inertia = math.nan
        if expected.inertia is not None:
            reach = _REACH * axis.sizes.span / max(1.0, friction / stated)
            pushes = self._pushes(axis, breakaway, _FEW_PUSHES, max(reach, axis.sizes.least))
            inertia = motion_of(pushes).inertia if informed(pushes) else math.nan
            self.found["inertia"] = inertia if math.isfinite(inertia) else None
        code = scale_fault(expected, friction, inertia)
        assert code is not None
        raise RefusedBenchError(
            code,
            f"the joint moves at {friction:.4g} N·m by the joint file's constants, {friction / stated:.3g} times "
            f"the stated friction of {stated:.4g} N·m"
            + ("" if math.isnan(inertia) else f", with an inertia of {inertia:.3g} kg·m²")
            + "; if the stated friction is only a guess, set compare_friction = false in "
            "[session.first_motion]",
        )

    def _pushes(
        self, axis: Axis, breakaway: tuple[float, float], pairs: int, reach: float
    ) -> list[Push]:
        pushes = []
        for _ in range(pairs):
            for direction in (1.0, -1.0):
                lost = axis.lost
                found = push(axis, direction, STRENGTH * breakaway[direction < 0.0], reach)
                if axis.lost == lost:  # otherwise the duration of the torque is not known
                    pushes.append(found)
        return pushes

    def _judge_sensor(self, axis: Axis, breakaway: tuple[float, float]) -> Motion:
        """Push until inertia and sensor are clear. Return the fitted motion."""
        expected, span = self._expected, axis.sizes.span
        reach = _REACH * span
        pushes: list[Push] = []
        motion, response = Motion(math.nan, 0.0, 0.0), SensorResponse(0.0, math.inf)
        for pair in range(_MOST):
            pushes += self._pushes(axis, breakaway, 1, reach)
            widest = max((each.width for each in pushes[-2:]), default=0.0)
            fastest = max((each.fastest for each in pushes[-2:]), default=0.0)
            if widest < _WIDE * span and fastest < _QUICK * self._options.velocity:
                reach = min(reach + _REACH * span, _FARTHEST * span)
            if pair + 1 < _FEWEST or not pushes:
                continue
            motion = motion_of(pushes)
            clear = informed(pushes)
            if expected.sensor:
                response = sensor_response(pushes, motion)
                clear = clear and abs(response.significance) > _CLEAR
            if clear or axis.now > _PUSHED * self._options.longest:
                break
        if math.isfinite(motion.inertia):
            self.found["inertia"] = motion.inertia
            stated = expected.inertia
            beside = "" if stated is None else f"; the joint file states {stated:.3g} kg·m²"
            self._say(f"inertia {motion.inertia:.3g} kg·m²{beside}")
        self._judge_inertia(motion.inertia)
        if expected.sensor:
            self._judge_response(response)
        return motion

    def _judge_inertia(self, inertia: float) -> None:
        """Judge the inertia. Without a stated friction it checks only the torque constant, not the gear ratio."""
        expected = self._expected
        known = expected.breakaway is not None  # then the friction has confirmed the scales
        if not known:
            self.unchecked.append("gear_ratio")
        stated = expected.inertia
        if stated is None or not math.isfinite(inertia):
            self.unchecked.append("inertia" if known else "torque_constant")
            return
        ratio = inertia / stated
        if 1.0 / _FARTHER <= ratio <= _FARTHER:
            return
        said = (
            f"the joint's inertia is {inertia:.3g} kg·m² by the joint file's constants, {ratio:.3g} times the "
            f"stated inertia of {stated:.3g} kg·m²"
        )
        if known:
            raise RefusedBenchError(
                "inertia",
                f"{said}, but the friction agrees with the joint file: rotor_inertia or [link] is wrong",
            )
        # A wrong gear ratio does not change the rotor's inertia. It can only increase the link's.
        raise RefusedBenchError(
            "torque_constant" if ratio < 1.0 else "torque_constant_or_gear_ratio",
            f"{said}: one of the constants or the stated inertia is wrong",
        )

    def _judge_response(self, response: SensorResponse) -> None:
        z = response.significance * self._expected.sensor_sign
        if abs(z) <= _CLEAR:
            self.unchecked.append("sensor_sign")
            self._say(f"torque sensor: sign not clear (response of {abs(z):.1f} standard errors)")
            return
        self.signs["sensor"] = 1 if z > 0.0 else -1
        if z < 0.0:
            raise RefusedBenchError(
                "sensor_sign",
                f"the torque sensor's reading falls when the link accelerates in the positive direction "
                f"(response of {abs(z):.0f} standard errors): the sensor is inverted, sensor_gain has the wrong sign, "
                "or torque and encoder are both inverted",
            )
        self._say(f"torque sensor: right sign (response of {z:.0f} standard errors)")

    def _under_control(
        self, axis: Axis, breakaway: tuple[float, float], motion: Motion, wind_up: float
    ) -> None:
        inertia = motion.inertia if math.isfinite(motion.inertia) else self._expected.inertia
        if inertia is None:
            self.unchecked.append("control")
            return
        axis.encoder_watch = EncoderWatch(self._sure, inertia, axis.resolution)
        for amplitude in axis.sizes.moves:
            worst = small_move(axis, amplitude, breakaway, inertia, wind_up)
            self._say(
                f"under control: {math.degrees(amplitude):.2f}° and back, largest error {math.degrees(worst):.3f}°"
            )
