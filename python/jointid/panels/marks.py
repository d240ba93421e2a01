"""Elements of a picture: lines, points, bands, bars, levels, shades and ranges, on panels."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np
from numpy.typing import ArrayLike, NDArray

from jointid.base.values import dataclass
from jointid.panels.palette import LOOKS

Array = NDArray[np.float64]


class Mark:
    """One drawn element.

    Attributes
    ----------
    look : str
        Look from the palette: "measured", "fitted", "second", "third", "fourth", "fifth". Default "fitted".
    label : str
        Label in the legend. Default: none.
    """

    __slots__ = ()
    look: str
    label: str

    def __post_init__(self) -> None:
        if self.look not in LOOKS:
            raise ValueError(f"no look '{self.look}' in the palette")

    def values(self) -> tuple[Iterable[Array], Iterable[Array]]:
        """Return the values that the two axes must include."""
        return (), ()


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Line(Mark):
    """A line through points in order. A value that is not finite interrupts it.

    Attributes
    ----------
    across, up : array_like, shape (n,)
    dashed : bool
        Whether the line is dashed. Default False.
    series : bool
        Whether it is one of several lines of the same kind, which also differ in their dashes. Default False.
    """

    across: ArrayLike
    up: ArrayLike
    dashed: bool = False
    series: bool = False
    look: str = "fitted"
    label: str = ""

    def values(self) -> tuple[Iterable[Array], Iterable[Array]]:
        """Return the values that the two axes must include."""
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
        """Return the values that the two axes must include."""
        return (numbers(self.across),), (numbers(self.up),)


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Band(Mark):
    """The area between two lines. A value that is not finite interrupts it.

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
        """Return the values that the two axes must include."""
        return (numbers(self.across),), (numbers(self.low), numbers(self.high))


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Bars(Mark):
    """Adjacent bars that start at zero.

    Attributes
    ----------
    edges : array_like, shape (n + 1,)
        Edges of the bars, increasing.
    up : array_like, shape (n,)
    """

    edges: ArrayLike
    up: ArrayLike
    look: str = "fitted"
    label: str = ""

    def values(self) -> tuple[Iterable[Array], Iterable[Array]]:
        """Return the values that the two axes must include."""
        return (numbers(self.edges),), (numbers(self.up), np.zeros(1))


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Level(Mark):
    """A dashed line at one value, across the whole panel.

    Attributes
    ----------
    up : float
    """

    up: float
    look: str = "fitted"
    label: str = ""

    def values(self) -> tuple[Iterable[Array], Iterable[Array]]:
        """Return the values that the two axes must include."""
        return (), (numbers([self.up]),)


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Shade(Mark):
    """Shaded intervals of the horizontal axis, over the whole height of the panel.

    Attributes
    ----------
    start, stop : array_like, shape (n,)
    """

    start: ArrayLike
    stop: ArrayLike
    look: str = "measured"
    label: str = ""

    def values(self) -> tuple[Iterable[Array], Iterable[Array]]:
        """Return the values that the two axes must include."""
        return (numbers(self.start), numbers(self.stop)), ()


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Range(Mark):
    """A shaded interval of the vertical axis, over the whole width of the panel.

    Attributes
    ----------
    low, high : float
    """

    low: float
    high: float
    look: str = "measured"
    label: str = ""

    def values(self) -> tuple[Iterable[Array], Iterable[Array]]:
        """Return the values that the two axes must include."""
        return (), (numbers([self.low, self.high]),)


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Panel:
    """Two axes and the marks drawn on them. The first mark is at the bottom.

    Attributes
    ----------
    marks : tuple of Mark
    across, up : str
        Labels of the axes, with the unit in brackets: "velocity [rad/s]".
    logarithmic, logarithmic_across : bool
        Whether the vertical and the horizontal axis are logarithmic. Default False.
    height : int
        Height of the axes, in units of the picture, which is 560 wide. Default 220.
    names : tuple of str
        Names of rows below each other, which replace numbers at the vertical axis. Marks are drawn at 0 for
        the first row, at -1 for the second. Default: none.
    right : tuple of Mark
        Marks drawn last, on a second vertical axis at the right. Default: no such axis.
    right_up : str
        Label of that axis.
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
    """Panels below each other with a common horizontal axis, and their caption.

    Attributes
    ----------
    caption : str
        One or two sentences that explain the picture.
    panels : tuple of Panel
        Panels from top to bottom.
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
    """Return values as an array of numbers, with masked values as gaps."""
    # Only a masked array is worth the import of numpy.ma.
    if hasattr(values, "mask") and isinstance(values, np.ma.MaskedArray):
        return np.ma.filled(values.astype(np.float64), np.nan)
    return np.asarray(values, dtype=np.float64)
