"""Meaning of a CAN controller's error frames, in Linux's classes as python-can passes them on."""

from __future__ import annotations

_LOST_ARBITRATION = 0x02  # a frame of higher priority came first; no error on a shared bus
_CONTROLLER, _ACTIVE_AGAIN = (
    0x04,
    0x40,
)  # details in the second byte: recovered, no errors any more
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
    """Return the meaning of an error frame's classes; empty if it is no reason to stop.

    Parameters
    ----------
    classes : int
        Identifier of the error frame.
    details : bytes
        Bytes of the error frame; the second one is the controller's problem.
    """
    if classes & 0x200:  # the frame contains error counters; this alone is no problem
        classes &= ~0x200
        if not classes & 0x1FF:
            return ""
    if classes & 0x1FF == _LOST_ARBITRATION:
        return ""
    if classes & 0x1FF == _CONTROLLER and details[1:2] == bytes((_ACTIVE_AGAIN,)):
        return ""
    meanings = [text for bit, text in _CLASSES.items() if classes & bit]
    return ", ".join(meanings) or f"of an unknown class 0x{classes:X}"
