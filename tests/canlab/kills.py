"""The host killed at random moments while the motor is on, inside the guest."""

from __future__ import annotations

import random
import signal
import time
from collections.abc import Callable

import can

from canlab.outcome import PERIOD
from canlab.stage import Stage, switched_off

KILLS = 50
_COMMAND = 0x37F
_MOTOR_ON = bytes.fromhex("4D4F000001000000")
_COMMANDS = 64  # of a session, from the one that switches the motor on
_PATIENCE = 60.0  # [s] for a command


def killed(number: int) -> Callable[[Stage], None]:
    """Return a scenario: the session is killed after a random command and a random part of a cycle.

    So the moments are spread over switching on, approach and run, and over the cycle.
    """
    chance = random.Random(number)
    commands, wait = chance.randrange(_COMMANDS), chance.uniform(0.0, PERIOD)

    def act(stage: Stage) -> None:
        drive = stage.emulator()
        only = [{"can_id": _COMMAND, "can_mask": 0x7FF, "extended": False}]
        with can.Bus(stage.channel, interface="socketcan", can_filters=only) as bus:
            session = stage.session()
            while bytes(_next(bus).data) != _MOTOR_ON:
                pass
            for _ in range(commands):
                _next(bus)
        time.sleep(wait)
        session.signal(signal.SIGKILL)
        stage.until(lambda: switched_off(drive), "the motor stays on")

    return act


def _next(bus: can.BusABC) -> can.Message:
    message = bus.recv(_PATIENCE)
    if message is None:
        raise TimeoutError("no commands come any more")
    return message
