"""What a review of the session provoked: a motor that nobody watches, stops that get lost, foreign frames."""

import math
import signal
from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import Any

import can
import numpy as np
import pytest
from session_bench import JOINT, PERIOD, devices, law, limits, motion, session

import jointid as jid
from jointid.hardware import DriveFaultError, SessionRefusedError, SessionStoppedError
from jointid.hardware.elmo.drive import ElmoDrive
from jointid.hardware.elmo.emulated_drive import EmulatedElmo
from jointid.hardware.elmo.options import ElmoOptions
from jointid.hardware.elmo.torque_source import AnalogInput, SensorScaling, SyncedConverter
from jointid.hardware.emulated.bus import EmulatedBus
from jointid.hardware.emulated.faults import BusFault
from jointid.hardware.session.limits import SessionLimits
from jointid.hardware.session.session import Session, SessionOptions


def switched_on(elmo: EmulatedElmo, then: Callable[[float], None]) -> None:
    """Do something when the motor comes on."""
    switch = elmo.switch

    def watched(*, on: bool) -> None:
        switch(on=on)
        if on:
            then(elmo.bus.now())

    elmo.switch = watched  # type: ignore[method-assign]


def test_a_bus_that_fails_as_the_motor_comes_on_leaves_it_to_the_drives_watchdog() -> None:
    fault = BusFault(kind="down", start=math.inf)
    elmo, converter = devices()
    bus = EmulatedBus(elmo, converter, faults=(fault,))
    switched_on(elmo, lambda now: setattr(fault, "start", now))
    with pytest.raises(SessionStoppedError) as found:
        session(bus).run()
    assert found.value.stop.phase == "enable"
    bus.sleep_until(fault.start + 2.0 * ElmoOptions().heartbeat)
    assert not elmo.motor_on


def test_a_host_that_dies_before_the_first_cycle_leaves_a_motor_that_is_switched_off() -> None:
    elmo, converter = devices()
    bus = EmulatedBus(elmo, converter)
    drive = ElmoDrive(bus, JOINT)
    drive.connect(PERIOD)
    drive.enable()
    assert elmo.motor_on
    bus.sleep_until(bus.now() + 1.2 * ElmoOptions().heartbeat)
    assert not elmo.motor_on


def test_a_slow_motor_is_waited_for_and_watched() -> None:
    elmo, converter = devices()
    bus = EmulatedBus(elmo, converter)
    status = elmo.status
    asked: list[float] = []

    def late() -> int:
        asked.append(bus.now())
        return status() & ~0x10 if len(asked) < 20 else status()

    elmo.status = late  # type: ignore[method-assign]
    recording = session(bus).run()
    assert recording is not None
    assert len(asked) >= 20


class ChargedTrajectory:
    """A trajectory that takes its time to be evaluated."""

    def __init__(self, bus: EmulatedBus) -> None:
        self._bus, self._inner = bus, motion()
        self.form, self.duration, self.arguments = "thesis", 1.0, ()

    def sample(self, time: Any) -> Any:
        if np.size(time) > 100:
            self._bus.sleep_until(self._bus.now() + 0.2)
        return self._inner.sample(time)


def test_a_long_trajectory_is_evaluated_before_the_motor_is_on() -> None:
    bus = EmulatedBus(*devices())
    slow: Any = ChargedTrajectory(bus)
    options = SessionOptions(period=PERIOD, settle=0.05)
    recording = Session(ElmoDrive(bus, JOINT), law(), slow, limits(), options=options).run()
    assert recording is not None


class NumberlessDrive(ElmoDrive):
    """Says after a while that the joint is at no place."""

    def read(self, timeout: float) -> Any:
        sample = super().read(timeout)
        if self.clock.now() < 0.9:
            return sample
        from dataclasses import replace

        return replace(sample, position=math.nan)


def test_a_stop_whose_number_is_none_is_a_stop_all_the_same() -> None:
    bus = EmulatedBus(*devices())
    options = SessionOptions(period=PERIOD, settle=0.05)
    with pytest.raises(SessionStoppedError) as found:
        Session(NumberlessDrive(bus, JOINT), law(), motion(), limits(), options=options).run()
    assert found.value.stop.limit == "position"
    assert found.value.stop.measured is None
    assert "nan" in str(found.value)
    assert found.value.recording is not None


class FailingBus(EmulatedBus):
    """Raises the system's errors for some milliseconds, as some of python-can's interfaces do."""

    broken = (0.9, 0.903)

    def send(self, msg: can.Message, timeout: float | None = None) -> None:
        if self.broken[0] <= self.now() < self.broken[1]:
            raise OSError(5, "Input/output error")
        super().send(msg, timeout)


def test_an_error_of_the_system_is_one_of_the_bus() -> None:
    elmo, converter = devices()
    bus = FailingBus(elmo, converter)
    with pytest.raises(SessionStoppedError) as found:
        session(bus).run()
    stop = found.value.stop
    assert (stop.limit, stop.motor_off) == ("bus", True)
    assert bus.now() < 0.95
    assert not elmo.motor_on


def test_a_second_session_does_not_touch_a_drive_that_another_moves() -> None:
    elmo, converter = devices()
    bus = EmulatedBus(elmo, converter)
    drive = ElmoDrive(bus, JOINT)
    options = SessionOptions(period=PERIOD, settle=0.05)
    Session(drive, law(), motion(), limits(), options=options).run()
    elmo.state, elmo.motor_on, elmo.unit_mode = "operational", True, 1
    before = bus.sent
    with pytest.raises(SessionRefusedError):
        Session(drive, law(), motion(), limits(velocity=0.01), options=options).run()
    assert bus.sent == before
    with pytest.raises(SessionRefusedError, match="another program commands the drive"):
        Session(drive, law(), motion(), limits(), options=options).run()
    assert elmo.motor_on
    assert elmo.state == "operational"


@pytest.mark.parametrize("extra", range(4))
def test_the_analog_input_is_asked_anew_in_each_session(extra: int) -> None:
    elmo, _ = devices()
    bus = EmulatedBus(elmo)
    drive = ElmoDrive(bus, JOINT, ElmoOptions(torque=AnalogInput(every=4)))
    for _ in range(3):
        options = SessionOptions(period=PERIOD, settle=0.05 + extra * PERIOD)
        assert Session(drive, law(), motion(), limits(), options=options).run() is not None


@pytest.mark.parametrize("identifier", [0x77F, 0x4FF, 0x0FF])
def test_frames_of_other_kinds_are_not_the_drives(identifier: int) -> None:
    elmo, converter = devices()
    bus = EmulatedBus(elmo, converter)
    extended = can.Message(arbitration_id=identifier, data=bytes(8), is_extended_id=True)
    remote = can.Message(arbitration_id=identifier, is_remote_frame=True, is_extended_id=False)
    for when in np.arange(0.0, 1.6, 0.1):
        for message in (extended, remote):
            bus.at(when, partial(bus.transmit, message))
    assert session(bus).run() is not None


def test_a_drives_lower_limit_counts_as_saturation() -> None:
    elmo, converter = devices()
    elmo.current_limits[0] = 1.0  # 20 N·m
    with pytest.raises(SessionStoppedError) as found:
        session(EmulatedBus(elmo, converter), limits=limits(torque_difference=1e3)).run()
    assert found.value.stop.limit in ("saturated_samples", "tracking_error")


def test_what_cannot_be_held_is_refused() -> None:
    bus = EmulatedBus(*devices())
    unlimited = SessionLimits(velocity=10.0)
    with pytest.raises(SessionRefusedError, match="no torque limit"):
        session(bus, limits=unlimited).run()
    weak = JOINT.replace(limits=jid.Limits(torque=160.0, current=2.0))
    drive = ElmoDrive(EmulatedBus(*devices()), weak)
    given = SessionLimits.of(weak, torque=160.0)
    with pytest.raises(
        SessionRefusedError, match=r"PL\[1\] is 8 A, but the session allows only 2 A"
    ):
        Session(drive, law(), motion(), given).run()
    slow = SessionOptions(period=0.05)
    with pytest.raises(SessionRefusedError, match="is too long: each cycle sends the heartbeat"):
        Session(
            ElmoDrive(EmulatedBus(*devices()), JOINT), law(), motion(), limits(), options=slow
        ).run()


def test_a_fast_motion_is_not_overlooked_between_the_instants_that_are_checked() -> None:
    within = limits(position=(-1.0, 1.0), velocity=50.0)
    fast = jid.Trajectory.sine(2.0, 1.0, duration=1999.0)
    run = Session(ElmoDrive(EmulatedBus(*devices()), JOINT), law(), fast, within)
    assert any("outside -1.0000 to 1.0000 rad" in reason for reason in run.check())


@pytest.mark.parametrize(
    ("make", "wording"),
    [
        (lambda: ElmoOptions(bitrate=math.inf), "bitrate"),
        (lambda: ElmoOptions(bitrate=math.nan), "bitrate"),
        (lambda: ElmoOptions(execution_delay=-1.0), "execution_delay"),
        (lambda: ElmoOptions(position_offset=math.nan), "position_offset"),
        (lambda: ElmoOptions(cob_reply=0x900), "0x900"),
        (lambda: ElmoOptions(cob_position=0x1C0), "both 0x1C0"),
        (lambda: SensorScaling(span=0.0), "span"),
        (lambda: SyncedConverter(conversions=0), "conversions"),
        (lambda: SyncedConverter(lowest=3.0, highest=0.0), "lowest"),
    ],
)
def test_options_that_cannot_be_are_refused(make: Callable[[], object], wording: str) -> None:
    with pytest.raises(jid.InputError, match=wording):
        make()


def test_the_three_identifiers_are_settings_on_both_sides() -> None:
    from session_bench import joint

    from jointid.hardware.elmo.emulated_converter import EmulatedConverter
    from jointid.hardware.elmo.emulated_drive import ElmoSettings

    elmo = EmulatedElmo(joint(), ElmoSettings(cob_command=0x3F0, cob_reply=0x2F0))
    bus = EmulatedBus(elmo, EmulatedConverter(elmo))
    wired = ElmoOptions(cob_command=0x3F0, cob_reply=0x2F0, cob_position=0x4F0)
    assert session(bus, drive=wired).run() is not None


@pytest.mark.skipif(not hasattr(signal, "SIGHUP"), reason="there is no SIGHUP on this system")
def test_a_terminal_that_closes_stops_the_session() -> None:
    elmo, converter = devices()
    bus = EmulatedBus(elmo, converter)
    bus.at(0.9, lambda: signal.raise_signal(signal.SIGHUP))
    with pytest.raises(SessionStoppedError, match="SIGHUP") as found:
        session(bus).run()
    assert (found.value.stop.limit, found.value.stop.motor_off) == ("user", True)


def test_ctrl_c_in_a_dry_run_is_heard() -> None:
    bus = EmulatedBus(*devices())
    bus.at(0.02, lambda: signal.raise_signal(signal.SIGINT))
    with pytest.raises(KeyboardInterrupt):
        session(bus).run(dry_run=True)


class StubbornDrive(ElmoDrive):
    """Does not switch its motor off."""

    def disable(self) -> Any:
        super().disable()
        raise DriveFaultError("drive_fault", "relay stuck")


def test_a_motor_that_does_not_go_off_after_a_run_is_no_success() -> None:
    bus = EmulatedBus(*devices())
    options = SessionOptions(period=PERIOD, settle=0.05)
    with pytest.raises(
        SessionStoppedError, match=r"relay stuck.*THE DRIVE DID NOT CONFIRM THAT THE MOTOR IS OFF"
    ) as f:
        Session(StubbornDrive(bus, JOINT), law(), motion(), limits(), options=options).run()
    assert f.value.stop.motor_off is False
    assert f.value.recording is not None


def test_without_a_sensor_there_is_no_column_of_it(tmp_path: Path) -> None:
    elmo, _ = devices()
    wired = ElmoOptions(torque=None)
    within = limits(tracking_error=3.0)
    soft = jid.Pd(stiffness=4000.0, damping=300.0)
    path = tmp_path / "run.csv"
    run = session(EmulatedBus(elmo), drive=wired, limits=within, law=soft, output=path).run()
    assert run is not None
    assert run.sensor is None
    assert jid.load(path).sensor is None
    assert jid.hardware.replay(path.with_suffix(".log"), JOINT, recording=run).sensor is None


@pytest.mark.parametrize(
    ("name", "returned", "wording"),
    [
        ("problems", "not homed", r"problems\(\) is 'not homed': a list of sentences"),
        ("command", None, r"command\(\) returned None; the accepted torque"),
    ],
)
def test_a_wrong_return_value_of_a_drive_is_reported(
    name: str, returned: Any, wording: str
) -> None:
    drive = ElmoDrive(EmulatedBus(*devices()), JOINT)
    setattr(drive, name, lambda *_: returned)
    options = SessionOptions(period=PERIOD, settle=0.05)
    with pytest.raises((jid.InputError, SessionStoppedError), match=wording):
        Session(drive, law(), motion(), limits(), options=options).run()


def test_a_trajectory_of_a_moment_is_refused() -> None:
    with pytest.raises(SessionRefusedError, match="at least 8 periods"):
        session(EmulatedBus(*devices()), 5.0 * PERIOD).run()
