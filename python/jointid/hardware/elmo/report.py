"""Report of an Elmo drive: identity, settings and present state."""

from __future__ import annotations

import math
from collections.abc import Sequence

from jointid.hardware.elmo import registers
from jointid.hardware.elmo.errors import UNIT_MODES, DriveStatus, failure_meaning
from jointid.hardware.elmo.link import ElmoLink
from jointid.hardware.elmo.options import ElmoOptions
from jointid.hardware.elmo.setup import watchdog_objects
from jointid.hardware.session.drive import DriveSample
from jointid.hardware.session.drive_report import DriveReport, Reported


def elmo_report(
    link: ElmoLink,
    options: ElmoOptions,
    *,
    identity: Sequence[Reported],
    settings: Sequence[Reported],
    sample: DriveSample,
    velocity: float,
) -> DriveReport:
    """Return the report of a connected drive whose motor is off; nothing is changed.

    Parameters
    ----------
    link : ElmoLink
    options : ElmoOptions
    identity, settings : sequence of Reported
        Read when the drive was connected.
    sample : DriveSample
        Sample read just before.
    velocity : float
        Joint velocity [rad/s].
    """
    register = link.number("SR")
    status = None if register is None else DriveStatus.of(int(register))
    modes = () if status is None else (_mode(status.unit_mode),)
    serial = next((each.value for each in identity if each.meaning == "serial"), "")
    return DriveReport(
        drive=f"Elmo SimplIQ, node {options.node}, commanded by node {options.master_node}",
        identity=tuple(identity),
        settings=(*modes, _counts(link, options), *settings),
        watchdog=watchdog_objects(link, options),
        serial=str(serial),
        motor_on=None if status is None else status.motor_on,
        trouble=_trouble(link, status),
        position=sample.position,
        velocity=velocity,
        reading=sample.reading if options.torque is not None else math.nan,
        current=sample.current,
        supply=_number(registers.supply(link)),
        temperature=_number(registers.temperature(link)),
    )


def _mode(unit_mode: int) -> Reported:
    modes = {number: f"{number} ({name})" for number, name in UNIT_MODES.items()}
    return Reported(
        name="UM", meaning="mode", value=modes.get(unit_mode, str(unit_mode)), expected=modes[1]
    )


def _counts(link: ElmoLink, options: ElmoOptions) -> Reported:
    """Return the drive's encoder counts per revolution. A wrong value in the joint file acts as a wrong gear ratio."""
    value = registers.counts_per_turn(link)
    return Reported(
        name="CA[18]",
        meaning="encoder counts per motor revolution",
        value=value,
        unit="count",
        expected=None if value is None else float(options.counts_per_turn),
    )


def _trouble(link: ElmoLink, status: DriveStatus | None) -> str:
    if status is None:
        return "the drive does not report its status (SR)"
    found = [status.problem]
    if status.failure:
        meaning = failure_meaning(int(link.number("MF") or 0))
        found.append(f"the drive has shut its motor down earlier: {meaning or 'MF is 0'}")
    return "; ".join(text for text in found if text)


def _number(value: float | None) -> float:
    return math.nan if value is None else float(value)
