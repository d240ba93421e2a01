"""Endings of file names."""

from collections.abc import Sequence
from pathlib import Path

from jointid.base.error_text import alternatives
from jointid.base.errors import InputError


def ending_of(path: Path, endings: Sequence[str]) -> str:
    """Return the ending of a file name among these endings; upper or lower case.

    Parameters
    ----------
    path : Path
    endings : sequence of str
        Endings in lower case, with the dot. If several fit, the longest is returned.

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
    """Return the error for a file name with none of these endings."""
    expected = f"a file name that ends in {alternatives(endings)} is expected"
    if path.is_dir():
        inside = path / f"*{endings[0]}"
        return InputError(
            f"this is a folder; {expected}",
            place=str(path),
            remedy=f"name the files in it, as in {inside}",
        )
    return InputError(expected, place=str(path))
