"""The endings of file names: which of several a name has, and how they are listed in a text."""

from collections.abc import Sequence
from pathlib import Path

from jointid.base.errors import InputError


def ending_of(path: Path, endings: Sequence[str]) -> str:
    """Return which of some endings a file name has, in upper or lower case.

    Parameters
    ----------
    path : Path
    endings : sequence of str
        In lower case, with the dot. Of several that fit, the longest is returned.

    Raises
    ------
    InputError
        The name has none of them.

    Examples
    --------
    >>> ending_of(Path("run.CSV.gz"), (".csv", ".csv.gz", ".gz"))
    '.csv.gz'
    """
    for ending in sorted(endings, key=len, reverse=True):
        if path.name.lower().endswith(ending):
            return ending
    raise InputError(
        f"a file name that ends in {alternatives(endings)} is expected", place=str(path)
    )


def alternatives(names: Sequence[str]) -> str:
    """Return names as alternatives in a sentence.

    Examples
    --------
    >>> alternatives((".csv", ".npz", ".mat"))
    '.csv, .npz or .mat'
    """
    *others, last = names
    return f"{', '.join(others)} or {last}" if others else last
