"""Each limit of a session at its edge: what is allowed, what is one step too much, and by how much."""

import math
import re
from dataclasses import fields, replace
from typing import Any

import pytest

import jointid as jid
from jointid.hardware.can.bus_errors import error_frame_meaning
from jointid.hardware.elmo.options import ElmoOptions
from jointid.hardware.emulated.faults import BusFault, drive_failure
from jointid.hardware.session.drive import DriveSample
from jointid.hardware.session.guard import Guard
from jointid.hardware.session.limits import SessionLimits
from jointid.hardware.session.options import SessionOptions
from jointid.hardware.session.stop import LimitError, Stop

PERIOD, COUNT = 2e-3, 1e-5
LIMITS = SessionLimits(
    position=(-1.0, 2.0), velocity=3.0, torque=100.0, torque_rate=5000.0, tracking_error=0.1
)


def guard(breakaway: float | None = None, **changes: Any) -> Guard:
    return Guard(replace(LIMITS, **changes), PERIOD, COUNT, breakaway=breakaway)


def sample(position: float = 0.0, **more: Any) -> DriveSample:
    return DriveSample(time=0.0, position=position, **more)


def stopped(act: Any) -> LimitError:
    with pytest.raises(LimitError) as caught:
        act()
    return caught.value


@pytest.mark.parametrize(("inside", "beyond", "bound"), [(-1.0, -1.0001, -1.0), (2.0, 2.0001, 2.0)])
def test_position_window_holds_its_edges(inside: float, beyond: float, bound: float) -> None:
    watched = guard()
    watched.measured(sample(inside), 0.0, 0.0)
    error = stopped(lambda: watched.measured(sample(beyond), 0.0, 0.0))
    assert (error.limit, error.measured, error.allowed) == ("position", beyond, bound)
    assert "outside -1.0000 to 2.0000 rad" in str(error)


@pytest.mark.parametrize("sign", [-1.0, 1.0])
def test_velocity_and_tracking_error_hold_both_ways(sign: float) -> None:
    watched = guard()
    watched.measured(sample(), sign * 3.0, sign * 0.1)
    error = stopped(lambda: watched.measured(sample(), sign * 3.01, 0.0))
    assert (error.limit, error.measured, error.allowed) == ("velocity", sign * 3.01, 3.0)
    error = stopped(lambda: watched.measured(sample(), 0.0, sign * 0.101))
    assert (error.limit, error.measured, error.allowed) == ("tracking_error", sign * 0.101, 0.1)
    watched.measured(sample(), 0.0, None)  # without feedback there is none


def test_what_is_no_number_is_beyond_every_limit() -> None:
    for position, velocity, error, limit in (
        (math.nan, 0.0, 0.0, "position"),
        (0.0, math.nan, 0.0, "velocity"),
        (0.0, 0.0, math.nan, "tracking_error"),
    ):
        wording = stopped(lambda p=position, v=velocity, e=error: guard().measured(sample(p), v, e))
        assert wording.limit == limit
    for reading in (math.nan, math.inf):
        wording = stopped(lambda r=reading: guard().measured(sample(reading=r), 0.0, 0.0))
        assert wording.limit == "sensor"
    for torque in (math.nan, -math.inf):
        wording = stopped(lambda t=torque: guard().commanded(t, 0))
        assert wording.limit == "torque"
        assert "not finite" in str(wording)


@pytest.mark.parametrize("sign", [-1.0, 1.0])
def test_torque_is_held_but_for_rounding(sign: float) -> None:
    guard(torque_rate=1e6).commanded(sign * 100.0 * (1.0 + 1e-12), 0)
    error = stopped(lambda: guard().commanded(sign * 100.01, 0))
    assert (error.limit, error.measured, error.allowed) == ("torque", sign * 100.01, 100.0)


def test_the_torque_accepted_by_the_drive_is_checked_too() -> None:
    watched = guard()
    watched.accepted(100.0, 100.0 * (1.0 + 1e-7))  # a float of 32 bits
    for wording in (100.1, -100.1, math.nan, math.inf):
        assert stopped(lambda t=wording: guard().accepted(100.0, t)).limit == "torque"
    for asked, accepted in ((80.0, 75.0), (-80.0, -75.0), (0.0, 0.0)):  # rounded
        for _ in range(30):
            watched.accepted(asked, accepted)
    watched.commanded(0.0, 0)
    for _ in range(21):
        watched.accepted(80.0, 40.0)  # the drive's own limit is lower
    error = stopped(lambda: watched.commanded(0.0, 0))
    assert (error.limit, error.measured) == ("saturated_samples", 21)


def test_rate_counts_from_one_command_to_the_next() -> None:
    assert stopped(lambda: guard().commanded(10.1, 0)).limit == "torque_rate"  # enabled at zero
    watched = guard()
    for torque in (10.0, 20.0, 10.0):
        watched.commanded(torque, 0)
    error = stopped(lambda: watched.commanded(-0.1, 0))
    assert error.limit == "torque_rate"
    assert error.measured == pytest.approx(-5050.0)
    assert error.allowed == 5000.0
    assert "late or lost cycles" in str(error)


def test_saturations_count_in_all() -> None:
    guard().commanded(0.0, 20)
    error = stopped(lambda: guard().commanded(0.0, 21))
    assert (error.limit, error.measured, error.allowed) == ("saturated_samples", 21, 20)
    for cause in ("too small for this motion", "torque_constant", "gear_ratio", "brake"):
        assert cause in str(error)


def test_missed_deadlines_count_in_a_row() -> None:
    watched = guard(missed_deadlines=2)
    for late in (1e-3, 1e-3, 0.0, 1e-3, 1e-3):
        watched.timed(late)
    error = stopped(lambda: watched.timed(2e-3))
    assert (error.limit, error.measured, error.allowed) == ("missed_deadlines", 3, 2)
    assert "2.00 ms" in str(error)


def test_clipped_readings_count_in_a_row() -> None:
    watched = guard(clipped_samples=2)
    for clipped in (True, True, False, True, True):
        watched.measured(sample(clipped=clipped), 0.0, 0.0)
    error = stopped(lambda: watched.measured(sample(clipped=True), 0.0, 0.0))
    assert (error.limit, error.measured, error.allowed) == ("clipped_samples", 3, 2)


def repeated(watched: Guard, velocity: float, torque: float, times: int) -> None:
    """A sample in motion, then the same position again and again at another torque."""
    watched.measured(sample(0.5), velocity, 0.0)
    watched.accepted(torque, torque)
    for _ in range(times):
        watched.measured(sample(0.5), 0.0, 0.0)


def test_position_that_repeats_after_motion_is_an_encoder_that_hangs() -> None:
    # 20 counts in a cycle are 0.1 rad/s.
    repeated(guard(), 0.11, 0.0, 10)
    error = stopped(lambda: repeated(guard(), -0.11, 0.0, 11))
    assert (error.limit, error.measured, error.allowed) == ("repeated_positions", 11, 10)
    assert "the speed was 0.110 rad/s before" in str(error)
    repeated(guard(), 0.09, 0.0, 100)  # friction may have stopped it


def test_position_that_repeats_though_the_torque_has_changed_much() -> None:
    for torque, stops in ((0.0, False), (-50.1, True)):
        watched = guard()
        watched.accepted(50.0, 50.0)
        watched.measured(sample(0.5), 0.0, 0.0)
        watched.accepted(torque, torque)
        for _ in range(10):
            watched.measured(sample(0.5), 0.0, 0.0)
        if not stops:
            watched.measured(sample(0.5), 0.0, 0.0)
            continue
        error = stopped(lambda w=watched: w.measured(sample(0.5), 0.0, 0.0))
        assert error.limit == "repeated_positions"
        assert "changed by 100 N·m" in str(error)
        assert "states no friction" in str(error)


@pytest.mark.parametrize(
    ("breakaway", "most"),
    [
        (20.0, 100.0),  # the torque limit is more than four times it
        (30.0, 120.0),  # twice, for the swing, and twice for what is not known of it
        (60.0, 198.0),  # the joint has no torque left
    ],
)
def test_torque_may_swing_by_twice_the_breakaway(breakaway: float, most: float) -> None:
    for change, stops in ((most - 0.1, False), (most + 0.1, True)):
        watched = guard(breakaway)
        watched.accepted(100.0, 100.0)
        watched.measured(sample(0.5), 0.0, 0.0)
        watched.accepted(100.0 - change, 100.0 - change)
        for _ in range(10):
            watched.measured(sample(0.5), 0.0, 0.0)
        if not stops:
            watched.measured(sample(0.5), 0.0, 0.0)
            continue
        error = stopped(lambda w=watched: w.measured(sample(0.5), 0.0, 0.0))
        assert error.limit == "repeated_positions"
        assert "states no friction" not in str(error)


def test_position_that_moves_by_a_count_is_none_that_hangs() -> None:
    watched = guard()
    for cycle in range(100):
        watched.measured(sample(0.5 + COUNT * (cycle // 10)), 0.2, 0.0)


def test_measured_torque_beyond_the_limit() -> None:
    watched = guard(torque_difference=1e3)
    watched.measured(sample(torque=-120.0), 0.0, 0.0)  # 1.2 times the commanded limit
    error = stopped(lambda: watched.measured(sample(torque=-120.1), 0.0, 0.0))
    assert (error.limit, error.measured, error.allowed) == ("measured_torque", -120.1, 120.0)
    error = stopped(lambda: guard(measured_torque=90.0).measured(sample(torque=90.5), 0.0, 0.0))
    assert error.allowed == 90.0


def test_measured_torque_that_stays_away_from_the_command() -> None:
    watched = guard()
    watched.accepted(60.0, 60.0)
    for _ in range(100):
        watched.measured(sample(torque=35.0), 0.0, 0.0)  # a quarter of 100 N·m off is allowed
    for torque in (60.0, 10.0) * 50:
        watched.measured(sample(torque=torque), 0.0, 0.0)  # in the mean it is no more
    for torque in (60.0,) * 10 + (35.0,) * 10:
        watched.measured(sample(torque=torque), 0.0, 0.0)
    error = stopped(lambda: watched.measured(sample(torque=34.0), 0.0, 0.0))
    assert error.limit == "torque_difference"
    assert error.measured == pytest.approx(25.1)
    assert error.allowed == 25.0


def test_drive_that_is_a_cycle_behind_is_no_fault() -> None:
    watched = guard()
    felt = 0.0
    for cycle in range(200):
        torque = 90.0 * (-1.0) ** cycle  # chatter
        watched.measured(sample(torque=felt), 0.0, 0.0)
        felt = -torque
        watched.accepted(torque, torque)


def test_drive_that_tells_no_current_is_not_held_to_one() -> None:
    watched = guard()
    watched.accepted(100.0, 100.0)
    for _ in range(50):
        watched.measured(sample(), 0.0, 0.0)


@pytest.mark.parametrize(
    ("classes", "details", "meaning"),
    [
        (0x40, 0, "bus-off"),
        (0x20, 0, "no node acknowledges"),
        (0x44, 0, "controller in trouble.*bus-off"),
        (0x2000, 0, "unknown class 0x2000"),
        (0x02, 0, "^$"),
        (0x04, 0x40, "^$"),  # back to error-active
        (0x204, 0x40, "^$"),  # with the counters of errors
        (0x200, 0, "^$"),
        (0x04, 0x20, "controller in trouble"),
        (0x04, 0x41, "controller in trouble"),  # it has lost frames before it recovered
        (0x104, 0x40, "trouble.*restarted after a bus-off"),
    ],
)
def test_error_frames_in_words(classes: int, details: int, meaning: str) -> None:
    frame = bytes((0, details, 0, 0, 0, 0, 0, 0))
    assert re.search(meaning, error_frame_meaning(classes, frame))
    if not details:
        assert re.search(meaning, error_frame_meaning(classes))


@pytest.mark.parametrize("name", [f.name for f in fields(SessionLimits) if f.name != "position"])
@pytest.mark.parametrize("value", [0, -1, math.nan])
def test_limit_that_is_none_is_refused(name: str, value: float) -> None:
    with pytest.raises(jid.InputError, match=f"{name} is {value}: more than 0 is expected"):
        SessionLimits(**{name: value})  # type: ignore[arg-type]


@pytest.mark.parametrize("name", [f.name for f in fields(SessionLimits) if f.name != "position"])
@pytest.mark.parametrize("value", ["a", True, [1.0]])
def test_limit_of_a_wrong_kind_is_refused(name: str, value: Any) -> None:
    with pytest.raises(jid.InputError, match="a number is expected") as refused:
        SessionLimits(**{name: value})
    assert refused.value.argument == name


def test_only_a_limit_that_may_be_left_out_may_be_none() -> None:
    assert SessionLimits(measured_torque=None, torque_difference=None) == SessionLimits()
    with pytest.raises(jid.InputError, match="velocity is None: a number is expected"):
        SessionLimits(velocity=None)  # type: ignore[arg-type]


@pytest.mark.parametrize("window", [None, 1.0, "ab", (1.0,), (0.0, 1.0, 2.0), (0.0, "1")])
def test_window_of_a_wrong_kind_is_refused(window: Any) -> None:
    with pytest.raises(jid.InputError, match="a lowest and a highest angle"):
        SessionLimits(position=window)


@pytest.mark.parametrize("name", [f.name for f in fields(SessionOptions) if f.type != "bool"])
@pytest.mark.parametrize("value", ["x", True, [1.0]])
def test_option_of_a_wrong_kind_is_refused(name: str, value: Any) -> None:
    with pytest.raises(jid.InputError, match=r"a (whole )?number is expected") as refused:
        SessionOptions(**{name: value})
    assert refused.value.argument == name


@pytest.mark.parametrize("window", [(1.0, 1.0), (1.0, -1.0), (math.nan, 1.0), (-math.inf, 0.0)])
def test_window_that_is_none_is_refused(window: tuple[float, float]) -> None:
    with pytest.raises(jid.InputError, match="a lowest and a highest angle"):
        SessionLimits(position=window)


def test_limits_of_a_joint() -> None:
    joint = jid.thesis_joint()
    assert SessionLimits.of(joint).torque == pytest.approx(8.0 * 0.198 * 101.0)  # the smaller
    weak = joint.replace(limits=jid.Limits(torque=160.0, current=2.0))
    assert SessionLimits.of(weak).torque == pytest.approx(2.0 * 0.198 * 101.0)
    assert SessionLimits.of(joint, torque=80.0, velocity=1.0).velocity == 1.0
    assert SessionLimits.of(joint, torque=80.0).largest_measured == pytest.approx(96.0)
    assert SessionLimits.of(joint, torque=80.0).largest_difference == pytest.approx(20.0)
    by_current = joint.replace(limits=replace(joint.limits, torque=None, current=2.0))
    assert SessionLimits.of(by_current).torque == pytest.approx(2.0 * 0.198 * 101.0)


@pytest.mark.parametrize(
    ("build", "message"),
    [
        (lambda: SessionOptions(period=0.0), "period is 0.0: more than 0"),
        (lambda: SessionOptions(settle=-1.0), "settle is -1.0: at least 0"),
        (lambda: SessionOptions(settle=None), "settle is None: a number is expected"),  # type: ignore[arg-type]
        (lambda: SessionOptions(velocity_counts=0), "velocity_counts is 0: 1 to 1000000 is"),
        (lambda: SessionOptions(velocity_counts=2.5), "2.5: a whole number is expected"),  # type: ignore[arg-type]
        (lambda: SessionOptions(answer_timeout=0.0), "answer_timeout is 0.0: more than 0"),
        (lambda: ElmoOptions(heartbeat=0.001), "heartbeat is 0.001: 0.005 to 10 s"),
        (lambda: ElmoOptions(drive_heartbeat=0.03), r"0.001 s to 0.025 s \(half of heartbeat\)"),
        (lambda: BusFault(kind="lost", start=0.0), "kind is 'lost': choose one of drop, delay"),
        (lambda: drive_failure("fire"), "kind is 'fire': choose one of encoder loss"),
    ],
)
def test_setting_that_cannot_be_is_refused(build: Any, message: str) -> None:
    with pytest.raises(jid.InputError, match=message):
        build()


def test_stop_says_which_limit_when_and_by_how_much() -> None:
    stop = Stop(
        limit="velocity",
        phase="run",
        time=1.25,
        moment=3.0,
        message="3.01 rad/s, more than 3 rad/s",
        measured=3.01,
        allowed=3.0,
        motor_off=True,
    )
    assert str(stop) == "stopped by velocity after 1.250 s of run: 3.01 rad/s, more than 3 rad/s"
    assert stop.to_dict()["measured"] == 3.01
