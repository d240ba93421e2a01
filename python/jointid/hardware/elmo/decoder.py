"""Decoder of an Elmo drive's cyclic frames, for a session and for the replay of its frame log."""

from __future__ import annotations

import math
import struct

from jointid.hardware.elmo.options import ElmoOptions
from jointid.hardware.elmo.torque_source import SyncedConverter
from jointid.joint.joint import Joint


class ElmoDecoder:
    """Decode position, current and torque sensor from frames.

    Parameters
    ----------
    joint : Joint
    options : ElmoOptions
    """

    def __init__(self, joint: Joint, options: ElmoOptions) -> None:
        self._joint, self._options = joint, options
        self.rated_current = math.nan
        self.current = math.nan
        self.position = 0.0
        self.reading = 0.0
        self.fresh = self.clipped = False
        self.readings = 0  # number of readings received
        self.surplus = 0  # answers without a SYNC
        self._positions_due = self._readings_due = 0

    def begin(self) -> None:
        """Start a cycle: a SYNC was sent, and the next answers belong to it."""
        self._positions_due += 1
        self._readings_due += 1
        self.fresh = False

    def forget(self) -> None:
        """Stop waiting for answers to earlier SYNCs."""
        self._positions_due = self._readings_due = 0

    @property
    def complete(self) -> bool:
        """Whether all answers to the last SYNC have arrived."""
        synced = isinstance(self._options.torque, SyncedConverter)
        return self._positions_due == 0 and (self._readings_due == 0 or not synced)

    @property
    def lacking(self) -> str:
        """Missing answer to the last SYNC; empty when it is complete."""
        if self._positions_due:
            return "position"
        return "" if self.complete else "torque sensor's reading"

    def take(self, identifier: int, payload: bytes) -> bool:
        """Read a frame. Return whether it was a cyclic frame."""
        source = self._options.torque
        if identifier == self._options.position_id and len(payload) >= 4:
            self.position = self._options.angle(struct.unpack_from("<i", payload)[0], self._joint)
            self.surplus += not self._positions_due
            self._positions_due = max(0, self._positions_due - 1)
            if len(payload) >= 6:
                share = struct.unpack_from("<h", payload, 4)[0]
                self.current = share / 1000.0 * self.rated_current
            return True
        if isinstance(source, SyncedConverter) and identifier == source.identifier:
            if len(payload) >= 4:
                self._readings_due = max(0, self._readings_due - 1)
                self.take_voltage(source.voltage(payload))
            return True
        return False

    def take_voltage(self, voltage: float) -> None:
        """Store the torque sensor's voltage."""
        source = self._options.torque
        if source is None:
            return
        self.reading = source.scaling.reading(voltage, self.position)
        self.clipped = source.clipped(voltage)
        self.fresh = True
        self.readings += 1
