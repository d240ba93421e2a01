"""Third step: the signals over time, of which stretches can be brushed and left out."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from nicegui import ui

from jointid.app.charts import signals_height, signals_options
from jointid.app.desk import Desk


def signals_step(desk: Desk) -> Callable[[], object]:
    """Draw the step; returns what draws it anew."""
    ui.label("3  Signals").classes("text-lg")

    @ui.refreshable
    def draw() -> None:
        recording = desk.recording
        if recording is None or desk.call is None:
            ui.label("They are shown when time and position are known.")
            return
        ui.label(
            "Drag over a part of the recording to see its windows below, or to leave it out."
        ).classes("text-caption")
        chart = (
            ui.echart(signals_options(recording, desk.call.left_out))
            .props("id=signals")
            .style(f"height: {signals_height(recording)}px; width: 100%")
        )

        def ready() -> None:
            chart.run_chart_method(
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
            buttons.refresh()

        chart.on("chart:brushEnd", brushed, ["areas"])
        chart.on("chart:rendered", ready, [], throttle=1.0, trailing_events=False)
        ui.timer(0.3, ready, once=True)

        @ui.refreshable
        def buttons() -> None:
            with ui.row().classes("items-center"):
                if desk.brushed is not None:
                    start, stop = desk.brushed
                    ui.button(f"Leave {start:.2f} to {stop:.2f} s out", on_click=leave_out).props(
                        "outline id=leave-out"
                    )
                if desk.call is not None and desk.call.left_out:
                    stretches = ", ".join(f"{a:.2f} to {b:.2f} s" for a, b in desk.call.left_out)
                    ui.label(f"left out: {stretches}").props("id=left-out")
                    ui.button("Keep all", on_click=keep_all).props("flat id=keep-all")

        def leave_out() -> None:
            desk.leave_out()
            draw.refresh()

        def keep_all() -> None:
            desk.keep_all()
            draw.refresh()

        buttons()

    draw()
    return draw.refresh
