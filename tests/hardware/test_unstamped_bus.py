"""An adapter whose frames bear no stamps: only the program knows when it sent a SYNC, and it may lose the processor."""

from __future__ import annotations

import can
import numpy as np
import pytest
from session_bench import JOINT, devices, law, limits, motion

from jointid.hardware import EmulatedBus
from jointid.hardware.elmo.drive import ElmoDrive
from jointid.hardware.emulated.device import Device
from jointid.hardware.session.session import Session, SessionOptions

PERIOD = 10e-3  # [s]
STALL = 8e-3  # [s]
SYNC = 0x080


class Descheduled(EmulatedBus):
    """Its host loses the processor before every fifth SYNC, or behind it."""

    def __init__(self, *emulated: Device, before: bool) -> None:
        super().__init__(*emulated)
        self._before, self._syncs = before, 0
        self.synced: list[float] = []  # [s], in truth

    def send(self, msg: can.Message, timeout: float | None = None) -> None:
        """Put a frame of the host's on the wire."""
        syncs = msg.arbitration_id == SYNC
        self._syncs += syncs
        stall = STALL if syncs and self._syncs % 5 == 0 else 0.0
        if self._before:
            self.sleep_until(self.now() + stall)
        if syncs:
            self.synced.append(self.now())
        super().send(msg, timeout)
        if not self._before:
            self.sleep_until(self.now() + stall)


@pytest.mark.parametrize("before", [False, True], ids=["behind", "before"])
def test_a_host_without_the_processor_about_a_sync_stops_no_session(before: bool) -> None:
    swing = motion()
    fastest = np.abs(swing.sample(np.linspace(0.0, 1.0, 1001))[1]).max()
    with Descheduled(*devices(period=PERIOD), before=before) as bus:
        drive = ElmoDrive(bus, JOINT, clock=bus)  # a clock of its own: the stamps are not taken
        assert drive.identity()["stamped_frames"] is False
        within = limits(missed_deadlines=10**6, saturated_samples=10**6, velocity=2.5 * fastest)
        soft = law().replace(bandwidth=15.0, robust_term=False)
        options = SessionOptions(period=PERIOD, settle=0.05, answer_timeout=STALL + PERIOD)
        recording = Session(drive, soft, swing, within, options=options).run()
    assert recording is not None
    count = recording.time.size
    assert count == 100
    truth = np.array(bus.synced[-count:])
    wrong = recording.time - truth
    # Of the stalls no more than half is wrong.
    assert np.ptp(wrong) <= 0.5 * STALL + 1e-4
