"""Pictures for findings: recordings and estimates, drawn in the style of the reports."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

import jointid as jid
from jointid.base.html import Html
from jointid.estimate.window_views import fitted_signal, whole_windows
from jointid.panels import palette
from jointid.panels.friction import friction_map
from jointid.panels.marks import Bars, Level, Line, Mark, Panel, Picture, Points
from jointid.panels.windows import window_means
from jointid.report.drawing.style import STYLE
from jointid.report.page.content import Figure
from jointid.report.renderers.html_page import html_block

Array = NDArray[np.float64]
Drawing = Callable[[jid.Recording, jid.Estimate], Html]
_AXES = {
    "position": "position [rad]",
    "velocity": "velocity [rad/s]",
    "torque": "torque [N·m]",
    "sensor": "sensor reading",
}


def style() -> str:
    """Return the style sheet of the pictures on a page of the site, which has its own switch to dark."""
    light, dark = (
        " ".join(f"--{name}: {colour};" for name, colour in colours.items())
        for colours in (palette.LIGHT, palette.DARK)
    )
    rules = STYLE.partition("\nsvg")[2]
    # Only our pictures, because the theme draws its icons as svg, too.
    inside = ("svg" + rules).replace("svg", ".jointid-picture svg")
    return (
        f"body {{ {light} }}\n"
        f'body[data-theme="dark"] {{ {dark} }}\n'
        f'@media (prefers-color-scheme: dark) {{ body:not([data-theme="light"]) {{ {dark} }} }}\n'
        f"{inside}"
    )


def over_time(*signals: str, caption: str, start: float = 0.0, stop: float = np.inf) -> Drawing:
    """Draw signals of the recording in a stretch of time."""

    def drawn(recording: jid.Recording, _: jid.Estimate) -> Html:
        chosen = (recording.time >= start) & (recording.time <= stop)
        panels = [
            Panel(
                across="time [s]",
                up=_AXES[name],
                height=130 if len(signals) > 1 else 170,
                marks=(
                    Line(
                        look="second",
                        across=recording.time[chosen],
                        up=getattr(recording, name)[chosen],
                    ),
                ),
            )
            for name in signals
        ]
        return _figure(caption, *panels)

    return drawn


def samples(signal: str, *, caption: str, start: float, stop: float) -> Drawing:
    """Draw single samples of a signal."""

    def drawn(recording: jid.Recording, _: jid.Estimate) -> Html:
        chosen = (recording.time >= start) & (recording.time <= stop)
        time, values = recording.time[chosen], getattr(recording, signal)[chosen]
        marks: tuple[Mark, ...] = (
            Line(look="measured", across=time, up=values),
            Points(look="fitted", across=time, up=values),
        )
        return _figure(caption, Panel(across="time [s]", up=_AXES[signal], height=170, marks=marks))

    return drawn


def rate(*, caption: str, start: float, stop: float) -> Drawing:
    """Draw the recorded velocity, and the rate of the position."""

    def drawn(recording: jid.Recording, _: jid.Estimate) -> Html:
        chosen = (recording.time >= start) & (recording.time <= stop)
        time = recording.time[chosen]
        slope = np.gradient(recording.position[chosen], time)
        marks: tuple[Mark, ...] = (
            Line(look="measured", label="rate of the position", across=time, up=slope),
            Line(label="recorded velocity", across=time, up=recording.velocity[chosen]),
        )
        return _figure(
            caption, Panel(across="time [s]", up=_AXES["velocity"], height=190, marks=marks)
        )

    return drawn


def steps(*, caption: str) -> Drawing:
    """Draw the steps between time stamps."""

    def drawn(recording: jid.Recording, _: jid.Estimate) -> Html:
        count, edges = np.histogram(1e3 * np.diff(recording.time), bins=40)
        bars = Bars(edges=edges, up=count.astype(float), look="second")
        return _figure(
            caption,
            Panel(across="step of the time stamps [ms]", up="samples", height=170, marks=(bars,)),
        )

    return drawn


def friction(_: jid.Recording, estimate: jid.Estimate) -> Html:
    """Draw the friction map of the report."""
    return html_block(Figure(friction_map(estimate)))


def windows(_: jid.Recording, estimate: jid.Estimate) -> Html:
    """Draw the report's windows and their residuals over time."""
    return html_block(Figure(window_means(estimate)))


def residual_over(axis: str, *, caption: str) -> Drawing:
    """Draw the windows' residuals over the position, the velocity, or the load on the gear."""

    def drawn(recording: jid.Recording, estimate: jid.Estimate) -> Html:
        table = estimate.windows
        whole = whole_windows(table)
        centre = 0.5 * (table.start + table.stop)[whole]
        residual = (table.residual / table.duration)[whole]
        signal, unit = fitted_signal(estimate)
        if axis == "load":
            assert recording.sensor is not None
            velocity = np.interp(centre, recording.time, recording.velocity)
            across = np.abs(np.interp(centre, recording.time, recording.sensor))
            residual, label = residual * np.sign(velocity), "size of the sensor's reading"
        else:
            across, label = np.interp(centre, recording.time, getattr(recording, axis)), _AXES[axis]
        marks: tuple[Mark, ...] = (
            Points(look="second", across=across, up=residual),
            Level(look="measured", up=0.0),
        )
        up = f"residual of the {signal} [{unit}]"
        return _figure(caption, Panel(across=label, up=up, height=190, marks=marks))

    return drawn


def _figure(caption: str, *panels: Panel) -> Html:
    return html_block(Figure(Picture(caption=caption, panels=panels)))
