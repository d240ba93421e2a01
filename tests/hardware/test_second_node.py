"""Two nodes with the number of one drive: the session does not start, and says so."""

from __future__ import annotations

from collections.abc import Callable

import can
import pytest
from session_bench import devices, joint, session

from jointid.hardware import EmulatedBus, SessionRefusedError
from jointid.hardware.can import canopen_frames as canopen
from jointid.hardware.elmo import EmulatedElmo
from jointid.hardware.emulated.device import Device, DeviceBus

NODE = 127


class Stranger:
    """A node of another make: it boots later than the drive, or answers without a boot-up message."""

    def __init__(self, *, boots: bool) -> None:
        self._boots = boots

    def attach(self, bus: DeviceBus) -> None:
        self._bus = bus

    def receive(self, message: can.Message) -> None:
        reset = canopen.network(canopen.RESET_COMMUNICATION, NODE)
        if self._boots and (message.arbitration_id, bytes(message.data)) == (canopen.NMT, reset):
            self._bus.at(self._bus.now() + 0.01, lambda: self._send(0x700 + NODE, b"\x00"))
        elif not self._boots and message.arbitration_id == 0x600 + NODE:
            answer = canopen.sdo_abort(canopen.SdoRequest.of(bytes(message.data)), 0x06020000)
            self._bus.at(self._bus.now() + 1e-3, lambda: self._send(0x580 + NODE, answer))

    def _send(self, identifier: int, payload: bytes) -> None:
        self._bus.transmit(
            can.Message(arbitration_id=identifier, data=payload, is_extended_id=False)
        )


@pytest.mark.parametrize(
    ("second", "seen"),
    [
        (lambda: EmulatedElmo(joint(seed=2)), "the boot-up message came twice"),
        (lambda: Stranger(boots=True), "the boot-up message came twice"),
        (lambda: Stranger(boots=False), "an object was answered twice"),
    ],
)
def test_two_nodes_of_one_number_are_named(second: Callable[[], Device], seen: str) -> None:
    first = devices(seed=1)
    with (
        EmulatedBus(*first, second()) as bus,
        pytest.raises(SessionRefusedError, match=f"two drives answer as node {NODE}: {seen}"),
    ):
        session(bus).run()
    assert not first[0].motor_on
