"""The drive's watchdog tried by a host that falls silent: proven, or the bench is refused."""

import re
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

import jointid as jid
from jointid.base.errors import InputError
from jointid.hardware import (
    Bench,
    DriveEnd,
    DriveFaultError,
    DriveSilence,
    EmulatedBus,
    FirstMotion,
    Watchdog,
)
from jointid.hardware.elmo import report, setup
from jointid.hardware.elmo.drive import ElmoDrive
from jointid.hardware.elmo.emulated_bench import elmo_devices
from jointid.hardware.elmo.emulated_drive import EmulatedElmo
from jointid.hardware.elmo.options import ElmoOptions
from jointid.hardware.proof import procedure
from jointid.hardware.proof.certificate import Certificate
from jointid.hardware.proof.steps import Steps
from jointid.hardware.session.motor_state import MotorState

EXAMPLE = Path(__file__).resolve().parents[2] / "examples" / "hardware" / "joint.toml"
AWAITED = 0.05  # [s], the default


def proven(
    change: Callable[[EmulatedElmo], object] | None = None, period: float = 2e-3
) -> tuple[FirstMotion, Bench]:
    bench = Bench.load(EXAMPLE)
    bench = replace(bench, options=replace(bench.options, period=period))
    devices = elmo_devices(bench, 0)
    if change is not None:
        change(devices[0])
    with EmulatedBus(*devices) as bus:
        drive = ElmoDrive(bus, bench.joint, bench.drive)
        result = jid.hardware.first_motion(bench, drive=drive, watchdog=True)
    assert not devices[0].motor_on
    if result.passed:
        assert devices[0].failure == 0  # a session would not start with it
    return result, bench


@pytest.fixture
def only_the_end(monkeypatch: pytest.MonkeyPatch) -> None:
    """Without the motions, which other tests try: the drive connected, its motor on."""

    def short(self: Steps, interruptions: Any) -> None:
        self._ready(interruptions).enable()

    monkeypatch.setattr(Steps, "run", short)


@pytest.mark.parametrize("period", [4e-3, pytest.param(2e-3, marks=pytest.mark.slow)])
def test_a_right_bench_passes_and_says_when(period: float) -> None:
    result, bench = proven(period=period)
    assert result.passed, result.report()
    assert result.watchdog is not None
    assert AWAITED < result.watchdog < AWAITED + 2e-3
    assert "watchdog" not in result.unchecked
    assert "emergency_stop" in result.unchecked
    assert "watchdog: the motor was off 5" in result.report()
    assert Certificate.of(bench, result).found["watchdog"] == result.watchdog
    assert "watchdog" not in result.to_dict()


def without(index: int) -> Callable[[EmulatedElmo], None]:
    """A drive that does not take an object."""

    def change(drive: EmulatedElmo) -> None:
        write = drive.objects.write

        def some(at: int, subindex: int, given: bytes) -> None:
            if at != index:
                write(at, subindex, given)

        drive.objects.write = some  # type: ignore[method-assign,assignment]

    return change


def test_a_drive_that_is_not_armed_is_refused_before_it_moves() -> None:
    result, _ = proven(without(0x6007))
    assert not result.passed
    assert result.reason == "drive_fault"
    assert "6007h" in result.message
    assert result.largest_torque == 0.0


def idle(drive: EmulatedElmo) -> None:
    """It says that it is armed, tells of the lost heartbeat, and leaves the motor on."""
    drive._network.lose_host = lambda: None  # type: ignore[method-assign]


def deaf(drive: EmulatedElmo) -> None:
    """It does not even look."""
    drive._network._heartbeat_lost = lambda: None  # type: ignore[method-assign]


@pytest.mark.usefixtures("only_the_end")
@pytest.mark.parametrize("change", [idle, deaf])
def test_a_drive_that_goes_on_is_refused(change: Callable[[EmulatedElmo], None]) -> None:
    result, _ = proven(change)
    assert result.reason == "watchdog"
    assert "still on after 100 ms" in result.message
    assert result.watchdog is None
    assert "watchdog" in result.unchecked
    assert result.motor_off


@pytest.mark.usefixtures("only_the_end")
def test_a_drive_that_is_not_armed_but_says_so_is_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    for module in (setup, report):
        monkeypatch.setattr(module, "watchdog_objects", lambda *_: (), raising=False)
    result, _ = proven(without(0x6007))
    assert result.reason == "watchdog"


@pytest.mark.usefixtures("only_the_end")
def test_a_motor_that_goes_off_for_another_reason_proves_nothing() -> None:
    def change(drive: EmulatedElmo) -> None:
        drive._network._heartbeat_lost = lambda: drive.switch(on=False)  # type: ignore[method-assign]

    result, _ = proven(change)
    assert result.reason == "watchdog"
    assert "another reason" in result.message


@pytest.mark.usefixtures("only_the_end")
def test_a_drive_that_tells_nothing_is_asked() -> None:
    def change(drive: EmulatedElmo) -> None:
        network = drive._network

        def switch_off_in_silence() -> None:
            network.lose_host()
            network.forget_heartbeat()

        network._heartbeat_lost = switch_off_in_silence  # type: ignore[method-assign]

    result, _ = proven(change)
    assert result.passed, result.report()
    assert result.watchdog == pytest.approx(2 * AWAITED, abs=2e-3)
    assert "at most 100" in result.report()


@pytest.mark.usefixtures("only_the_end")
def test_another_fault_in_the_silence_keeps_its_name() -> None:
    def change(drive: EmulatedElmo) -> None:
        drive._network._heartbeat_lost = lambda: drive.fail("over-voltage")  # type: ignore[method-assign]

    result, _ = proven(change)
    assert result.reason == "drive_fault"


def test_a_drive_that_cannot_fall_silent_is_bad_input() -> None:
    bench = Bench.load(EXAMPLE)

    class Other:
        """Without the method."""

    with pytest.raises(InputError, match="fall_silent"):
        jid.hardware.first_motion(bench, drive=Other(), watchdog=True)  # type: ignore[arg-type]


def test_a_motor_that_is_off_is_not_taken_for_one_that_went_off() -> None:
    bench = Bench.load(EXAMPLE)
    with EmulatedBus(*elmo_devices(bench, 0)) as bus:
        drive = ElmoDrive(bus, bench.joint, bench.drive)
        drive.connect(bench.options.period)
        with pytest.raises(DriveFaultError, match="off before"):
            drive.fall_silent()
        drive.close()


@pytest.mark.usefixtures("only_the_end")
def test_a_drive_without_a_serial_number_is_named() -> None:
    bench = Bench.load(EXAMPLE)
    devices = elmo_devices(bench, 0)
    devices[0].objects.constant(0x1018, 4, 4, 0)
    with EmulatedBus(*devices) as bus:
        drive = ElmoDrive(bus, bench.joint, bench.drive)
        result = jid.hardware.first_motion(bench, drive=drive)
    assert result.passed
    assert "serial_number" in result.unchecked
    assert "no serial number" in result.report()


@pytest.mark.usefixtures("only_the_end")
@pytest.mark.parametrize(("state", "reason"), [("damped", None), ("held", "watchdog")])
def test_a_drive_must_do_what_it_declares(
    state: MotorState, reason: str | None, monkeypatch: pytest.MonkeyPatch
) -> None:
    silence = DriveSilence(allowed=0.05, state=state, told=0.0505, asked=0.1, missed_host=True)
    declared = Watchdog(time=0.05, fed_by="heartbeat", then="damped", read_back=True)
    monkeypatch.setattr(ElmoDrive, "fall_silent", lambda _: silence)
    monkeypatch.setattr(ElmoOptions, "watchdog", declared)
    bench = Bench.load(EXAMPLE)
    bench = replace(bench, options=replace(bench.options, acknowledge_damped=True))
    with EmulatedBus(*elmo_devices(bench, 0)) as bus:
        result = jid.hardware.first_motion(
            bench, drive=ElmoDrive(bus, bench.joint, bench.drive), watchdog=True
        )
    assert result.reason == reason
    assert result.drive_watchdog == declared
    said = "the motor was damped 50.5 ms" if reason is None else "the motor is held after 100 ms"
    assert said in result.report()


def test_the_older_name_of_a_motors_state_is_understood() -> None:
    known = {"allowed": 0.05, "told": None, "asked": 0.1, "missed_host": False}
    for off, state in ((True, "off"), (False, "on"), (None, None)):
        end, silence = DriveEnd(motor_off=off), DriveSilence(motor_off=off, **known)  # type: ignore[arg-type]
        assert (end.state, end.motor_off) == (silence.state, silence.motor_off) == (state, off)
    end = replace(DriveEnd(state="damped"), failure="it says so")
    assert (end.state, end.motor_off, end.failure) == ("damped", False, "it says so")
    with pytest.raises(InputError, match="state is 'of'"):
        DriveEnd(state="of")  # type: ignore[arg-type]


def test_a_proof_speaks_of_no_maker() -> None:
    folder = Path(procedure.__file__).parent
    names = r"heartbeat|elmo|canopen|\bSYNC\b|\b(HL|LL|PL|CL|MO|TC|SR)\b|[0-9A-F]{4}h\b"
    for path in sorted(folder.glob("*.py")):
        assert not re.findall(names, path.read_text(encoding="utf-8"), re.IGNORECASE), path.name
