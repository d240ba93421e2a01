"""Where pictures and numbers of the thesis's figures are gathered."""

import csv
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib import pyplot
from matplotlib.axes import Axes

import jointid as jid


@dataclass(frozen=True)
class Number:
    """One number beside what the thesis says."""

    figure: str
    what: str
    value: float
    unit: str
    thesis: str


@dataclass
class Gallery:
    """A folder of pictures and a table of numbers; `quick` asks for small settings."""

    folder: Path
    quick: bool = False
    numbers: list[Number] = field(default_factory=list)

    @contextmanager
    def picture(self, name: str, rows: int = 1, columns: int = 1, **settings: Any) -> Iterator[Any]:
        """Yield axes, one or a flat array of them; save the picture at the end of the block."""
        size = settings.pop("size", (4.6 * columns, 3.1 * rows))
        with jid.plot.style():
            figure, axes = pyplot.subplots(rows, columns, figsize=size, **settings)
            yield axes.ravel() if isinstance(axes, np.ndarray) else axes
            self.folder.mkdir(parents=True, exist_ok=True)
            figure.savefig(self.folder / f"{name}.png", dpi=90, metadata={"Software": None})
            pyplot.close(figure)

    def note(self, figure: str, what: str, value: float, unit: str = "", thesis: str = "") -> None:
        """Enter a number into the table."""
        self.numbers.append(Number(figure, what, float(value), unit, thesis))

    def write_table(self) -> None:
        """Write numbers.csv beside the pictures."""
        with (self.folder / "numbers.csv").open("w", newline="", encoding="utf-8") as file:
            writer = csv.writer(file)
            writer.writerow(["figure", "what", "value", "unit", "thesis"])
            for number in self.numbers:
                row = (
                    number.figure,
                    number.what,
                    f"{number.value:.5g}",
                    number.unit,
                    number.thesis,
                )
                writer.writerow(row)


def titled(axes: Axes, text: str) -> Axes:
    """A title of modest size."""
    axes.set_title(text, fontsize=9.0)
    return axes
