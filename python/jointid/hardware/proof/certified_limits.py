"""What a certificate was given under: limits that may only become narrower, the joint's zero, the serial number."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

from jointid.hardware.bench.bench import Bench, drive_type

_LARGEST = ("torque", "velocity", "current")
_SAME = 1e-9  # of a limit, which is written with all its digits
_MOVED = 1e-6  # [rad] of the joint's zero: less is rounding
NO_SERIAL = "serial_number"
"""Code of `UNCHECKED`: any drive of this type and firmware passes for the one that was certified."""


def limits_facts(bench: Bench) -> dict[str, Any]:
    """Return the session's limits, the joint's largest current, and where the encoder's zero is.

    Parameters
    ----------
    bench : Bench

    Returns
    -------
    dict
        "position" (two) [rad], "velocity" [rad/s], "torque" [N·m], "current" [A], "position_offset" [rad]; None
        or infinite: there is none.
    """
    limits = bench.limits
    options = drive_type(bench.drive_type).metadata(bench.drive)
    return {
        "position": list(limits.position),
        "velocity": limits.velocity,
        "torque": limits.torque,
        "current": bench.joint.limits.current,
        "position_offset": options.get("position_offset"),
    }


def widened(before: Mapping[str, Any], bench: Bench) -> list[str]:
    """Return which limits are wider than they were; narrower ones are no objection.

    Parameters
    ----------
    before : mapping
        The certificate's. A limit that is not there was infinite.
    bench : Bench
    """
    after, found = limits_facts(bench), []
    for name in _LARGEST:
        was, now = _largest(before.get(name)), _largest(after[name])
        if now > was * (1.0 + _SAME):
            found.append(f"the {name} limit was {was:g} and is {now:g}, which is wider")
    window = before.get("position")
    if isinstance(window, list) and len(window) == 2:
        (low, high), (lowest, highest) = window, after["position"]
        if lowest < low - _SAME or highest > high + _SAME:
            found.append(
                f"the position window was {low:.4g} to {high:.4g} rad and is {lowest:.4g} to {highest:.4g} rad, "
                "which is wider"
            )
    return found


def notes(
    before: Mapping[str, Any], bench: Bench, identity: Mapping[str, Any] | None = None
) -> list[str]:
    """Return what the certificate cannot tell, and a user should look at; it holds nevertheless.

    Parameters
    ----------
    before : mapping
        The certificate's limits.
    bench : Bench
    identity : mapping, optional
        What the drive that is connected reports. Default: not looked at.
    """
    found = []
    was, now = before.get("position_offset"), limits_facts(bench)["position_offset"]
    # Homing changes it each time that the encoder loses its zero: no objection, or it would be void daily.
    if was is not None and now is not None and abs(now - was) > _MOVED:
        found.append(
            f"position_offset was {was:g} and is {now:g} rad: the position window has moved by {abs(now - was):.4g} "
            "rad, unless the joint was homed again"
        )
    if identity is not None and not has_serial(identity):
        found.append(
            "the drive reports no serial number, so another drive of its type looks the same"
        )
    return found


def has_serial(identity: Mapping[str, Any]) -> bool:
    """Whether a drive says which one of its type it is; some protocols have 0 for "none"."""
    return str(identity.get("serial") or "").strip() not in ("", "0")


def _largest(value: Any) -> float:
    return math.inf if value is None else float(value)
