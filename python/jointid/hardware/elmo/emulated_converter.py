"""An emulated analog-to-digital node that converts the torque sensor's voltage at each SYNC."""

from __future__ import annotations

import math
import struct
from typing import TYPE_CHECKING

import can

from jointid.hardware.can.canopen_frames import SYNC
from jointid.hardware.elmo.torque_source import SensorScaling

if TYPE_CHECKING:
    from jointid.hardware.elmo.emulated_drive import EmulatedElmo
    from jointid.hardware.emulated.device import DeviceBus


class EmulatedConverter:
    """Send the sum of the conversions as a 32-bit integer at each SYNC.

    Parameters
    ----------
    drive : EmulatedElmo
        The drive that moves the joint with the sensor.
    scaling : SensorScaling
        Relation between voltage and reading.
    identifier : int
        COB-ID of its frame.
    bits, lowest, highest : int, float, float
        Resolution of the converter, and its range [V].
    conversions : int
        Number of conversions in one frame's sum.
    """

    def __init__(
        self,
        drive: EmulatedElmo,
        scaling: SensorScaling | None = None,
        *,
        identifier: int = 0x1C0,
        bits: int = 12,
        lowest: float = 0.0,
        highest: float = 3.0,
        conversions: int = 128,
    ) -> None:
        self._drive = drive
        self._scaling = scaling if scaling is not None else SensorScaling()
        self._identifier = identifier
        self._levels = 2**bits
        self._lowest, self._highest = lowest, highest
        self._conversions = conversions
        self._bus: DeviceBus | None = None
        self.stuck: bytes | None = None

    def attach(self, bus: DeviceBus) -> None:
        """Remember the bus."""
        self._bus = bus

    def receive(self, message: can.Message) -> None:
        """Convert and send if the frame is a SYNC."""
        if message.arbitration_id != SYNC or self._bus is None:
            return
        self._drive.advance()
        joint = self._drive.joint
        reading = joint.observe().reading
        voltage = self._scaling.voltage(reading, joint.position)
        payload = self.stuck if self.stuck is not None else self._converted(voltage)
        self._bus.transmit(
            can.Message(arbitration_id=self._identifier, data=payload, is_extended_id=False)
        )

    def _converted(self, voltage: float) -> bytes:
        """Return the sum of the conversions. They are dithered evenly over a step, as noise does in a real signal."""
        share = (voltage - self._lowest) / (self._highest - self._lowest) * self._levels
        total = math.floor(share * self._conversions)
        highest = (self._levels - 1) * self._conversions
        return struct.pack("<i", max(0, min(highest, total)))
