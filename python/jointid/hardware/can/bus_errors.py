"""Meaning of a CAN controller's error frames (Linux's classes, which python-can passes on)."""

from __future__ import annotations

_LOST_ARBITRATION = 0x02  # a frame of higher priority went first: no error on a shared bus
_CLASSES = {
    0x01: "transmission timed out",
    0x04: "controller in trouble (too many errors, or overflow)",
    0x08: "protocol violated: bit rate or wiring",
    0x10: "transceiver fault: wiring",
    0x20: "no node acknowledges: is the drive on, and the bus terminated?",
    0x40: "bus-off: too many errors, the controller has left the bus",
    0x80: "bus error",
    0x100: "the controller was restarted after a bus-off",
}


def error_frame_meaning(classes: int) -> str:
    """Return the meaning of an error frame's classes; empty when it is no reason to stop.

    Parameters
    ----------
    classes : int
        The identifier of the error frame.
    """
    if classes & 0x1FF == _LOST_ARBITRATION:
        return ""
    meanings = [text for bit, text in _CLASSES.items() if classes & bit]
    return ", ".join(meanings) or f"of an unknown class 0x{classes:X}"
