"""What a drawn picture shows, read back from its markup as a browser reads it."""

import re
import xml.etree.ElementTree as ElementTree
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Axis:
    """Places of two numbers on an axis give the value of each place."""

    places: Array
    values: Array

    def value(self, place: Array) -> Array:
        slope, offset = np.polyfit(self.places, self.values, 1)
        return np.asarray(slope * place + offset)


class Picture:
    """One SVG."""

    def __init__(self, markup: str) -> None:
        self.root = ElementTree.fromstring(markup)

    def path(self, kind: str, which: int = 0) -> str:
        """The `d` of a mark, legends aside: they come before the axes."""
        seen = [
            each.attrib["d"]
            for each in self.after_axes()
            if each.tag == "path" and kind in each.attrib["class"].split()
        ]
        return seen[which]

    def points(self, kind: str, which: int = 0) -> list[Array]:
        """The corners of each piece of a path, shape (n, 2)."""
        return corners(self.path(kind, which))

    def axis(self, kind: str) -> Axis:
        """The axis "across" or "up" as its numbers tell."""
        place = "x" if kind == "across" else "y"
        shift = 0.0 if kind == "across" else 45.0
        found = [
            (float(each.attrib[place]) - shift, number(each.text or ""))
            for each in self.root.iter("text")
            if each.attrib.get("class") == kind and is_number(each.text or "")
        ]
        return Axis(*(np.array(each) for each in zip(*found, strict=True)))

    @property
    def texts(self) -> list[str]:
        return [each.text or "" for each in self.root.iter("text")]

    def after_axes(self) -> list[ElementTree.Element]:
        """What is drawn of the marks, and the titles between them."""
        children = list(self.root)
        first = next(n for n, each in enumerate(children) if each.attrib.get("class") == "axes")
        return children[first + 1 :]


def corners(path: str) -> list[Array]:
    """Follow a path of M, l, h, H and V; each piece that starts with M is one array."""
    pieces: list[list[tuple[float, float]]] = []
    x = y = 0.0
    for command, numbers in re.findall(r"([MlhHVvz])([^MlhHVvz]*)", path):
        values = [float(each) for each in numbers.split()]
        if command == "M":
            x, y = values
            pieces.append([(x, y)])
        elif command == "l":
            for dx, dy in zip(values[::2], values[1::2], strict=True):
                x, y = x + dx, y + dy
                pieces[-1].append((x, y))
        elif command in "hHvV" and command != "z":
            if command in "hH":
                x = values[0] + (x if command == "h" else 0.0)
            else:
                y = values[0] + (y if command == "v" else 0.0)
            pieces[-1].append((x, y))
    return [np.array(piece) for piece in pieces]


def is_number(text: str) -> bool:
    return re.fullmatch(r"−?[0-9]+(\.[0-9]+)?", text) is not None


def number(text: str) -> float:
    return float(text.replace("−", "-"))
