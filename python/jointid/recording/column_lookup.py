"""Lookup of a column by header or number."""

import operator
from collections.abc import Sequence

from jointid.base.errors import InputError
from jointid.recording.signals import closest
from jointid.recording.table import Table

_SHOWN = 8  # headers listed in a message


def column_index(table: Table, column: object, argument: str) -> int:
    """Return the number of the column that a header or a number names.

    Parameters
    ----------
    table : Table
    column : object
        A header, in upper or lower case, or a 0-based column number.
    argument : str
        Name of the argument, for messages.

    Raises
    ------
    InputError
        There is no such column, or the header is not unique.
    """
    if isinstance(column, str):
        return _by_header(table, column, argument)
    if isinstance(column, bool) or not hasattr(column, "__index__"):
        raise InputError(
            "a header or a 0-based column number is expected", argument=argument, value=column
        )
    index = operator.index(column)
    if not 0 <= index < len(table.headers):
        raise InputError(
            f"the columns are 0 to {len(table.headers) - 1}",
            argument=argument,
            value=index,
            place=table.header_place,
        )
    return index


def _by_header(table: Table, header: str, argument: str) -> int:
    for same in (str.strip, lambda text: text.strip().casefold()):
        found = [k for k, each in enumerate(table.headers) if same(each) == same(header)]
        if len(found) == 1:
            return found[0]
        if found:
            raise InputError(
                f"columns {' and '.join(map(str, found))} have this header",
                argument=argument,
                value=header,
                place=table.header_place,
                remedy="give the number of the column",
            )
    if header in table.other_names:
        return table.other_names[header]
    close = closest(header, table.headers)
    raise InputError(
        "no such header",
        argument=argument,
        value=header,
        place=table.header_place,
        remedy=f"did you mean {close!r}" if close else f"headers are {listed(table.headers)}",
    )


def listed(headers: Sequence[str]) -> str:
    """Return the first eight headers as text for a message."""
    shown = ", ".join(repr(header[:60]) for header in headers[:_SHOWN])
    rest = len(headers) - _SHOWN
    return f"{shown} and {rest} more" if rest > 0 else shown
