"""Second step: which column holds which signal, in which unit, and the joint's known facts."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

from nicegui import ui

from jointid import _core
from jointid.app.desk import COUNTS, Desk
from jointid.joint.model import AUTO
from jointid.recording.plausibility import range_remark
from jointid.recording.signals import dimensions, shown_unit
from jointid.recording.units import UNITS, unit_names

_SIGNALS = ("time", "position", "velocity", "torque", "motor_torque", "current", "sensor")
_NONE = -1
_FACTS = (
    ("gear_ratio", "gear ratio"),
    ("torque_constant", "torque constant [N·m/A]"),
    ("inertia", "drive's inertia at the output [kg·m²]"),
)
_LABELS = {
    "auto": "chosen by the data",
    "coulomb_viscous": "Coulomb and viscous",
    "stribeck": "Stribeck",
    "stribeck_general": "Stribeck, general",
}
_MODELS = {name: _LABELS.get(name, name) for name in (AUTO, *_core.model_names())}


def columns_step(desk: Desk) -> dict[str, Callable[[], object]]:
    """Draw the step; returns what draws its parts anew."""
    ui.label("2  Columns and units").classes("text-lg")
    ranges: dict[str, ui.label] = {}

    @ui.refreshable
    def draw() -> None:
        if desk.call is None or desk.looked is None:
            ui.label("Load a log first.")
            return
        headers = {_NONE: "—"} | {k: each.header for k, each in enumerate(desk.looked.columns)}
        with ui.grid(
            columns="max-content minmax(9rem, 1fr) max-content minmax(12rem, 2fr)"
        ).classes("items-center w-full"):
            for signal in _SIGNALS:
                ranges[signal] = _row(desk, signal, headers)
        _facts(desk)

    def show_ranges() -> None:
        for signal, label in ranges.items():
            label.set_text(_seen(desk, signal))

    @ui.refreshable
    def remarks() -> None:
        if desk.problem:
            ui.label(desk.problem).classes("text-negative").props("id=problem")
        for remark in desk.remarks:
            ui.label(remark)

    draw()
    remarks()
    return {"columns": draw.refresh, "ranges": show_ranges, "remarks": remarks.refresh}


def _row(desk: Desk, signal: str, headers: dict[int, str]) -> ui.label:
    column = desk.looked_at(signal)
    number = desk.column_of(signal)
    ui.label(signal).classes("whitespace-nowrap")

    async def assigned(event: Any) -> None:
        desk.assign(signal, None if event.value == _NONE else event.value)
        await desk.read()

    ui.select(headers, value=_NONE if number is None else number, on_change=assigned).props(
        f"dense id=column-{signal}"
    )
    units = _units(signal)
    unit = desk.unit_of(signal)

    async def measured(event: Any) -> None:
        desk.measure(signal, event.value)
        await desk.read()

    with ui.row().classes("items-center no-wrap"):
        ui.select(units, value=unit if unit in units else "", on_change=measured).props(
            f"dense id=unit-{signal}"
        ).set_enabled(column is not None)
        if unit == COUNTS:
            _counts(desk)
    return ui.label(_seen(desk, signal)).props(f"id=seen-{signal}").classes("text-caption")


def _counts(desk: Desk) -> None:
    ui.number(
        "counts per revolution of the joint",
        value=desk.counts_per_turn,
        min=1,
        on_change=lambda event: desk.count(event.value),
    ).props("dense autofocus for=counts").on("blur", desk.read).on("keydown.enter", desk.read)


def _units(signal: str) -> dict[str, str]:
    known = unit_names(dimensions(signal, None))
    counted = {COUNTS: "counts"} if signal in ("position", "velocity") else {}
    return (
        {"": f"{shown_unit(signal, 'revolute')}, not stated"}
        | {name: name for name in known}
        | counted
    )


def _seen(desk: Desk, signal: str) -> str:
    """The range in SI, and what is odd about it."""
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
    remark = range_remark(signal, low, high, kind) if signal != "sensor" else ""
    name = shown_unit(signal, kind) if signal != "sensor" else "of the reading"
    shown = f"{low:.4g} … {high:.4g} {name}"
    return f"{shown}; {remark}" if remark else shown


def _facts(desk: Desk) -> None:
    with ui.row().classes("items-center"):
        for name, label in _FACTS:
            ui.number(
                label,
                value=desk.facts.get(name),
                on_change=lambda event, name=name: desk.facts.__setitem__(name, event.value),
            ).props(f"dense for=fact-{name}")
        ui.select(
            _MODELS,
            value=desk.model,
            label="friction model",
            on_change=lambda event: desk.choose(event.value),
        ).props("dense id=model")
