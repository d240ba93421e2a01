"""The session's loop abandoned at 50 random moments on the virtual bus: it never runs again, and cleans nothing up."""

from __future__ import annotations

import random
from functools import cache
from pathlib import Path
from typing import Any, NoReturn

import can
import pytest
from session_bench import PERIOD, devices, session

import jointid as jid
from jointid.hardware.elmo.emulated_drive import EmulatedElmo
from jointid.hardware.elmo.options import ElmoOptions
from jointid.hardware.emulated.bus import EmulatedBus

LOOK = 0.5e-3  # [s] between two looks of the drive's watchdog
LENGTH = 1.0  # [s] of the run
MASTER = 0x700 + ElmoOptions().master_node
HEARTBEAT = ElmoOptions().heartbeat


class Gone(BaseException):
    """The program is not there any more: nothing in it catches this."""


class Ear:
    """A device that notes when the master's heartbeat came last."""

    heard = 0.0

    def attach(self, bus: Any) -> None:
        self.bus = bus

    def receive(self, message: can.Message) -> None:
        if message.arbitration_id == MASTER:
            self.heard = self.bus.now()


class AbandonedBus(EmulatedBus):
    """From some moment on the host does nothing: whatever it tries is its end."""

    moment = float("inf")

    def send(self, msg: can.Message, timeout: float | None = None) -> None:
        self.still_there()
        super().send(msg, timeout)

    def recv(self, timeout: float | None = None) -> can.Message | None:
        self.still_there()
        return super().recv(timeout)

    def sleep_until(self, deadline: float) -> None:
        if deadline >= self.moment:
            super().sleep_until(self.moment)
            self.end()
        super().sleep_until(deadline)

    def still_there(self) -> None:
        if self.now() >= self.moment:
            self.end()

    def end(self) -> NoReturn:
        raise Gone


def bench(moment: float) -> tuple[AbandonedBus, EmulatedElmo, Ear]:
    elmo, converter = devices(seed=7)
    ear = Ear()
    bus = AbandonedBus(elmo, converter, ear)
    bus.moment = moment
    return bus, elmo, ear


@cache
def motor_on() -> tuple[float, float]:
    """From when to when the motor is on in a session that nothing ends."""
    bus, elmo, _ = bench(float("inf"))
    with bus:
        session(bus, LENGTH).run()
    (begin, on), (end, off) = elmo.switchings
    assert (on, off) == (True, False)
    return begin, end


@pytest.mark.parametrize("number", range(50))
def test_a_loop_that_is_abandoned(number: int, tmp_path: Path) -> None:
    begin, end = motor_on()
    moment = random.Random(number).uniform(begin, end - 2 * PERIOD)
    bus, elmo, ear = bench(moment)
    path = tmp_path / "run.csv"
    with bus:
        with pytest.raises(Gone):
            session(bus, LENGTH, output=path).run()
        assert elmo.motor_on  # nobody has switched it off
        EmulatedBus.sleep_until(bus, moment + 2.0 * HEARTBEAT)
    (_, on), (when, off) = elmo.switchings
    assert (on, off) == (True, False)
    assert when - ear.heard <= HEARTBEAT + LOOK
    assert elmo.current == 0.0
    assert elmo.failure != 0
    if path.read_text().count("\n") >= 11:  # two lines of header, the run's begin, eight rows
        assert jid.load(path).metadata["truncated"] is True
