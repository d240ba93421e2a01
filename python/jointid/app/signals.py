"""Third step: the signals over time. The user selects a stretch by mouse or by numbers, and excludes it."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from nicegui import ui

from jointid.app.charts import signals_height, signals_options, signals_text
from jointid.app.desk import Desk
from jointid.app.look import FIELD, chart, focus, heading


def signals_step(desk: Desk) -> Callable[[], object]:
    """Draw the step. Return a function that redraws it."""
    heading(2, "3  Signals")

    @ui.refreshable
    def draw() -> None:
        recording = desk.recording
        if recording is None or desk.call is None:
            ui.label("The signals appear as soon as time and position are known.").classes("hint")
            return
        ui.label(
            "Select a part with the mouse, or enter its begin and end. Its windows are highlighted below, "
            "and you can leave this part out."
        ).classes("hint")
        picture = chart(
            signals_options(recording, desk.call.left_out),
            "signals",
            signals_text(recording),
            signals_height(recording),
        )

        def ready() -> None:
            picture.run_chart_method(
                "dispatchAction",
                {
                    "type": "takeGlobalCursor",
                    "key": "brush",
                    "brushOption": {"brushType": "lineX", "brushMode": "single"},
                },
            )

        def brushed(event: Any) -> None:
            areas = event.args.get("areas") or []
            bounds = areas[0].get("coordRange") if areas else None
            desk.brush(bounds)
            shown()

        picture.on("chart:brushEnd", brushed, ["areas"])
        picture.on("chart:rendered", ready, [], throttle=1.0, trailing_events=False)
        ui.timer(0.3, ready, once=True)

        def stated() -> None:
            if begin.value is not None and end.value is not None:
                desk.brush((begin.value, end.value))
                leave.set_enabled(desk.brushed is not None)

        def shown() -> None:
            """Show the stretch selected by mouse in the fields."""
            start, stop = desk.brushed or (None, None)
            begin.set_value(None if start is None else round(start, 3))
            end.set_value(None if stop is None else round(stop, 3))
            leave.set_enabled(desk.brushed is not None)

        client = ui.context.client

        def leave_out() -> None:
            desk.leave_out()
            draw.refresh()
            focus(client, "keep-all")

        def keep_all() -> None:
            desk.keep_all()
            draw.refresh()
            focus(client, "stretch-from")

        with ui.element("div").classes("buttons"):
            begin = ui.number("from [s]", on_change=stated).props(f"{FIELD} for=stretch-from")
            end = ui.number("to [s]", on_change=stated).props(f"{FIELD} for=stretch-to")
            leave = ui.button("Leave this part out", on_click=leave_out)
            leave.props("outline id=leave-out").set_enabled(False)
        if desk.call.left_out:
            stretches = ", ".join(f"{a:.2f} to {b:.2f} s" for a, b in desk.call.left_out)
            with ui.element("div").classes("buttons"):
                ui.label(f"left out: {stretches}").props("id=left-out")
                ui.button("Keep all", on_click=keep_all).props("outline id=keep-all")

    draw()
    return draw.refresh
