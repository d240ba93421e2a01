"""What was found: verdict, values, findings with remedies, pictures, the comparison, and files to take away."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import partial
from typing import TYPE_CHECKING

from nicegui import ui

from jointid.app.charts import estimate_options
from jointid.app.desk import Desk
from jointid.estimate.html_tables import html_table
from jointid.report.answering import verdict_lines

if TYPE_CHECKING:
    from jointid.base.advice import Action
    from jointid.estimate.estimate import Estimate

_COLOURS = {"blocking": "text-negative", "warning": "text-warning", "info": ""}


def result_step(desk: Desk) -> Callable[[], object]:
    """Draw the step; returns what draws it anew."""

    @ui.refreshable
    def draw() -> None:
        estimate = desk.estimate
        if estimate is not None:
            for line in verdict_lines(estimate.verdict):
                ui.html(str(line), sanitize=False)
            ui.html(str(html_table(estimate)), sanitize=False).props("id=estimate")
            _findings(desk, estimate)
            _pictures(desk, estimate)
            _exports(desk, estimate)
        if desk.comparison is not None:
            ui.label("Comparison").classes("text-lg")
            ui.html(desk.comparison._repr_html_(), sanitize=False).props("id=comparison")

    draw()
    return draw.refresh


def _findings(desk: Desk, estimate: Estimate) -> None:
    if not estimate.findings:
        ui.label("No findings.")
    for finding in estimate.findings:
        with ui.column().classes("gap-1"):
            ui.label(f"{finding.code}: {finding.cause}").classes(_COLOURS[finding.severity])
            with ui.row().classes("items-center"):
                for action in finding.advice:
                    if desk.call is not None and desk.call.obey(action) is not None:
                        ui.button(label_of(action), on_click=partial(desk.obey, action)).props(
                            "outline dense no-caps"
                        )
                    else:
                        ui.label(f"{action.kind} {action.text}".strip()).classes("text-caption")


def label_of(action: Action) -> str:
    """What a button that does it is called.

    Examples
    --------
    >>> from jointid.base.advice import Action
    >>> label_of(Action("call", {"units": {"position": "deg"}}, function="load"))
    'units: position = deg'
    """
    shown = "; ".join(f"{name}: {_value(value)}" for name, value in action.arguments.items())
    return f"{shown} ({action.text})" if action.text else shown


def _value(value: object) -> str:
    if isinstance(value, Mapping):
        return ", ".join(f"{key} = {_value(each)}" for key, each in value.items()) or "none"
    return "none" if value is None else f"{value:.4g}" if isinstance(value, float) else str(value)


def _pictures(desk: Desk, estimate: Estimate) -> None:
    chart = (
        ui.echart(estimate_options(estimate, desk.brushed))
        .props("id=windows")
        .style("height: 320px; width: 100%")
    )

    def linked(stretch: tuple[float, float] | None) -> None:
        chart.options.clear()
        chart.options.update(estimate_options(estimate, stretch))
        chart.update()

    desk.on_brush = linked


def _exports(desk: Desk, estimate: Estimate) -> None:
    from jointid.joint.joint_file import joint_text

    def program() -> None:
        if desk.call is not None and desk.recording is not None:
            ui.download.content(desk.call.script(desk.recording), "identify.py")

    with ui.row():
        for name, text, file in (
            ("Joint (TOML)", lambda: joint_text(estimate.joint), "joint.toml"),
            ("Report (HTML)", lambda: desk.report, "report.html"),
            ("Estimate (JSON)", estimate.to_json, "estimate.json"),
        ):
            ui.button(
                name, on_click=lambda text=text, file=file: ui.download.content(text(), file)
            ).props(f"outline id=export-{file.rpartition('.')[2]}")
        ui.button("Program (Python)", on_click=program).props("outline id=export-py")
