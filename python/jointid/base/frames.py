"""Tables as data frames; pandas is imported only here, and only when needed."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

from jointid.base.errors import InputError

if TYPE_CHECKING:
    import pandas as pd


def data_frame(
    table: Mapping[str, Any] | Sequence[Mapping[str, Any]], *, index: str | list[str] | None = None
) -> pd.DataFrame:
    """Return a data frame of columns or records; the named columns become the index.

    Raises
    ------
    InputError
        pandas is not installed.
    """
    try:
        import pandas as pd
    except ModuleNotFoundError as error:
        raise InputError(
            "a data frame needs the package pandas",
            remedy="pip install pandas",
        ) from error
    frame = pd.DataFrame(table)
    return frame if index is None else frame.set_index(index)
