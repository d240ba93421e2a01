"""Reasons in an Elmo drive not to switch its motor on."""

from __future__ import annotations

import math

from jointid.hardware.elmo.codec import Command
from jointid.hardware.elmo.errors import DriveStatus, failure_meaning
from jointid.hardware.elmo.link import ElmoLink
from jointid.hardware.elmo.options import ElmoOptions

IN_USE = "the motor is already on: another program commands the drive; switch the motor off in that program"


def reasons_not_to_start(
    link: ElmoLink,
    options: ElmoOptions,
    *,
    peak: float,
    allowed_current: float | None,
    allowed_torque: float,
    per_ampere: float,
) -> list[str]:
    """Return the reasons, in sentences; an empty list when there are none.

    Parameters
    ----------
    link : ElmoLink
    options : ElmoOptions
    peak : float
        The drive's peak current PL[1] [A].
    allowed_current : float, optional
        The joint's limit [A].
    allowed_torque : float
        The session's limit, at the output [N·m].
    per_ampere : float
        Joint torque per current [N·m/A].
    """
    reasons = []
    if not math.isfinite(allowed_torque):
        reasons.append(
            "the session has no torque limit; give torque [N·m] or current [A] in [limits], or torque [N·m] in "
            "[session.limits] of the joint file"
        )
    if not peak > 0.0:
        reasons.append(f"the drive's peak current PL[1] is {peak:g} A; more than 0 is expected")
    allowed = allowed_torque / abs(per_ampere)
    if allowed_current is not None:
        allowed = min(allowed, allowed_current)
    if peak > allowed * (1.0 + 1e-6):
        reasons.append(
            f"the drive's peak current PL[1] is {peak:g} A, but the session allows only {allowed:.4g} A; lower "
            "PL[1], or raise the session's torque limit or the joint's current limit"
        )
    status = DriveStatus.of(int(link.ask(Command(letters="SR")).value))
    if status.problem:
        reasons.append(f"the drive reports {status.problem}")
    if status.failure and not options.acknowledge:
        meaning = failure_meaning(int(link.ask(Command(letters="MF")).value))
        reasons.append(
            f"the drive has shut its motor down earlier ({meaning or 'MF is 0'}); remove the cause, then "
            "start the session once with acknowledge = true under [session.drive] of the joint file; "
            "delete this line after the session"
        )
    if status.unit_mode != 1:
        reasons.append(f"the drive is in unit mode {status.unit_mode}, not in torque mode (UM=1)")
    if status.motor_on:
        reasons.append(IN_USE)
    return reasons
