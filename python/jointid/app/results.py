"""The result: verdict, values, findings with remedies, pictures, the comparison, and files to download."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import partial
from typing import TYPE_CHECKING

from nicegui import ui

from jointid.app.charts import (
    friction_options,
    friction_text,
    residual_options,
    residual_text,
)
from jointid.app.desk import Desk
from jointid.app.look import chart, heading, note, of_page
from jointid.app.wording import label_of
from jointid.base.html import Html
from jointid.report.page.extras import Extras
from jointid.report.pages import parts_of
from jointid.report.renderers.html_page import html_parts

if TYPE_CHECKING:
    from jointid.base.result import Result
    from jointid.estimate.estimate import Estimate

# Names of parts of a report page; the first part has no name. The other parts are drawn here, with buttons.
_OF_ESTIMATE = ("", "parameters")
_OF_COMPARISON = ("models", "held-out")


def result_step(desk: Desk) -> Callable[[], object]:
    """Draw the step. Return a function that redraws it."""

    @ui.refreshable
    def draw() -> None:
        if desk.failure:
            spoken = desk.failure != desk.problem  # the screen reader has already said it
            note(desk.failure, "blocking", spoken=spoken).props("id=failure")
        estimate = desk.estimate
        if estimate is not None:
            of_page(_parts(estimate, _OF_ESTIMATE), "estimate")
            _findings(desk, estimate)
            _pictures(desk, estimate)
            _exports(desk, estimate)
        if desk.comparison is not None:
            heading(3, "Comparison")
            for sentence in desk.comparison.overview.answer:
                ui.label(sentence)
            of_page(_parts(desk.comparison, _OF_COMPARISON), "comparison")

    draw()
    return draw.refresh


def _parts(result: Result, names: tuple[str, ...]) -> list[Html]:
    """Return some parts of a result's page, under the headings of this page."""
    parts = parts_of(result, Extras(action=label_of))
    return html_parts([replace(each, look="open") for each in parts if each.name in names], 3)


def _findings(desk: Desk, estimate: Estimate) -> None:
    heading(3, "Findings", "findings")
    if not estimate.findings:
        ui.label("No findings.").classes("hint")
    for finding in estimate.findings:
        with note(finding.cause, finding.severity):
            for action in finding.advice:
                if desk.call is not None and desk.call.obey(action) is not None:
                    ui.button(label_of(action), on_click=partial(desk.obey, action)).props(
                        "outline no-caps"
                    )
                else:
                    ui.label(label_of(action)).classes("hint")


def _pictures(desk: Desk, estimate: Estimate) -> None:
    heading(3, "Friction and residuals")
    with ui.element("div").classes("pictures"):
        pictures = [
            (chart(options(estimate, desk.brushed), name, text(estimate), 300), options)
            for name, options, text in (
                ("windows", friction_options, friction_text),
                ("residuals", residual_options, residual_text),
            )
        ]

    def linked(stretch: tuple[float, float] | None) -> None:
        for picture, options in pictures:
            picture.options.clear()
            picture.options.update(options(estimate, stretch))
            picture.update()

    desk.on_brush = linked


def _exports(desk: Desk, estimate: Estimate) -> None:
    from jointid.joint.joint_file import joint_text

    def program() -> None:
        if desk.call is not None and desk.recording is not None:
            ui.download.content(desk.call.script(desk.recording), "identify.py")

    heading(3, "Download")
    with ui.element("div").classes("buttons"):
        for name, text, file in (
            ("Joint (TOML)", lambda: joint_text(estimate.joint), "joint.toml"),
            ("Report (HTML)", lambda: desk.report, "report.html"),
            ("Estimate (JSON)", estimate.to_json, "estimate.json"),
        ):
            ui.button(
                name, on_click=lambda text=text, file=file: ui.download.content(text(), file)
            ).props(f"outline id=export-{file.rpartition('.')[2]}")
        ui.button("Program (Python)", on_click=program).props("outline id=export-py")
