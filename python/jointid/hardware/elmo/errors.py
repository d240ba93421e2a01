"""Meaning of an Elmo SimplIQ drive's numbers: error codes, status, failures, emergencies."""

from __future__ import annotations

from dataclasses import dataclass

# EC: reason for a refused command (SimplIQ Command Reference, EC).
ERROR_CODES = {
    2: "bad command",
    3: "bad index",
    5: "the interpreter does not know the command",
    7: "the mode cannot be started: bad initialisation data",
    9: "a CAN message was lost",
    10: "the command cannot be used by a PDO",
    12: "the command is not available in this unit mode",
    15: "the CAN life time is exceeded",
    18: "empty assignment",
    19: "bad format",
    21: "operand out of range",
    22: "division by zero",
    23: "cannot be assigned",
    24: "bad operator",
    25: "the command is not allowed while the motor moves",
    26: "the command is not available in this motion mode",
    28: "out of limit",
    41: "not supported",
    43: "the CAN state machine is in fault",
    48: "the motor could not start; the reason is in CD",
    51: "an inhibit or abort input is active",
    54: "bad data base",
    56: "the command is not available in this product grade",
    57: "the motor must be off",
    58: "the motor must be on",
    60: "bad unit mode",
    61: "the data base was reset",
    65: "disabled by the software",
    66: "the drive is not ready",
    71: "homing is busy",
    72: "the modulo must be even",
    77: "buffer full",
    90: "the CAN state machine is not ready",
    92: "the PDO is not configured",
    93: "wrong value for initiation",
    99: "auxiliary sensor",
    121: "the analog sensor is not ready",
    127: "modulo range",
    168: "the motor turns too fast to be started",
}

# MF: reason for a motor shutdown. Bits 12 to 15 are one field.
_FAILURES = {
    0x1: "fault of the resolver or analog Hall sensor",
    0x4: "feedback lost",
    0x8: "peak current exceeded",
    0x10: "inhibited by an input",
    0x40: "two Hall sensors changed at once",
    0x80: "speed tracking error",
    0x100: "position tracking error",
    0x200: "inconsistent data base",
    0x400: "electronic cam",
    0x800: "heartbeat lost",
    0x10000: "electrical zero not found",
    0x20000: "speed limit exceeded",
    0x40000: "stack overflow",
    0x80000: "processor exception",
    0x200000: "motor stuck",
    0x400000: "position limit exceeded",
    0x20000000: "the motor cannot start",
}
_DRIVE_FAULT, _DRIVE_FAULTS = (
    0x1000,
    {
        0x2000: "under-voltage",
        0x4000: "over-voltage",
        0xA000: "short circuit",
        0xC000: "over-temperature",
    },
)

# Emergency error codes (CiA 301 and Elmo's own).
_EMERGENCIES = {
    0x2340: "short circuit",
    0x3120: "under-voltage",
    0x3310: "over-voltage",
    0x4310: "over-temperature",
    0x5441: "stopped by a switch",
    0x6180: "processor exception",
    0x6200: "user program aborted",
    0x6300: "the object of an RPDO failed",
    0x7121: "motor stuck",
    0x7300: "feedback failure",
    0x7380: "feedback failure",
    0x8110: "a CAN message was lost",
    0x8130: "heartbeat lost",
    0x8200: "bad network command",
    0x8210: "RPDO not configured",
    0x8311: "peak current exceeded",
    0x8480: "speed tracking error",
    0x8481: "speed limit exceeded",
    0x8611: "position tracking error",
    0x8680: "position limit exceeded",
    0xFF10: "the motor cannot start",
    0xFF20: "safety switch",
}

UNIT_MODES = {1: "torque", 2: "speed", 3: "micro-stepper", 4: "dual-loop position", 5: "position"}


def error_meaning(code: int) -> str:
    """Return the meaning of an EC number."""
    return ERROR_CODES.get(code, "not listed")


def failure_meaning(failure: int) -> str:
    """Return the meaning of all bits of the MF register; empty when it is 0."""
    meanings = [text for bit, text in _FAILURES.items() if failure & bit]
    if failure & _DRIVE_FAULT:
        meanings.append(_DRIVE_FAULTS.get(failure & 0xE000, "drive fault"))
    known = sum(_FAILURES) | _DRIVE_FAULT | 0xE000
    if failure & ~known:
        meanings.append(f"unknown bits 0x{failure & ~known:X}")
    return ", ".join(meanings)


@dataclass(frozen=True, slots=True, kw_only=True)
class DriveStatus:
    """The status register SR, decoded.

    Attributes
    ----------
    problem : str
        Problem of the power stage; empty without one.
    motor_on : bool
    failure : bool
        The motor was shut down: read MF.
    unit_mode : int
    current_limited : bool
        The current is limited to the continuous limit.
    """

    problem: str
    motor_on: bool
    failure: bool
    unit_mode: int
    current_limited: bool

    @classmethod
    def of(cls, register: int) -> DriveStatus:
        """Decode the value of SR."""
        problems = {
            1: "under-voltage",
            2: "over-voltage",
            5: "short circuit",
            6: "over-temperature",
        }
        detail = (register >> 1) & 0x7
        return cls(
            problem=problems.get(detail, "drive problem") if register & 0x1 else "",
            motor_on=bool(register & 0x10),
            failure=bool(register & 0x40),
            unit_mode=(register >> 7) & 0x7,
            current_limited=bool(register & 0x2000),
        )


@dataclass(frozen=True, slots=True, kw_only=True)
class Emergency:
    """An emergency message.

    Attributes
    ----------
    code : int
        Code of CiA 301 or of the manufacturer; 0: the error is gone.
    register : int
        Error register 1001h.
    elmo_code : int
        EC, if an object failed.
    meaning : str
    """

    code: int
    register: int
    elmo_code: int
    meaning: str

    @classmethod
    def of(cls, payload: bytes) -> Emergency | None:
        """Decode the bytes of a message. Return None if there are too few."""
        if len(payload) < 4:
            return None
        code = int.from_bytes(payload[:2], "little")
        meaning = _EMERGENCIES.get(code, f"emergency 0x{code:04X}") if code else "error reset"
        if code == 0x6300:
            meaning = f"{meaning}: {error_meaning(payload[3])} (EC {payload[3]})"
        return cls(code=code, register=payload[2], elmo_code=payload[3], meaning=meaning)
