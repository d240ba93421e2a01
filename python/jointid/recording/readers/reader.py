"""What a file format declares: its endings, how to open a file, and the package that it needs."""

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

from jointid.recording.table import Table


@dataclass(frozen=True, kw_only=True)
class Reader:
    """How files of one format are read.

    Attributes
    ----------
    endings : tuple of str
        Endings of the file names, in lower case, with the dot.
    open : callable
        Takes a path and returns the file as a `Table`. It raises `InputError` when the file is
        damaged; the caller handles `OSError` and a missing package.
    package : str
        Package that `open` imports and that is not installed with jointid. Default: none.
    extra : str
        Extra of jointid that installs this package. Default: none.
    """

    endings: tuple[str, ...]
    open: Callable[[Path], Table]
    package: str = ""
    extra: str = ""
