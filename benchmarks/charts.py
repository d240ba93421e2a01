"""The two pictures of docs/performance.md; colours of Okabe and Ito, shapes beside them for print."""

from __future__ import annotations

from pathlib import Path

import matplotlib as mpl
import numpy as np
from matplotlib import pyplot as plt
from matplotlib.axes import Axes
from matplotlib.lines import Line2D
from store import Store
from summary import rows

COLOURS = {"compressed": "#0072B2", "compiled": "#E69F00", "NumPy": "#555555"}
MARKS = {"compressed": "o", "compiled": "s", "NumPy": "D"}
SPREAD = 0.22  # of a line's height, over which single runs are strewn


def draw(store: Store, order: list[str], limit: float, folder: Path) -> None:
    """Both."""
    mpl.use("Agg")
    folder.mkdir(parents=True, exist_ok=True)
    with mpl.rc_context({"font.size": 9, "axes.spines.top": False, "axes.spines.right": False}):
        contest(store, order, limit, folder / "performance_contest.png")
        growth(store, folder / "performance_scaling.png")


def contest(store: Store, order: list[str], limit: float, path: Path) -> None:
    """Single runs pale, medians strong; open and with an arrow where most runs did not get there."""
    found = rows(store, order)[::-1]
    figure, axes = plt.subplots(figsize=(8.5, 0.25 * len(found) + 1.4), layout="constrained")
    for height, row in enumerate(found):
        colour, mark = COLOURS[row.form], MARKS[row.form]
        strewn = height + SPREAD * np.linspace(-1.0, 1.0, len(row.each))
        axes.plot(row.each, strewn, ".", color=colour, alpha=0.35, markersize=3)
        fill = "white" if row.bound else colour
        axes.plot(row.seconds, height, mark, color=colour, markerfacecolor=fill, markersize=6)
        if row.bound:
            axes.annotate(
                "",
                (row.seconds * 1.9, height),
                (row.seconds * 1.15, height),
                arrowprops={"arrowstyle": "->", "color": colour},
            )
    labels = [f"{row.name.replace('`', '')}   {row.reached}/{row.runs}" for row in found]
    axes.set_yticks(range(len(found)), labels)
    axes.set_xscale("log")
    axes.set_xlim(2e-4, 3.0 * limit)
    axes.set_ylim(-0.8, len(found) - 0.2)
    axes.set_xlabel("wall time to within 1e-3 of the optimal penalty [s]")
    axes.axvline(limit, color="0.6", linewidth=0.8, linestyle="--")
    axes.grid(axis="x", color="0.9")
    axes.set_axisbelow(True)
    keys = [
        Line2D(
            [], [], color=COLOURS[form], marker=MARKS[form], linestyle="", label=f"{form} penalty"
        )
        for form in COLOURS
    ]
    open_mark = Line2D(
        [], [], color="0.3", marker="o", markerfacecolor="white", linestyle="", label="not reached"
    )
    line = Line2D([], [], color="0.6", linestyle="--", label="limit of a run")
    figure.legend(handles=[*keys, open_mark, line], loc="outside upper center", ncols=5)
    figure.savefig(path, dpi=150)
    plt.close(figure)


def _lines(
    axes: Axes, x: list[float], series: dict[str, list[float]], what: tuple[str, str]
) -> None:
    colours, marks = list(COLOURS.values()), list(MARKS.values())
    for number, (name, y) in enumerate(series.items()):
        axes.plot(x, y, color=colours[number], marker=marks[number], markersize=4, label=name)
    axes.set_xscale("log")
    axes.set_yscale("log")
    axes.set_xlabel(what[0])
    axes.set_ylabel(what[1])
    axes.grid(color="0.92")
    axes.legend(frameon=False, fontsize=8)


def growth(store: Store, path: Path) -> None:
    """Samples, memory, windows, population; threads are a table only."""

    def column(over: str, field: str, factor: float = 1.0) -> list[float]:
        return [factor * float(r[field]) for r in store.of("scaling", over=over)]

    figure, axes = plt.subplots(2, 2, figsize=(8.5, 6.2), layout="constrained")
    samples = column("samples", "samples")
    _lines(
        axes[0, 0],
        samples,
        {"identify(), default windows": column("samples", "seconds")},
        ("samples", "time [s]"),
    )
    _lines(
        axes[0, 1],
        samples,
        {
            "peak": column("samples", "memory", 1e-6),
            "the recording's arrays": column("samples", "arrays", 1e-6),
        },
        ("samples", "memory [MB]"),
    )
    _lines(
        axes[1, 0],
        column("windows", "windows"),
        {
            "identify()": column("windows", "seconds"),
            "compressed penalty, a candidate": column("windows", "candidate"),
        },
        ("windows", "time [s]"),
    )
    _lines(
        axes[1, 1],
        column("population", "population"),
        {"with breeding, one thread": column("population", "candidate", 1e6)},
        ("population", "time per candidate [µs]"),
    )
    axes[1, 1].set_yscale("linear")
    axes[1, 1].set_ylim(bottom=0.0)
    figure.savefig(path, dpi=150)
    plt.close(figure)
