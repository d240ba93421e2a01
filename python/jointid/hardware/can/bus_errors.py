"""Meaning of a CAN controller's error frames (Linux's classes, which python-can passes on)."""

from __future__ import annotations

_LOST_ARBITRATION = 0x02  # a frame of higher priority went first: no error on a shared bus
_CONTROLLER, _ACTIVE_AGAIN = (
    0x04,
    0x40,
)  # the second byte has details: recovered, no errors any more
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


def error_frame_meaning(classes: int, details: bytes = b"") -> str:
    """Return the meaning of an error frame's classes; empty when it is no reason to stop.

    Parameters
    ----------
    classes : int
        The identifier of the error frame.
    details : bytes
        Its bytes; the second says what is wrong with the controller.
    """
    if classes & 0x200:  # error counters are in the frame: no trouble by itself
        classes &= ~0x200
        if not classes & 0x1FF:
            return ""
    if classes & 0x1FF == _LOST_ARBITRATION:
        return ""
    if classes & 0x1FF == _CONTROLLER and details[1:2] == bytes((_ACTIVE_AGAIN,)):
        return ""
    meanings = [text for bit, text in _CLASSES.items() if classes & bit]
    return ", ".join(meanings) or f"of an unknown class 0x{classes:X}"
