"""A study as a tidy table: one row per trial, one column per quantity."""

from __future__ import annotations

import csv
import io
import json
import math
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any

from jointid.base.errors import InputError
from jointid.base.files import write_whole
from jointid.study.row import Row


def columns(
    swept: Sequence[str], cells: Sequence[Mapping[str, Any]], rows: Sequence[Row]
) -> dict[str, list[Any]]:
    """Return all columns: swept settings, trial, status, and all numbers."""
    table: dict[str, list[Any]] = {name: [cells[row.cell][name] for row in rows] for name in swept}
    for name in ("trial", "seed", "status", "penalty", "evaluations", "generations"):
        table[name] = [getattr(row, name) for row in rows]
    parameters = parameters_of(rows)
    for name in parameters:
        table[name] = [row.values.get(name, math.nan) for row in rows]
    if any(row.stderr for row in rows):
        for name in parameters:
            table[f"{name}_stderr"] = [row.stderr.get(name, math.nan) for row in rows]
    for name in ("before", "after", "true"):
        if any(row.tracking for row in rows):
            table[f"tracking_{name}"] = [row.tracking.get(name, math.nan) for row in rows]
    if any(row.status == "refused" for row in rows):
        table["message"] = [row.message for row in rows]
    return table


def parameters_of(rows: Sequence[Row]) -> tuple[str, ...]:
    """Return the names of the parameters of all rows."""
    return tuple({name: None for row in rows for name in row.values})


def save(
    table: Mapping[str, list[Any]], records: Sequence[Any], document: Callable[[], str], path: Path
) -> None:
    """Write a study's table, its records, or its JSON. The path's extension selects the form.

    Raises
    ------
    InputError
        The extension is unknown, or the folder does not exist.
    """
    if not path.parent.is_dir():
        raise InputError(
            f"the folder {path.parent} does not exist",
            argument="path",
            value=str(path),
            remedy="create it first",
        )
    writers = {
        ".csv": lambda: _csv(table),
        ".parquet": lambda: _parquet(table),
        ".jsonl": lambda: _lines(records),
        ".json": lambda: document().encode(),
    }
    if path.suffix not in writers:
        raise InputError(
            f"a study is saved as {', '.join(writers)}", argument="path", value=str(path)
        )
    write_whole(path, writers[path.suffix]())


def _csv(table: Mapping[str, list[Any]]) -> bytes:
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(table)
    for row in zip(*table.values(), strict=True):
        writer.writerow(["" if _missing(value) else _text(value) for value in row])
    return text.getvalue().encode()


def _missing(value: Any) -> bool:
    return value is None or (isinstance(value, float) and math.isnan(value))


def _text(value: Any) -> str:
    return repr(value) if isinstance(value, float) else str(value)


def _parquet(table: Mapping[str, list[Any]]) -> bytes:
    try:
        import pyarrow as pa
        import pyarrow.parquet as pq
    except ModuleNotFoundError as error:
        raise InputError(
            "Parquet files need the package pyarrow",
            remedy="pip install pyarrow",
        ) from error
    sink = pa.BufferOutputStream()
    mixed = {name: _one_kind(values) for name, values in table.items()}
    pq.write_table(pa.table(mixed), sink)
    return bytes(sink.getvalue())


def _one_kind(values: list[Any]) -> list[Any]:
    """Return values of one type. A column with labels of several types becomes text."""
    kinds = {type(value) for value in values if value is not None}
    if kinds <= {int, float} or len(kinds) < 2:
        return values
    return [None if value is None else str(value) for value in values]


def _lines(records: Sequence[Any]) -> bytes:
    return "".join(json.dumps(r, ensure_ascii=False) + "\n" for r in records).encode()
