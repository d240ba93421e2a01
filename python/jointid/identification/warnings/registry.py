"""List of all checks. A new check is a file in this folder and a line here."""

from __future__ import annotations

from importlib import import_module

from jointid.identification.warnings.check import Check, FindingType

# Order of findings with the same severity: a fault of a signal affects the checks below it. Each file has a CHECK.
FILES = (
    "stopped",
    "velocity",
    "delays",
    "long_shift",
    "speed",
    "drive_size",
    "constant",
    "clipped",
    "spikes",
    "repeated",
    "time_jitter",
    "torque_balance",
    "no_friction",
    "noisy_velocity",
    "noisy_signal",
    "load_scale",
    "model_too_rich",
    "at_bound",
    "undetermined",
    "undivided_offset",
    "ripple",
    "causes",
    "poor_fit",
    "structured_residual",
    "standing",
    "few_windows",
    "gaps",
    "late",
    "assumed_units",
    "motor_side",
    "torque_side",
    "left_out",
    "mended",
    "message_log",
    "cross_check",  # it does not show the cause, so it is after the checks that do
)


def checks_of(files: tuple[str, ...]) -> tuple[Check, ...]:
    """Return the checks of these files of the folder."""
    return tuple(import_module(f"{__package__}.{file}").CHECK for file in files)


CHECKS = checks_of(FILES)


def finding_types() -> dict[str, FindingType]:
    """Return every type of finding by its code, in the order of the checks."""
    return {each.code: each for check in CHECKS for each in check.types}
