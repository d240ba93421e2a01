"""Second step: the column and the unit of each signal, and the joint's known facts."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

from nicegui import ui

from jointid import _core
from jointid.app.desk import COUNTS, READ_WITH, Desk
from jointid.app.look import FIELD, focus, heading, note
from jointid.app.wording import FIELDS, signal_text, unit_text
from jointid.joint.model import AUTO
from jointid.recording.plausibility import range_remark
from jointid.recording.signals import dimensions, shown_unit
from jointid.recording.units import UNITS, unit_names

_SIGNALS = ("time", "position", "velocity", "torque", "motor_torque", "current", "sensor")
_NONE = -1
_MOVING = ("position", "velocity")  # they have a side of the gear
_SIDES = {"": "by its header", "joint": "joint", "motor": "motor"}
_FACTS = ("gear_ratio", "torque_constant", "inertia")
_UNITS = {"gear_ratio": "", "torque_constant": " [N·m/A]", "inertia": " [kg·m²]"}
_LABELS = {
    "auto": "chosen by the data",
    "coulomb_viscous": "Coulomb and viscous",
    "stribeck": "Stribeck",
    "stribeck_general": "Stribeck, general",
    "smooth_coulomb_viscous": "Coulomb and viscous, smooth",
}
_MODELS = {name: _LABELS.get(name, name) for name in (AUTO, *_core.model_names())}


def columns_step(desk: Desk) -> dict[str, Callable[[], object]]:
    """Draw the step. Return functions that redraw its parts."""
    heading(2, "2  Columns and units")
    ranges: dict[str, ui.label] = {}

    @ui.refreshable
    def draw() -> None:
        ranges.clear()
        if desk.call is None or desk.looked is None:
            ui.label("Load a log first.").classes("hint")
            return
        headers = {_NONE: "—"} | {k: each.header for k, each in enumerate(desk.looked.columns)}
        held = [signal for signal in _SIGNALS if desk.column_of(signal) is not None]
        for signal in held:
            with ui.element("div").classes("fields signal"):
                _column(desk, signal, headers)
                _measured(desk, signal, ranges)
        with ui.element("div").classes("fields"):
            for signal in _SIGNALS:
                if signal not in held:
                    _column(desk, signal, headers)
        _facts(desk)

    def show_ranges() -> None:
        for signal, label in ranges.items():
            label.set_text(_seen(desk, signal))

    @ui.refreshable
    def remarks() -> None:
        if desk.problem:
            note(desk.problem, "blocking", spoken=True).props("id=problem")
        for remark in desk.remarks:
            ui.label(remark).classes("hint")

    draw()
    remarks()
    return {"columns": draw.refresh, "ranges": show_ranges, "remarks": remarks.refresh}


def _column(desk: Desk, signal: str, headers: dict[int, str]) -> None:
    client, number = ui.context.client, desk.column_of(signal)

    async def assigned(event: Any) -> None:
        desk.assign(signal, None if event.value == _NONE else event.value)
        focus(client, f"column-{signal}")
        await desk.read()

    ui.select(
        headers,
        value=_NONE if number is None else number,
        label=signal_text(signal),
        on_change=assigned,
    ).props(f"{FIELD} for=column-{signal}")


def _measured(desk: Desk, signal: str, ranges: dict[str, ui.label]) -> None:
    """Draw unit, side and range of a signal that has a column."""
    client, units, unit = ui.context.client, _units(signal), desk.unit_of(signal)

    async def measured(event: Any) -> None:
        desk.measure(signal, event.value)
        focus(client, COUNTS if event.value == COUNTS else f"unit-{signal}")
        await desk.read()

    ui.select(
        units,
        value=unit if unit in units else "",
        label=f"unit of {signal_text(signal)}",
        on_change=measured,
    ).props(f"{FIELD} for=unit-{signal}")
    if unit == COUNTS:
        _counts(desk)
    if signal in _MOVING:
        _side(desk, signal)
    ranges[signal] = ui.label(_seen(desk, signal)).props(f"id=seen-{signal}").classes("hint seen")


def _side(desk: Desk, signal: str) -> None:
    client = ui.context.client

    async def placed(event: Any) -> None:
        desk.put_on(signal, event.value)
        focus(client, f"side-{signal}")
        await desk.read()

    ui.select(
        _SIDES, value=desk.side_of(signal), label=f"side of {signal}", on_change=placed
    ).props(f"{FIELD} for=side-{signal}")


def _counts(desk: Desk) -> None:
    ui.number(
        "counts per revolution of the joint",
        value=desk.counts_per_turn,
        min=1,
        on_change=lambda event: desk.count(event.value),
    ).props(f"{FIELD} for={COUNTS}").on("blur", desk.read).on("keydown.enter", desk.read)


def _units(signal: str) -> dict[str, str]:
    known = unit_names(dimensions(signal, None))
    counted = {COUNTS: "counts"} if signal in ("position", "velocity") else {}
    return (
        {"": f"{shown_unit(signal, 'revolute')}, assumed"}
        | {name: unit_text(name) for name in known}
        | counted
    )


def _seen(desk: Desk, signal: str) -> str:
    """Return the range in SI units, and what is unusual about it."""
    column, unit = desk.looked_at(signal), desk.unit_of(signal)
    if column is None or column.low is None or column.high is None:
        return "" if column is None else "no numbers"
    factor = desk.call.load.get("scale", {}).get(signal) if desk.call is not None else None
    if factor is None:
        factor = UNITS[unit].factor if unit in UNITS else 1.0
    low, high = sorted((column.low * factor, column.high * factor))
    kind = "prismatic" if desk.unit_of("position") in unit_names(("length",)) else "revolute"
    if not (math.isfinite(low) and math.isfinite(high)):
        return "no finite numbers"
    at_joint = signal != "sensor" and desk.side_of(signal) != "motor"
    remark = range_remark(signal, low, high, kind) if at_joint else ""
    name = shown_unit(signal, kind) if signal != "sensor" else "of the reading"
    shown = f"{low:.4g} … {high:.4g} {name}"
    return f"{shown}; {remark}" if remark else shown


def _facts(desk: Desk) -> None:
    """Draw the fields for known facts of the joint. A hint marks those that a motor's signals need."""
    heading(3, "Joint and motor")
    hints = {
        "gear_ratio": "motor angle per joint angle; needed for signals of the motor",
        "torque_constant": "of the motor; needed if a current is recorded",
        "inertia": "of the drive alone, if known",
    }
    with ui.element("div").classes("fields facts"):
        for name in _FACTS:
            _number(desk, name, f"{FIELDS[name]}{_UNITS[name]}", hints[name])
        ui.select(
            _MODELS,
            value=desk.model,
            label=FIELDS["model"],
            on_change=lambda event: desk.choose(event.value),
        ).props(f"{FIELD} for=model")
        if desk.column_of("time") is None:
            _number(desk, "sample_period", "time between rows [s]", "for a log without time")


def _number(desk: Desk, name: str, label: str, hint: str) -> None:
    """Draw the field of a known number. When it changes, redo the reading that depends on it."""
    seen = {"value": desk.facts.get(name)}

    async def left() -> None:
        if name in READ_WITH and desk.facts.get(name) != seen["value"]:
            seen["value"] = desk.facts.get(name)
            await desk.read()

    ui.number(
        label,
        value=desk.facts.get(name),
        on_change=lambda event: desk.facts.__setitem__(name, event.value),
    ).props(f'{FIELD} for=fact-{name} hint="{hint}"').on("blur", left)
