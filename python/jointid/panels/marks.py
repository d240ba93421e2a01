"""The elements of a picture: lines, points, bands, bars, levels, shades and ranges, on panels."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np
from numpy.typing import ArrayLike, NDArray

from jointid.base.values import dataclass
from jointid.panels.palette import LOOKS

Array = NDArray[np.float64]


class Mark:
    """One thing that is drawn.

    Attributes
    ----------
    look : str
        One of the palette's: "measured", "fitted", "second", "third", "fourth", "fifth". Default "fitted".
    label : str
        For the legend. Default: none.
    """

    __slots__ = ()
    look: str
    label: str

    def __post_init__(self) -> None:
        if self.look not in LOOKS:
            raise ValueError(f"no look '{self.look}' in the palette")

    def values(self) -> tuple[Iterable[Array], Iterable[Array]]:
        """What the two axes must have room for."""
        return (), ()


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Line(Mark):
    """A line through points in order; a value that is not finite interrupts it.

    Attributes
    ----------
    across, up : array_like, shape (n,)
    dashed : bool
        Default False.
    series : bool
        One of several lines of the same kind, which also differ in their dashes. Default False.
    """

    across: ArrayLike
    up: ArrayLike
    dashed: bool = False
    series: bool = False
    look: str = "fitted"
    label: str = ""

    def values(self) -> tuple[Iterable[Array], Iterable[Array]]:
        """What the two axes must have room for."""
        return (numbers(self.across),), (numbers(self.up),)


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Points(Mark):
    """Single points.

    Attributes
    ----------
    across, up : array_like, shape (n,)
    """

    across: ArrayLike
    up: ArrayLike
    look: str = "fitted"
    label: str = ""

    def values(self) -> tuple[Iterable[Array], Iterable[Array]]:
        """What the two axes must have room for."""
        return (numbers(self.across),), (numbers(self.up),)


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Band(Mark):
    """The area between two lines; a value that is not finite interrupts it.

    Attributes
    ----------
    across, low, high : array_like, shape (n,)
    """

    across: ArrayLike
    low: ArrayLike
    high: ArrayLike
    look: str = "fitted"
    label: str = ""

    def values(self) -> tuple[Iterable[Array], Iterable[Array]]:
        """What the two axes must have room for."""
        return (numbers(self.across),), (numbers(self.low), numbers(self.high))


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Bars(Mark):
    """Bars that stand on zero, side by side.

    Attributes
    ----------
    edges : array_like, shape (n + 1,)
        Increasing.
    up : array_like, shape (n,)
    """

    edges: ArrayLike
    up: ArrayLike
    look: str = "fitted"
    label: str = ""

    def values(self) -> tuple[Iterable[Array], Iterable[Array]]:
        """What the two axes must have room for."""
        return (numbers(self.edges),), (numbers(self.up), np.zeros(1))


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Level(Mark):
    """A dashed line at one value, all across the panel.

    Attributes
    ----------
    up : float
    """

    up: float
    look: str = "fitted"
    label: str = ""

    def values(self) -> tuple[Iterable[Array], Iterable[Array]]:
        """What the two axes must have room for."""
        return (), (numbers([self.up]),)


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Shade(Mark):
    """Stretches of the axis across, shaded all over the panel's height.

    Attributes
    ----------
    start, stop : array_like, shape (n,)
    """

    start: ArrayLike
    stop: ArrayLike
    look: str = "measured"
    label: str = ""

    def values(self) -> tuple[Iterable[Array], Iterable[Array]]:
        """What the two axes must have room for."""
        return (numbers(self.start), numbers(self.stop)), ()


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Range(Mark):
    """A stretch of the upright axis, shaded all across the panel.

    Attributes
    ----------
    low, high : float
    """

    low: float
    high: float
    look: str = "measured"
    label: str = ""

    def values(self) -> tuple[Iterable[Array], Iterable[Array]]:
        """What the two axes must have room for."""
        return (), (numbers([self.low, self.high]),)


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Panel:
    """Two axes and what is drawn on them, the first mark at the bottom.

    Attributes
    ----------
    marks : tuple of Mark
    across, up : str
        What the axes show, with the unit in brackets: "velocity [rad/s]".
    logarithmic, logarithmic_across : bool
        Of the upright axis, and of the axis across. Default False.
    height : int
        Of the axes, in units of the picture, which is 560 wide. Default 220.
    names : tuple of str
        Of rows below each other, instead of numbers at the upright axis: marks are drawn at 0 for the first row, -1
        for the second. Default: none.
    right : tuple of Mark
        Drawn last, on an upright axis of their own at the right. Default: no such axis.
    right_up : str
        What that axis shows.
    """

    marks: tuple[Mark, ...]
    across: str
    up: str
    logarithmic: bool = False
    logarithmic_across: bool = False
    height: int = 220
    names: tuple[str, ...] = ()
    right: tuple[Mark, ...] = ()
    right_up: str = ""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Picture:
    """Panels below each other, with one axis across, and what they show.

    Attributes
    ----------
    caption : str
        One or two sentences that explain the picture.
    panels : tuple of Panel
        From above.
    title : str
        Title if a page has several pictures of the same kind, e.g. a joint's name. Default: no title.
    """

    caption: str
    panels: tuple[Panel, ...]
    title: str = ""


def row_height(rows: int) -> int:
    """Return the height of a panel of named rows, in units of the picture."""
    return 46 * rows + 14


def numbers(values: ArrayLike) -> Array:
    """Return values as an array of numbers, masked ones as gaps."""
    # Only what has a mask is worth the import of numpy.ma.
    if hasattr(values, "mask") and isinstance(values, np.ma.MaskedArray):
        return np.ma.filled(values.astype(np.float64), np.nan)
    return np.asarray(values, dtype=np.float64)
