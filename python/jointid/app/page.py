"""The page: one column of steps, each drawn from the desk's state."""

from __future__ import annotations

from collections.abc import Callable

from nicegui import ui

from jointid.app.columns import columns_step
from jointid.app.desk import Desk
from jointid.app.results import result_step
from jointid.app.signals import signals_step
from jointid.base.errors import InputError
from jointid.report.style import STYLE


def build(largest: int) -> None:
    """Build the page of one browser tab.

    Parameters
    ----------
    largest : int
        Bytes of an upload.
    """
    parts: dict[str, Callable[[], object]] = {}
    client = ui.context.client

    def changed(part: str) -> None:
        if part in parts and not client.is_deleted:
            with client:
                parts[part]()

    def said(text: str, wrong: bool) -> None:
        if not client.is_deleted:
            with client:
                ui.notify(text, type="negative" if wrong else "info", multi_line=True, timeout=8000)

    desk = Desk(changed, said)
    client.on_delete(desk.close)
    ui.dark_mode(None)
    ui.add_css(f"@layer components {{ {STYLE} }} .step {{ width: 100%; max-width: 62rem; }}")
    with ui.column().classes("w-full items-center"):
        ui.label("jointid").classes("text-2xl step")
        with ui.card().classes("step overflow-x-auto"):
            _upload(desk, largest)
        with ui.card().classes("step overflow-x-auto"):
            parts |= columns_step(desk)
        with ui.card().classes("step overflow-x-auto"):
            parts["signals"] = signals_step(desk)
        with ui.card().classes("step overflow-x-auto"):
            parts["progress"] = _actions(desk)
            parts["result"] = result_step(desk)


def _upload(desk: Desk, largest: int) -> None:
    ui.label("1  Log").classes("text-lg")
    ui.label(
        "A text log (.csv, .csv.gz, .txt, .tsv, .log, .dat), .npz, .mat, .parquet, .h5, .mcap, .bag or .json. "
        "It stays on this machine."
    )

    async def received(event: object) -> None:
        file = event.file  # type: ignore[attr-defined]
        try:
            place = desk.place_for(file.name)
        except InputError as error:
            ui.notify(str(error), type="negative", multi_line=True)
            return
        await file.save(place)
        await desk.open(place, file.name)

    ui.upload(
        label="drop a log here, or choose one",
        auto_upload=True,
        max_file_size=largest,
        on_upload=received,
        on_rejected=lambda: ui.notify(
            f"one file of at most {largest / 1e6:.0f} MB is accepted", type="negative"
        ),
    ).classes("w-full").props("flat bordered")


def _actions(desk: Desk) -> Callable[[], object]:
    ui.label("4  Identify").classes("text-lg")
    with ui.row().classes("items-center"):
        identify = (
            ui.button("Identify", on_click=desk.identify).mark("identify").props("id=identify")
        )
        compare = ui.button("Compare models", on_click=desk.compare).props("outline id=compare")
        cancel = ui.button("Cancel", on_click=desk.cancel).props("flat id=cancel")
    bar = ui.linear_progress(0.0, show_value=False)
    step = ui.label()

    def draw() -> None:
        busy = bool(desk.busy)
        identify.set_enabled(desk.call is not None and not busy)
        compare.set_enabled(desk.call is not None and not busy)
        cancel.set_visibility(busy)
        bar.set_visibility(busy)
        bar.set_value(desk.share)
        step.set_text(f"{desk.busy} … {desk.step}" if busy else "")

    draw()
    return draw
