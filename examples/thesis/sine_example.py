"""Figures 4-8 to 4-11: why the penalty is summed over windows, on sin x and 2 sin x."""

import math

import numpy as np
from gallery import Gallery, titled
from numpy.typing import NDArray

Array = NDArray[np.float64]


def integral(stop: Array | float) -> Array | float:
    """Of sin x from -pi."""
    return -np.cos(stop) - 1.0


def penalties(count: int) -> dict[str, float]:
    """Of the difference between both curves, at `count` divisions of [-pi, pi], in each reading."""
    edges = np.linspace(-math.pi, math.pi, count + 1)
    running = np.asarray(integral(edges)) * (1.0 - 2.0)
    windows = np.diff(running)
    return {
        "running integral (4-18)": float(running[1:].sum()),
        "windows, as printed (4-19)": float(windows.sum()),
        "windows, squared": float(windows @ windows),
    }


def draw(gallery: Gallery) -> None:
    """Draw the four."""
    x = np.linspace(-math.pi, math.pi, 400)
    ends = np.linspace(-math.pi, math.pi, 11)
    looks = (("sin x", "-", "#000000", 1.0), ("2 sin x", "--", "#D55E00", 2.0))
    with gallery.picture("4-8_to_4-11_sine_example", 2, 2) as (plain, cut, running, places):
        for label, dash, colour, size in looks:
            plain.plot(x, size * np.sin(x), dash, color=colour, label=label)
            cut.plot(x, size * np.sin(x), dash, color=colour, label=label)
            part = x[x <= 1.0]
            area = size * float(integral(1.0))
            cut.fill_between(part, size * np.sin(part), color=colour, alpha=0.2, linewidth=0)
            cut.text(
                -2.9, 1.1 + 0.4 * size, f"{label}: area to x = 1 is −{-area:.4f}", color=colour
            )
            for axes in (running, places):
                axes.plot(x, size * np.asarray(integral(x)), dash, color=colour, label=label)
        for place in ends[1:]:
            places.plot([place] * 2, [integral(place), 2 * integral(place)], ":", color="#0072B2")
        places.plot(ends, integral(ends), "o", color="#000000", markersize=4)
        places.plot(ends, 2 * np.asarray(integral(ends)), "s", color="#D55E00", markersize=4)
        titles = ("4-8: two curves of equal area", "4-9: areas from −π to 1")
        below = ("4-10: running integrals", "4-11: compared at ten places")
        for axes, title in zip((plain, cut, running, places), titles + below, strict=True):
            titled(axes, title).set_xlabel("x [rad]")
            axes.set_ylabel("integral from −π [–]" if axes in (running, places) else "y [–]")
            if axes is not cut:
                axes.legend(loc="lower left" if axes in (running, places) else "upper left")
    gallery.note("4-17", "integral of sin from −π to 1", float(integral(1.0)), "", "−0.7738")
    gallery.note("4-17", "integral of 2 sin", 2.0 * float(integral(1.0)), "", "−0.1548")
    first = np.asarray(integral(ends[1:3])) * -1.0
    gallery.note("4-18", "first term", first[0], "", "0.1909")
    gallery.note("4-18", "second term", first[1], "", "0.6909")
    gallery.note("4-18", "sum of ten terms", penalties(10)["running integral (4-18)"], "", "10.1")
    for count in (10, 100, 1000):
        for name, value in penalties(count).items():
            gallery.note("4-19", f"{name}, n = {count}", value)
