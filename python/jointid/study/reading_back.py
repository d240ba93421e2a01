"""Read a study from its JSON text."""

from __future__ import annotations

from typing import Any

from jointid.base.errors import InputError
from jointid.base.schema import ListOf, Unchecked, read_json
from jointid.study.row import Row
from jointid.study.saved_header import FORMAT, read_header
from jointid.study.study_file import check_row

_ROWS = ListOf(Unchecked())  # a row has its own reader


def read_study(text: str) -> tuple[dict[str, Any], list[Row]]:
    """Return header and rows of the study in a JSON text; see `Study.from_json`."""
    document = read_json(text)
    if not isinstance(document, dict) or document.get("format") != FORMAT:
        raise InputError(f"this JSON is not a study: its field 'format' is not '{FORMAT}'")
    records = _ROWS.read(document.pop("rows", None), "rows")
    header = read_header(document, None)
    header["cells"] = [
        {name: _label(label) for name, label in cell.items()} for cell in header["cells"]
    ]
    rows: dict[tuple[int, int], Row] = {}
    first: dict[int, Row] = {}  # first row of each cell with results
    for number, record in enumerate(records):
        try:
            row = Row.of(record)
            check_row(row, header, first)
        except InputError as error:
            raise error.at(f"rows[{number}]") from None
        rows.setdefault(row.place, row)
    return header, [rows[place] for place in sorted(rows)]


def _label(label: Any) -> Any:
    """Return a label of a cell. JSON has no number that is not finite."""
    return float(label) if label in ("inf", "-inf", "nan") else label
