"""A study's file: JSON lines that grow while trials are done, and from which a study goes on."""

from __future__ import annotations

import json
import os
import time
from collections.abc import Iterable
from pathlib import Path
from types import TracebackType
from typing import Any, Self

from jointid.base.errors import InputError
from jointid.study.row import Row

FORMAT = "jointid-study"
SCHEMA = 1

_SYNC = 1.0  # [s] of work that a loss of power may take, at most


class StudyFile:
    """Rows on disk as they come; the first line says of which study.

    Parameters
    ----------
    path : Path
    header : dict
        What the rows belong to; its "fingerprint" decides whether a file may be gone on with.
    resume : bool
        Go on with an existing file; without it, an existing file is refused.

    Raises
    ------
    InputError
        The file exists, or is of another study, or cannot be written.
    """

    def __init__(self, path: Path, header: dict[str, Any], *, resume: bool) -> None:
        self.path = path
        self.rows: list[Row] = []
        self._synced = 0.0
        if path.exists() and path.stat().st_size > 0:
            if not resume:
                raise InputError(
                    f"{path} exists; go on with it by resume=True, or give another output="
                )
            known, self.rows, length = read(path)
            if known["fingerprint"] != header["fingerprint"]:
                raise InputError(
                    f"{path} is of another study ({_difference(known, header)}); give another output="
                )
            self._file = path.open("r+b")
            self._file.truncate(length)  # a line that a crash cut off
            self._file.seek(length)
            if known["trials"] == header["trials"]:
                return
        else:
            if not path.parent.is_dir():
                raise InputError(f"output {path}: the folder {path.parent} does not exist")
            self._file = path.open("w+b")
        self._write([header])

    def append(self, rows: Iterable[Row]) -> None:
        """Keep rows; what was given is safe from a crash of this process at once."""
        rows = list(rows)
        self._write([row.asdict() for row in rows])
        self.rows += rows

    def _write(self, records: Iterable[dict[str, Any]]) -> None:
        self._file.write(
            "".join(json.dumps(record, ensure_ascii=False) + "\n" for record in records).encode()
        )
        self._file.flush()
        if time.monotonic() - self._synced > _SYNC:
            os.fsync(self._file.fileno())
            self._synced = time.monotonic()

    def __enter__(self) -> Self:
        """The file."""
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        """Close it, with everything on disk."""
        self._file.flush()
        os.fsync(self._file.fileno())
        self._file.close()


def read(path: Path) -> tuple[dict[str, Any], list[Row], int]:
    """Header, rows and how many bytes of the file are whole lines.

    Raises
    ------
    InputError
        The file cannot be read, or is no study.
    """
    try:
        content = path.read_bytes()
    except OSError as error:
        raise InputError(f"{path}: the study cannot be read: {error.strerror}") from error
    length = content.rfind(b"\n") + 1
    header: dict[str, Any] | None = None
    rows: dict[tuple[int, int], Row] = {}
    for number, line in enumerate(content[:length].split(b"\n")[:-1], 1):
        try:
            record = json.loads(line)
            if isinstance(record, dict) and record.get("format") == FORMAT:
                header = _checked(path, record)
            else:
                row = Row.of(record)
                rows.setdefault(row.place, row)
        except (ValueError, TypeError, KeyError, AttributeError) as error:
            if isinstance(error, InputError):
                raise
            raise InputError(
                f"{path}: line {number} is of no study; a file that sweep(output=...) wrote is expected"
            ) from error
        if header is None:
            raise InputError(
                f"{path}: line 1 is not a study's first; a file that sweep(output=...) wrote is expected"
            )
    if header is None:
        raise InputError(f"{path}: this holds no study, not even its first line")
    return header, [rows[place] for place in sorted(rows)], length


def _checked(path: Path, header: dict[str, Any]) -> dict[str, Any]:
    if header.get("schema") != SCHEMA:
        raise InputError(
            f"{path}: its schema is {header.get('schema')!r}; this version of jointid reads {SCHEMA}"
        )
    for name in ("fingerprint", "trials", "seed", "cells", "swept", "truth", "truths", "settings"):
        header[name]
    return header


def _difference(known: dict[str, Any], wanted: dict[str, Any]) -> str:
    """The first thing in which two headers differ."""
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
    return "other values behind the same labels"
