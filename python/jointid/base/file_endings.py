"""The endings of file names: which of several a name has."""

from collections.abc import Sequence
from pathlib import Path

from jointid.base.error_text import alternatives
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
    raise no_ending(path, endings)


def no_ending(path: Path, endings: Sequence[str]) -> InputError:
    """Return the error of a file name that has none of some endings."""
    expected = f"a file name that ends in {alternatives(endings)} is expected"
    if path.is_dir():
        inside = path / f"*{endings[0]}"
        return InputError(
            f"this is a folder; {expected}",
            place=str(path),
            remedy=f"name its files, as in {inside}",
        )
    return InputError(expected, place=str(path))
