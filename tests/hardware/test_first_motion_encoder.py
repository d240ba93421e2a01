"""A first motion with an encoder that hangs: seen before the torque, or as soon as the joint must have moved."""

import math
from collections.abc import Callable
from dataclasses import replace
from typing import Any

import pytest
from first_motion_benches import (
    FARTHEST,
    FRICTIONS,
    STRONG,
    WEAK,
    WRONG,
    bench_with,
    breakaway,
    moved,
    quick_and_slow,
    without_sensor,
)

import jointid as jid
from jointid.hardware.bench.bench import Bench
from jointid.hardware.bench.first_motion_options import FirstMotionOptions
from jointid.hardware.elmo.emulated_drive import EmulatedElmo
from jointid.hardware.proof.sizes import sizes_of


def with_options(bench: Bench, **options: Any) -> Bench:
    return replace(bench, first_motion=replace(bench.first_motion, **options))


def test_without_sensor_and_friction_a_cap_must_be_given() -> None:
    bench = with_options(without_sensor(bench_with(WEAK)), compare_friction=False)
    result, spy = moved(bench, change=lambda drive: setattr(drive, "stuck_encoder", 0))
    assert result.reason == "not_ready"
    assert "--largest-torque" in result.message
    assert spy.torque == spy.way == 0.0
    unwatched = with_options(bench_with(WEAK), compare_friction=False, watch_sensor=False)
    assert moved(unwatched)[0].reason == "not_ready"
    result, _ = moved(with_options(bench, largest_torque=5.0))
    assert result.passed, result.report()
    assert "encoder" not in result.unchecked


@pytest.mark.parametrize("friction", ["weak", "strong"])
def test_an_encoder_that_nobody_saw_count_is_named_unchecked(friction: str) -> None:
    """What the documents say of it: a runaway up to the cap."""
    bench = without_sensor(bench_with(FRICTIONS[friction]))
    result, _ = moved(bench, change=lambda drive: setattr(drive, "stuck_encoder", 0))
    assert result.reason == "no_motion_up_to_torque_cap"
    assert "encoder" in result.unchecked


def turned(drive: EmulatedElmo) -> None:
    """Somebody turns the joint by 57 counts of the motor a tenth of a second, from 1 s to 3 s."""
    free = drive.advance

    def advance() -> None:
        free()
        drive.slipped_counts = round(570.0 * min(max(drive.bus.now() - 1.0, 0.0), 2.0))

    drive.advance = advance  # type: ignore[method-assign]


def test_a_turn_by_hand_shows_that_the_encoder_counts() -> None:
    bench = with_options(without_sensor(bench_with(STRONG)), hand_turn=5.0)
    result, spy = moved(bench, change=turned)
    assert result.passed, result.report()
    assert any("the encoder counts" in line for line in result.steps)
    assert result.travel == pytest.approx(spy.way, abs=1e-4)  # what the hand did is none of ours


def test_without_a_turn_by_hand_there_is_no_torque() -> None:
    bench = with_options(without_sensor(bench_with(STRONG)), hand_turn=2.0)
    result, spy = moved(bench, change=lambda drive: setattr(drive, "stuck_encoder", 0))
    assert result.reason == "encoder_stands"
    assert spy.torque == 0.0
    assert not result.largest_torque


def hanging(when: float, way: float) -> Callable[[EmulatedElmo], object]:
    """The encoder hangs when the joint has gone a way [rad] from where it is at a time after the motor is on [s]."""

    def change(drive: EmulatedElmo) -> None:
        free = drive.advance
        seen: dict[str, float] = {}

        def advance() -> None:
            now = drive.bus.now()
            if drive.motor_on:
                seen.setdefault("on", now)
                if now - seen["on"] > when:
                    place = seen.setdefault("place", drive.joint.position)
                    if drive.stuck_encoder is None and abs(drive.joint.position - place) > way:
                        drive.stuck_encoder = drive.counts()
            free()

        drive.advance = advance  # type: ignore[method-assign]

    return change


@pytest.mark.parametrize("sensor", [False, pytest.param(True, marks=pytest.mark.slow)])
@pytest.mark.parametrize(("friction", "quick"), quick_and_slow("strong", "weak", "strong"))
@pytest.mark.parametrize(("when", "degrees"), [(19.0, 0.02), (26.0, 0.1)])
def test_an_encoder_that_hangs_later_is_seen(
    sensor: bool, friction: str, quick: bool, when: float, degrees: float
) -> None:
    bench = bench_with(FRICTIONS[friction], quick=quick)
    bench = bench if sensor else without_sensor(bench)
    result, spy = moved(bench, change=hanging(when, math.radians(degrees)))
    assert result.reason == "encoder_stands", result.report()
    assert spy.way < FARTHEST
    assert spy.torque < 1.3 * breakaway(bench)


def coarse(counts: int, **wrong: Any) -> Bench:
    """A strong joint with so many counts per turn of the output, at half the example's rate."""
    bench = bench_with(STRONG, **wrong)
    motor = round(counts / bench.joint.gear_ratio)
    return replace(bench, drive=replace(bench.drive, counts_per_turn=motor))


@pytest.mark.parametrize(("counts", "degrees"), [(16_471, 0.87), (65_536, 0.4)])
def test_a_right_bench_with_a_coarse_encoder_passes(counts: int, degrees: float) -> None:
    bench = coarse(counts)
    result, spy = moved(bench)
    assert result.passed, result.report()
    assert spy.way < math.radians(degrees)
    assert spy.torque < 1.3 * breakaway(bench)
    assert result.inertia == pytest.approx(2.77, rel=0.4)


@pytest.mark.parametrize("number", range(len(WRONG)))
def test_a_wrong_bench_with_a_coarse_encoder_is_refused(number: int) -> None:
    wrong, reasons = WRONG[number]
    result, spy = moved(coarse(16_471, **wrong), seed=number)
    assert result.reason in reasons, result.report()
    assert spy.way < math.radians(0.9)


def test_a_fine_encoder_keeps_the_travel_and_a_coarse_one_has_forty_counts() -> None:
    count = 2.0 * math.pi / 16_471
    assert sizes_of(FirstMotionOptions(), 1e-6).travel == math.radians(0.4)
    assert sizes_of(FirstMotionOptions(), count).travel == pytest.approx(40.0 * count)
    assert "0.87°" in str(sizes_of(FirstMotionOptions(), count))
    assert sizes_of(FirstMotionOptions(travel=0.01, counts=7), count).few == 7.0 * count
    with pytest.raises(jid.InputError, match="moves"):
        sizes_of(FirstMotionOptions(travel=0.01, moves=(0.02,)), count)
