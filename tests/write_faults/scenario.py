"""Something that writes, and who says whether its files are whole."""

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

Acknowledge = Callable[[], object]


@dataclass(frozen=True)
class Scenario:
    """Something that writes files into a folder.

    Attributes
    ----------
    prepare : callable
        Puts into the folder what is there before.
    act : callable
        Writes, and calls its second argument whenever it says that something is saved.
    judge : callable
        What is wrong with the folder after so many of these calls; "" if nothing is.
    synced : bool
        Whether all that is acknowledged is also safe from a loss of power. Default True; else from a crash alone.
    before : int
        How many calls are of what was there before, and is not lost in either case. Default 0.
    """

    prepare: Callable[[Path], object]
    act: Callable[[Path, Acknowledge], None]
    judge: Callable[[Path, int], str]
    synced: bool = True
    before: int = 0
