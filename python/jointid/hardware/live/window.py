"""Window of a `LivePlot`: it reads points from its input and draws them until the input ends."""

from __future__ import annotations

import argparse
import math
import os
import sys
from collections import deque
from pathlib import Path
from typing import Any

_PAUSE = 0.1  # [s] between two pictures
Point = tuple[float, float, float, float, float]


class Panels:
    """Three panels, one above the other: position, error, torque with the sensor.

    Parameters
    ----------
    figure : matplotlib.figure.Figure
    span : float
        Time span of the panels [s].
    """

    def __init__(self, figure: Any, span: float) -> None:
        self._figure, self._span = figure, span
        self._points: deque[Point] = deque()
        position, error, torque = figure.subplots(3, 1, sharex=True)
        (self._reference,) = position.plot([], [], color="0.6", label="reference")
        (self._position,) = position.plot([], [], color="C0", label="position")
        position.set_ylabel("position (°)")
        position.legend(loc="upper right")
        (self._error,) = error.plot([], [], color="C3")
        error.set_ylabel("error (°)")
        (self._torque,) = torque.plot([], [], color="C1", label="torque")
        torque.set_ylabel("torque (N·m)")
        torque.set_xlabel("time (s)")
        sensor = torque.twinx()
        (self._reading,) = sensor.plot([], [], color="C2", linewidth=0.8, label="sensor")
        sensor.set_ylabel("sensor (raw)")
        torque.legend(handles=[self._torque, self._reading], loc="upper right")
        self._axes = (position, error, torque, sensor)

    def add(self, points: list[Point]) -> None:
        """Add points. Points older than the span are removed."""
        self._points.extend(points)
        while self._points and self._points[-1][0] - self._points[0][0] > self._span:
            self._points.popleft()

    def draw(self) -> None:
        """Draw the newest points."""
        if not self._points:
            return
        time, position, reference, torque, reading = zip(*self._points, strict=True)
        error = [math.degrees(p - r) for p, r in zip(position, reference, strict=True)]
        self._reference.set_data(time, [math.degrees(each) for each in reference])
        self._position.set_data(time, [math.degrees(each) for each in position])
        self._error.set_data(time, error)
        self._torque.set_data(time, torque)
        self._reading.set_data(time, reading)
        for axes in self._axes:
            axes.relim()
            axes.autoscale_view()
        self._figure.canvas.draw_idle()


def main() -> int:
    """Draw until the input ends."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--span", type=float, required=True)
    parser.add_argument("--picture", type=Path)
    parser.add_argument("--no-window", action="store_true")
    arguments = parser.parse_args()
    import matplotlib as mpl

    from jointid.base.pictures import write_picture
    from jointid.hardware.live.plot import POINT

    if arguments.no_window:
        mpl.use("Agg")
    from matplotlib import pyplot

    figure = pyplot.figure(figsize=(8.0, 7.0), layout="constrained")
    panels = Panels(figure, arguments.span)
    pipe = sys.stdin.fileno()
    shown = not arguments.no_window
    if shown:
        os.set_blocking(pipe, False)
        pyplot.show(block=False)
    rest = b""
    while (block := _read(pipe)) != b"":
        rest += block or b""
        whole = len(rest) // POINT.size * POINT.size
        panels.add([_point(each) for each in POINT.iter_unpack(rest[:whole])])
        rest = rest[whole:]
        if shown:
            panels.draw()
            if not pyplot.get_fignums():
                return 0  # the user has closed the window
            pyplot.pause(_PAUSE)
    panels.draw()
    if arguments.picture is not None:
        write_picture(figure, arguments.picture)
    return 0


def _read(pipe: int) -> bytes | None:
    """Return the available bytes; empty at the end, None if there are none yet."""
    try:
        return os.read(pipe, 1 << 16)
    except BlockingIOError:
        return None


def _point(values: tuple[Any, ...]) -> Point:
    time, position, reference, torque, reading = values
    return time, position, reference, torque, reading


if __name__ == "__main__":
    sys.exit(main())
