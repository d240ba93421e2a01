"""Conditions of a certificate: limits that may only become narrower, the joint's zero, the serial number."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

from jointid.hardware.bench.bench import Bench, drive_type

_LARGEST = ("torque", "velocity", "current")
_SAME = 1e-9  # relative, of a limit, which is written with all its digits
_MOVED = 1e-6  # [rad], smallest change of the joint's zero; less is rounding
NO_SERIAL = "serial_number"
"""Code of `UNCHECKED`: another drive of this type and firmware cannot be distinguished from the certified one."""


def limits_facts(bench: Bench) -> dict[str, Any]:
    """Return the session's limits, the joint's largest current, and the position of the encoder's zero.

    Parameters
    ----------
    bench : Bench

    Returns
    -------
    dict
        "position" (two) [rad], "velocity" [rad/s], "torque" [N·m], "current" [A], "position_offset" [rad]. None
        or infinite means no limit.
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
    """Return the limits that have become wider. Narrower limits are no objection.

    Parameters
    ----------
    before : mapping
        Limits of the certificate. A missing limit was infinite.
    bench : Bench
    """
    after, found = limits_facts(bench), []
    for name in _LARGEST:
        was, now = _largest(before.get(name)), _largest(after[name])
        if now > was * (1.0 + _SAME):
            found.append(f"the {name} limit is wider than certified: it was {was:g} and is {now:g}")
    window = before.get("position")
    if isinstance(window, list) and len(window) == 2:
        (low, high), (lowest, highest) = window, after["position"]
        if lowest < low - _SAME or highest > high + _SAME:
            found.append(
                f"the position window is wider than certified: it was {low:.4g} to {high:.4g} rad and is "
                f"{lowest:.4g} to {highest:.4g} rad"
            )
    return found


def notes(
    before: Mapping[str, Any], bench: Bench, identity: Mapping[str, Any] | None = None
) -> list[str]:
    """Return what the certificate does not prove and a user should check. It stays valid nevertheless.

    Parameters
    ----------
    before : mapping
        The certificate's limits.
    bench : Bench
    identity : mapping, optional
        Identity that the connected drive reports. Default: not compared.
    """
    found = []
    was, now = before.get("position_offset"), limits_facts(bench)["position_offset"]
    # Homing changes the offset each time that the encoder loses its zero. An objection would void it daily.
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
    """Return whether a drive reports its serial number; some protocols use 0 for "none"."""
    return str(identity.get("serial") or "").strip() not in ("", "0")


def _largest(value: Any) -> float:
    return math.inf if value is None else float(value)
