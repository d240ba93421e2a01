"""A study's file of JSON lines. It grows with each finished trial, and a study can continue from it."""

from __future__ import annotations

import json
import os
import time
from collections.abc import Iterable
from contextlib import suppress
from pathlib import Path
from types import TracebackType
from typing import Any, Self

from jointid.base.advice import Action
from jointid.base.errors import InputError
from jointid.base.files import open_locked, sync_folder
from jointid.base.schema import read_bytes, read_json
from jointid.study.row import REFUSED, Row
from jointid.study.saved_header import EXPECTED, read_header

_SYNC = 1.0  # [s]; a loss of power costs at most this much work


_ANOTHER = Action("call", {"output": ...}, text="another file", function="sweep")


class StudyFile:
    """Rows on disk, written as trials finish. The first line identifies the study.

    Parameters
    ----------
    path : Path
    header : dict
        Header of the study. An existing file is continued only if it has the same "fingerprint".
    resume : bool
        Whether to continue an existing file. Otherwise an existing file is refused.

    Raises
    ------
    InputError
        The file exists, belongs to another study or is written by another program, or its folder does not exist.
    """

    def __init__(self, path: Path, header: dict[str, Any], *, resume: bool) -> None:
        self.path = path
        self.rows: list[Row] = []
        self._synced = 0.0
        if not path.parent.is_dir():
            raise InputError(
                f"the folder {path.parent} does not exist",
                argument="output",
                value=str(path),
                remedy="create it first",
            )
        if not resume:
            self._refuse_rows()  # without touching it
        self._file = open_locked(path)
        try:
            self._begin(header, resume)
            sync_folder(path.parent)
        except BaseException:
            self._file.close()
            raise

    def _refuse_rows(self) -> None:
        if self.path.exists() and self.path.stat().st_size > 0:
            raise InputError(
                "the file exists",
                argument="output",
                value=str(self.path),
                remedy=(
                    Action("call", {"resume": True}, text="to continue it", function="sweep"),
                    _ANOTHER,
                ),
            )

    def _begin(self, header: dict[str, Any], resume: bool) -> None:
        """Read the existing rows, and write the header if it is missing."""
        if not resume:
            self._refuse_rows()  # another program may have written the file meanwhile
        if self.path.stat().st_size > 0:
            known, self.rows, length = read(self.path)
            if known["fingerprint"] != header["fingerprint"]:
                raise InputError(
                    f"the file belongs to another study: {_difference(known, header)}",
                    argument="output",
                    place=str(self.path),
                    remedy=_ANOTHER,
                )
            os.ftruncate(self._file.fileno(), length)  # remove a line that a crash truncated
            self._file.seek(length)
            if known["trials"] == header["trials"]:
                return
        self._write([header])

    def append(self, rows: Iterable[Row]) -> None:
        """Write rows. After the return, a crash of this process cannot lose them."""
        rows = list(rows)
        self._write([row.asdict() for row in rows])
        self.rows += rows

    def _write(self, records: Iterable[dict[str, Any]]) -> None:
        lines = "".join(json.dumps(record, ensure_ascii=False) + "\n" for record in records)
        end = self._file.tell()
        rest = lines.encode()
        try:
            while rest:
                rest = rest[self._file.write(rest) :]
        except BaseException:  # a full disk stores part of a line: remove it
            with suppress(OSError):  # `FileIO.truncate` gives up when a signal interrupts it
                os.ftruncate(self._file.fileno(), end)
                self._file.seek(end)
            raise
        if time.monotonic() - self._synced > _SYNC:
            os.fsync(self._file.fileno())
            self._synced = time.monotonic()

    def __enter__(self) -> Self:
        """Return the file."""
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        """Write everything to the disk, and close the file."""
        try:
            os.fsync(self._file.fileno())
        finally:
            self._file.close()


def read(path: Path) -> tuple[dict[str, Any], list[Row], int]:
    """Return header, rows, and the number of bytes in complete lines.

    Raises
    ------
    InputError
        The file cannot be read, or is not a study.
    """
    try:
        content = read_bytes(path)
    except OSError as error:
        raise InputError(f"the study cannot be read: {error.strerror}", place=str(path)) from error
    length = content.rfind(b"\n") + 1
    header: dict[str, Any] | None = None
    rows: dict[tuple[int, int], Row] = {}
    first: dict[int, Row] = {}  # first row of each cell with results
    for number, line in enumerate(content[:length].split(b"\n")[:-1], 1):
        try:
            record = read_json(_text(line))
            if header is None or (isinstance(record, dict) and "format" in record):
                header = read_header(record, header)
            else:
                row = Row.of(record)
                check_row(row, header, first)
                rows.setdefault(row.place, row)
        except InputError as error:
            raise error.at(f"{path}, line {number}") from None
    if header is None:
        raise InputError(f"the file has no complete line; {EXPECTED}", place=str(path))
    return header, [rows[place] for place in sorted(rows)], length


def _text(line: bytes) -> str:
    try:
        return line.decode()
    except UnicodeDecodeError:
        raise InputError(f"this is not text in UTF-8; {EXPECTED}") from None


def check_row(row: Row, header: dict[str, Any], first: dict[int, Row]) -> None:
    """Refuse a row that belongs to no cell, or with other columns than the first row of its cell."""
    if row.cell >= len(header["cells"]):
        raise InputError(
            f"the study has {len(header['cells'])} cells", argument="cell", value=row.cell
        )
    if row.status == REFUSED:
        return
    other = first.setdefault(row.cell, row)
    for name in ("values", "tracking"):
        if getattr(row, name).keys() != getattr(other, name).keys():
            raise InputError(
                "this row has other names than the first row of the same cell", argument=name
            )


def _difference(known: dict[str, Any], wanted: dict[str, Any]) -> str:
    """Return the first difference between two headers."""
    for name, title in (
        ("version", "made by another version of jointid"),
        ("swept", "other swept settings"),
        ("cells", "other values of the grid"),
        ("seed", "another seed"),
    ):
        if known.get(name) != wanted[name]:
            return title
    for name, value in wanted["settings"].items():
        if known["settings"].get(name) != value:
            return f"another {name}"
    return "other values with the same labels"
