"""A joint's display in notebooks: its known facts, and the table of its parameters."""

from __future__ import annotations

from jointid.base.html import Html, element, table
from jointid.joint.joint_fields import JointFields
from jointid.joint.parameters import Parameter


def html_facts(joint: JointFields) -> Html:
    """Return the known facts, then the known parameters."""
    stated: list[tuple[str, object]] = [
        ("kind", joint.kind),
        ("model", str(joint.model) or "not stated"),
        ("torque sensor", "yes" if joint.sensor else "no"),
        ("torque between samples", joint.torque_hold),
        *((name.replace("_", " "), value) for name, value in joint.facts.items()),
        *((f"tolerance of the {name}", value) for name, value in joint.tolerances.given.items()),
    ]
    rows: list[list[Html | str]] = [
        [name, f"{value:.6g}" if isinstance(value, float) else str(value)]
        for name, value in stated
        if value is not None
    ]
    parts = [element("b", f"jointid joint{' — ' if joint.name else ''}{joint.name}"), table(rows)]
    if joint.parameters:
        body = [_row(p) for p in joint.parameters.values()]
        parts.append(table(body, head=["parameter", "value", "lowest", "highest", ""]))
    return element("div", *parts)


def _row(p: Parameter) -> list[Html | str]:
    values = (p.value, p.min, p.max)
    shown = ("–" if value is None else f"{value:.6g}" for value in values)
    return [element("th", p.name), *shown, "fixed" if p.vary is False else ""]
