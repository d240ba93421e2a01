"""A first motion: wrong benches are refused for the right reason, before they go far; right ones pass."""

import math
import signal
from dataclasses import replace
from typing import Any

import pytest
from first_motion_benches import (
    BOTH,
    FARTHEST,
    FRICTIONS,
    STRONG,
    THESIS,
    WEAK,
    WRONG,
    bench_with,
    breakaway,
    moved,
    quick_and_slow,
    without_sensor,
)

import jointid as jid
from jointid.hardware.bench.emulated_joints import true_joint
from jointid.hardware.elmo.drive import ElmoDrive
from jointid.hardware.elmo.emulated_bench import elmo_devices
from jointid.hardware.elmo.emulated_drive import EmulatedElmo
from jointid.hardware.emulated.bus import EmulatedBus
from jointid.hardware.emulated.faults import BusFault
from jointid.hardware.proof.expected import expected_of
from jointid.hardware.proof.result import UNCHECKED, FirstMotion
from jointid.simulation.plant import Bristle
from jointid.simulation.stepped import stepped_joint


@pytest.mark.parametrize(("friction", "quick"), quick_and_slow("thesis", *FRICTIONS))
def test_a_right_bench_passes(friction: str, quick: bool) -> None:
    bench = bench_with(FRICTIONS[friction], quick=quick)
    result, spy = moved(bench, seed=1)
    assert result.passed, result.report()
    assert result.reason is None
    assert result.duration < 60.0
    assert spy.way < FARTHEST
    assert result.travel == pytest.approx(spy.way, abs=2e-5)
    assert spy.torque < 1.3 * breakaway(bench)
    for torque in result.breakaway:
        assert torque == pytest.approx(breakaway(bench), rel=0.06)
    assert result.inertia == pytest.approx(2.77, rel=0.3)
    assert result.signs == {"torque_and_encoder": 1, "sensor": 1}
    assert result.unchecked == (
        *("positive_direction", "homing", "backlash", "watchdog", "emergency_stop"),
    )
    assert "passed" in result.report()


@pytest.mark.parametrize(("friction", "quick"), quick_and_slow("weak", "weak", "strong"))
@pytest.mark.parametrize("number", range(len(WRONG)))
def test_a_wrong_bench_is_refused(friction: str, quick: bool, number: int) -> None:
    wrong, reasons = WRONG[number]
    bench = bench_with(FRICTIONS[friction], quick=quick, **wrong)
    result, spy = moved(bench, seed=number)
    assert not result.passed
    assert result.reason in reasons, result.report()
    assert result.motor_off
    assert spy.way < FARTHEST
    assert spy.torque < 1.3 * breakaway(bench), result.report()
    assert result.reason in result.report()


def test_signs_are_judged_before_scales() -> None:
    result, _ = moved(bench_with((WEAK[0], THESIS[1]), torque_sign=-1))
    assert result.reason == "torque_and_encoder_disagree"


def test_both_inverted_show_in_the_sensor() -> None:
    result, _ = moved(bench_with(torque_sign=-1, encoder_sign=-1))
    assert result.reason == "sensor_sign"
    assert "torque and encoder are both inverted" in result.message


@pytest.mark.slow
def test_both_inverted_look_right_without_a_sensor() -> None:
    result, _ = moved(without_sensor(bench_with(torque_sign=-1, encoder_sign=-1)))
    assert result.passed
    assert "positive_direction" in result.unchecked


@pytest.mark.slow
def test_friction_that_is_stated_is_held_against_the_bench() -> None:
    assert moved(bench_with((WEAK[0], THESIS[1])))[0].reason in ("gear_ratio", BOTH)


def test_friction_that_is_only_a_guess_is_not_held_against_the_bench() -> None:
    bench = bench_with((WEAK[0], THESIS[1]))
    guessed = replace(bench, first_motion=replace(bench.first_motion, compare_friction=False))
    result, spy = moved(guessed)
    assert result.passed, result.report()
    assert "gear_ratio" in result.unchecked
    assert spy.torque < 1.3 * 3.0


def test_without_friction_the_inertia_tells_of_the_torque_constant() -> None:
    bench = bench_with(STRONG, torque_scale=3.0)
    bench = replace(bench, first_motion=replace(bench.first_motion, compare_friction=False))
    assert moved(bench)[0].reason == "torque_constant"


@pytest.mark.parametrize("friction", ["weak", "thesis"])
def test_an_encoder_that_hangs_shows_in_the_sensor(friction: str) -> None:
    bench = bench_with(FRICTIONS[friction])
    result, spy = moved(bench, change=lambda drive: setattr(drive, "stuck_encoder", 0))
    assert result.reason == "sensor_moves_alone"
    assert spy.way < FARTHEST
    assert spy.torque < 1.3 * breakaway(bench)


def test_without_a_sensor_the_cap_is_low() -> None:
    result, _ = moved(without_sensor(bench_with(STRONG, torque_scale=0.0)))
    assert result.reason == "no_motion_up_to_torque_cap"
    assert 1.9 * 25.0 < result.largest_torque <= 2.0 * 25.0


def test_a_stated_cap_ends_it() -> None:
    bench = bench_with()
    bench = replace(bench, first_motion=replace(bench.first_motion, largest_torque=20.0))
    result, spy = moved(bench)
    assert result.reason == "no_motion_up_to_torque_cap"
    assert 19.0 < spy.torque <= 20.0
    assert "20 N·m" in result.message


def test_gravity_is_the_difference_of_the_directions() -> None:
    bench = bench_with(({"coulomb": 8.0, "static": 0.0}, {"coulomb": 8.0, "static": 0.0}), 0.4)
    result, spy = moved(bench)
    assert result.passed, result.report()
    up, down = result.breakaway
    assert up is not None
    assert down is not None
    weight = 3.0 * 0.25 * 9.817 * math.sin(0.4)
    assert 0.5 * (up - down) == pytest.approx(weight, rel=0.05)
    assert result.inertia == pytest.approx(2.77, rel=0.3)
    assert spy.way < FARTHEST


def test_a_joint_that_swings_is_refused_with_the_motor_off() -> None:
    result, spy = moved(bench_with(WEAK, 1.0))
    assert result.reason == "moving"
    assert spy.torque == 0.0


def test_a_brake_that_opens_under_gravity_is_noticed() -> None:
    """The joint's brake holds it while the motor is off; its friction does not."""

    def braked(drive: EmulatedElmo) -> None:
        free = drive.advance

        def held() -> None:
            if drive.motor_on:
                free()
            else:
                drive._time = drive.bus.now()

        drive.advance = held  # type: ignore[method-assign]

    result, spy = moved(bench_with(WEAK, 1.0), change=braked)
    assert result.reason == "moves_at_zero_torque"
    assert spy.way < 1e-3


@pytest.mark.parametrize(("friction", "quick"), quick_and_slow("weak", "weak", "thesis"))
@pytest.mark.parametrize("sign", [-1, pytest.param(1, marks=pytest.mark.slow)])
def test_a_gear_that_winds_up_has_not_moved_yet(friction: str, quick: bool, sign: int) -> None:
    bench = bench_with(FRICTIONS[friction], quick=quick, torque_sign=sign)

    def wound(drive: EmulatedElmo) -> None:
        assert bench.emulation is not None
        drive.joint = stepped_joint(
            true_joint(bench),
            sensors=bench.emulation.sensors,
            period=bench.options.period,
            bristle=Bristle(stiffness=1e5, damping=300.0),
        )

    result, spy = moved(bench, change=wound)
    assert result.passed is (sign > 0), result.report()
    for torque in result.breakaway:
        assert torque == pytest.approx(breakaway(bench), rel=0.06)
    assert spy.way < FARTHEST


@pytest.mark.parametrize(("factor", "quick"), quick_and_slow(0.05, 0.05, 5.0))
def test_light_and_heavy_joints_pass(factor: float, quick: bool) -> None:
    bench = bench_with(quick=quick)
    rotor = bench.joint.rotor_inertia
    assert rotor is not None
    bench = replace(bench, joint=bench.joint.replace(rotor_inertia=factor * rotor))
    result, spy = moved(bench)
    assert result.passed, result.report()
    assert spy.way < FARTHEST
    assert spy.torque < 1.3 * breakaway(bench)


def test_a_few_lost_answers_are_stood_and_a_dead_bus_is_not() -> None:
    lost = BusFault(kind="drop", start=3.0, stop=3.003, identifier=0x4FF)
    assert moved(bench_with(WEAK), faults=(lost,))[0].passed
    gone = BusFault(kind="drop", start=3.0, stop=99.0, identifier=0x4FF)
    result, _ = moved(bench_with(WEAK), faults=(gone,))
    assert result.reason == "stale_position"


def test_ctrl_c_ends_it_between_two_cycles() -> None:
    bench = bench_with(WEAK)
    lines: list[str] = []

    def interrupt(line: str) -> None:
        lines.append(line)
        if "no torque" in line:
            signal.raise_signal(signal.SIGINT)

    result = jid.hardware.first_motion(bench, emulate=True, callback=interrupt)
    assert (result.passed, result.reason) == (False, "user")
    assert result.motor_off
    assert len(lines) == 3
    assert "positive torque: ended by user" in lines[-1]


def test_a_bug_is_raised_after_the_motor_is_off() -> None:
    bench = bench_with(WEAK)
    devices = elmo_devices(bench)

    def fail(line: str) -> None:
        if "positive" in line:
            raise TypeError("a bug")

    with EmulatedBus(*devices) as bus:
        drive = ElmoDrive(bus, bench.joint, bench.drive)
        with pytest.raises(TypeError, match="a bug"):
            jid.hardware.first_motion(bench, drive=drive, callback=fail)
    assert [on for _, on in devices[0].switchings] == [True, False]
    assert not devices[0].motor_on


def test_a_drive_in_use_is_left_alone() -> None:
    bench = bench_with(WEAK)

    def use(drive: EmulatedElmo) -> None:
        drive.motor_on, drive.state = True, "operational"

    devices = elmo_devices(bench)
    use(devices[0])
    with EmulatedBus(*devices) as bus:
        drive = ElmoDrive(bus, bench.joint, bench.drive)
        result = jid.hardware.first_motion(bench, drive=drive)
    assert result.reason == "drive_fault"
    assert "another program" in result.message
    assert devices[0].motor_on
    assert devices[0].torque_commands == []


def test_counts_that_the_drive_has_otherwise_are_a_difference() -> None:
    bench = bench_with()
    wrong = replace(bench, drive=replace(bench.drive, counts_per_turn=4000))
    for call in (jid.hardware.check_bench, jid.hardware.first_motion):
        devices = elmo_devices(bench)
        with EmulatedBus(*devices) as bus:
            found: Any = call(wrong, drive=ElmoDrive(bus, wrong.joint, wrong.drive))
        assert not found.passed
        assert devices[0].switchings == []
        text = found.text() if isinstance(found, jid.hardware.BenchCheck) else found.message
        assert "CA[18]" in text
        assert "expected: 4000 count" in text


def test_each_code_of_what_is_unchecked_is_explained() -> None:
    result = FirstMotion(passed=True, unchecked=tuple(UNCHECKED))
    assert all(f"{code}: " in result.report() for code in UNCHECKED)


def test_breakaway_is_stated_by_the_models_own_terms() -> None:
    joint = bench_with().joint
    assert expected_of(joint).breakaway == pytest.approx(30.0)
    free = joint.replace(model=joint.model.replace(asymmetric=True), parameters={})
    assert expected_of(free).breakaway is None
    sides = {
        "coulomb_positive": 10.0,
        "coulomb_negative": 14.0,
        "static_positive": 2.0,
        "static_negative": 4.0,
    }
    assert expected_of(free.replace(parameters=sides)).breakaway == pytest.approx(15.0)
    simple = free.replace(model=jid.Model.parse("coulomb_viscous"), parameters={"coulomb": 7.0})
    assert expected_of(simple).breakaway == pytest.approx(7.0)


def test_options_are_checked() -> None:
    for wrong in ({"counts": 1}, {"growth_time": 0.0}, {"moves": (-1.0,)}, {"watch_sensor": 1}):
        values: dict[str, Any] = wrong
        with pytest.raises(jid.InputError, match=next(iter(wrong))):
            jid.hardware.FirstMotionOptions(**values)


@pytest.mark.parametrize(("factor", "quick"), quick_and_slow(5.0, 0.1, 5.0))
def test_an_inertia_that_is_not_the_stated_one_is_refused(factor: float, quick: bool) -> None:
    bench = bench_with(STRONG, quick=quick)
    rotor = bench.joint.rotor_inertia
    assert rotor is not None
    assert bench.emulation is not None

    def other(drive: EmulatedElmo) -> None:
        assert bench.emulation is not None
        drive.joint = stepped_joint(
            true_joint(bench).replace(rotor_inertia=factor * rotor),
            sensors=bench.emulation.sensors,
            period=bench.options.period,
        )

    result, spy = moved(bench, change=other)
    assert result.reason == "inertia", result.report()
    assert spy.way < FARTHEST
    assert spy.torque < 1.3 * breakaway(bench)


@pytest.mark.parametrize(("period", "said"), [(0.001, "the bus load is"), (0.01, "too long")])
def test_a_period_that_is_not_for_a_first_motion_is_refused(period: float, said: str) -> None:
    bench = bench_with(WEAK)
    result, spy = moved(replace(bench, options=replace(bench.options, period=period)))
    assert result.reason == "not_ready"
    assert said in result.message
    assert spy.torque == 0.0
