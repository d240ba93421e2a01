"""Tables as text: aligned columns, with a line below the head."""

from __future__ import annotations

from collections.abc import Sequence


def aligned(table: Sequence[Sequence[str]]) -> list[str]:
    r"""Return the lines of a table.

    Parameters
    ----------
    table : sequence of sequence of str
        Rows with equal numbers of cells, the head first.

    Examples
    --------
    >>> print(*aligned([["joint", "coulomb"], ["1", "7.1"]]), sep="\n")
    joint  coulomb
    -----  -------
    1      7.1
    """
    widths = [max(len(row[column]) for row in table) for column in range(len(table[0]))]
    lines = [
        "  ".join(cell.ljust(width) for cell, width in zip(row, widths, strict=True)).rstrip()
        for row in table
    ]
    return [lines[0], "  ".join("-" * width for width in widths), *lines[1:]]
