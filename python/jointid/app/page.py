"""The page: one column of steps, each drawn from the desk's state."""

from __future__ import annotations

from collections.abc import Callable

from nicegui import ui

from jointid.app.call import Call
from jointid.app.columns import columns_step
from jointid.app.desk import Desk
from jointid.app.look import dress, heading, note
from jointid.app.results import result_step
from jointid.app.signals import signals_step
from jointid.app.wording import worded
from jointid.base.errors import InputError

# A redrawn button has lost the keyboard focus.
_KEEP_FOCUS = """
setTimeout(() => { if (document.activeElement === document.body)
  document.getElementById("identify")?.focus({preventScroll: true}) }, 400)
"""
_TICK = 0.5  # [s] between two updates of the progress


def build(largest: int, example: Call) -> None:
    """Build the page of one browser tab.

    Parameters
    ----------
    largest : int
        Largest number of bytes of an upload.
    example : Call
        The call that "Try an example" runs.
    """
    parts: dict[str, Callable[[], object]] = {}
    client = ui.context.client

    def changed(part: str) -> None:
        if part in parts and not client.is_deleted:
            with client:
                parts[part]()

    desk = Desk(changed)
    client.on_delete(desk.close)
    dress()
    with ui.element("div").classes("w-full").style("max-width: 62rem"):
        heading(1, "jointid")
        ui.label("The friction of a robot joint from one ordinary log.").classes("hint")
    with ui.card().classes("step"):
        _upload(desk, largest, example)
    with ui.card().classes("step"):
        parts |= columns_step(desk)
    with ui.card().classes("step"):
        parts["signals"] = signals_step(desk)
    with ui.card().classes("step"):
        parts["progress"] = _actions(desk)
        parts["result"] = result_step(desk)


def _upload(desk: Desk, largest: int, example: Call) -> None:
    heading(2, "1  Log")

    @ui.refreshable
    def refusal(text: str = "") -> None:
        if text:
            note(text, "blocking", spoken=True).props("id=refusal")

    async def received(event: object) -> None:
        file = event.file  # type: ignore[attr-defined]
        upload.reset()
        try:
            place = desk.place_for(file.name)
        except InputError as error:
            refusal.refresh(worded(error))
            return
        refusal.refresh("")
        await file.save(place)
        await desk.open(place, file.name)

    async def tried() -> None:
        refusal.refresh("")
        await desk.try_example(example)

    upload = ui.upload(
        auto_upload=True,
        max_file_size=largest,
        on_upload=received,
        on_rejected=lambda: refusal.refresh(
            f"one file of at most {largest / 1e6:.0f} MB is accepted"
        ),
    ).props("flat")
    with upload.add_slot("header"), ui.element("div").classes("buttons"):
        # A click on the hidden input opens the browser's dialogue. The keyboard reaches the button.
        with ui.element("div").style("display: none"):
            ui.element("q-uploader-add-trigger")
        ui.button("Choose a log").props("id=choose").on(
            "click",
            js_handler="(event) => event.currentTarget.closest('.q-uploader').querySelector('input').click()",
        )
        ui.label("or drop it here")
        ui.button("Try an example", on_click=tried).props("outline id=example")
    ui.label(
        "A text log (.csv, .csv.gz, .txt, .tsv, .log, .dat), .npz, .mat, .parquet, .h5, .mcap, .bag or .json. "
        "The file stays on this machine. The example is joint 1 of a KUKA KR300."
    ).classes("hint")
    refusal()


def _actions(desk: Desk) -> Callable[[], object]:
    """Draw the buttons and the progress. Return a function that redraws them."""
    heading(2, "4  Identify")
    with ui.element("div").classes("buttons"):
        identify = (
            ui.button("Identify", on_click=desk.identify).mark("identify").props("id=identify")
        )
        compare = ui.button("Compare models", on_click=desk.compare).props("outline id=compare")
    with ui.element("div").classes("working") as working:
        text = ui.label().classes("hint").props("id=progress")
        bar = ui.linear_progress(0.0, show_value=False).props('aria-label="progress"')
        ui.button("Cancel", on_click=desk.cancel).props("outline id=cancel")
    # A screen reader says it when work begins and ends, not at each update.
    status = ui.label().classes("spoken").props("role=status aria-live=polite id=status")

    def tick() -> None:
        bar.set_value(round(desk.work.shown_share, 3))
        text.set_text(desk.work.text)

    client = ui.context.client
    timer = ui.timer(_TICK, tick, active=False)
    spoken = {"name": ""}

    def draw() -> None:
        name = desk.work.name
        ready = desk.call is not None and name in ("", "reading")
        identify.set_enabled(ready)
        compare.set_enabled(ready)
        working.set_visibility(bool(name))
        timer.active = bool(name)
        tick()
        if name:
            status.set_text(desk.work.text)
        elif spoken["name"]:
            status.set_text("" if desk.failure or desk.problem else f"{spoken['name']}: done")
            if spoken["name"] != "reading":
                client.run_javascript(_KEEP_FOCUS)
        spoken["name"] = name

    draw()
    return draw
