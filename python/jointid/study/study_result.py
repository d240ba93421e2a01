"""The result of a sweep: a row for every trial, as a table, a file, a summary."""

from __future__ import annotations

import os
from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from jointid.base.argument_checks import require_path
from jointid.base.errors import InputError
from jointid.base.frames import data_frame
from jointid.base.html import element
from jointid.joint.checks import suggestion
from jointid.study import study_file, tables
from jointid.study.row import Row
from jointid.study.saved_header import FORMAT, SCHEMA
from jointid.study.summary import Summary, html_summary, summarise

if TYPE_CHECKING:
    import pandas as pd


@dataclass(frozen=True, slots=True, kw_only=True, repr=False)
class Study:
    """Many identifications, one row each.

    Attributes
    ----------
    swept : tuple of str
        Names of the swept settings.
    cells : tuple of dict
        Their values, one combination each; long values by their labels.
    trials : int
        Requested number in each cell.
    seed : int
        Trial t has the seed `seed` + t.
    truth : dict of str to float
        Known true parameters [SI].
    truths : tuple of dict
        The same for each cell, if cells differ; else empty.
    rows : tuple of Row
        In the order of cells, then trials.
    settings : dict
        Recordings or scenario, joint, options and version, as a record.
    seconds : float
        Wall time; of a resumed study, that of the last part.

    Examples
    --------
    >>> study = jid.sweep(recording, joint, grid={"windows": [100, 400]}, trials=2)
    >>> len(study.rows), study.swept
    (4, ('windows',))
    """

    swept: tuple[str, ...]
    cells: tuple[dict[str, Any], ...]
    trials: int
    seed: int
    truth: dict[str, float]
    truths: tuple[dict[str, float], ...]
    rows: tuple[Row, ...]
    settings: dict[str, Any]
    seconds: float = 0.0

    @property
    def complete(self) -> bool:
        """Whether every trial is done."""
        return len(self.rows) >= len(self.cells) * self.trials

    @property
    def title(self) -> str:
        """What was swept, and how many trials are done, in a line."""
        done, cells = len(self.rows), len(self.cells)
        whole = "" if self.complete else f" of {cells * self.trials}"
        over = ", ".join(self.swept) or "nothing"
        return (
            f"study over {over}: {cells} cell{'s' * (cells != 1)}, "
            f"{done}{whole} trial{'s' * (done != 1 or bool(whole))}"
        )

    @property
    def parameters(self) -> tuple[str, ...]:
        """Names of the parameters of all rows."""
        return tables.parameters_of(self.rows)

    @property
    def columns(self) -> tuple[str, ...]:
        """Names of the table's columns."""
        return tuple(self._table())

    def column(self, name: str) -> NDArray[Any]:
        """Return one column of the table, shape (rows,).

        Raises
        ------
        InputError
            No such column.
        """
        table = self._table()
        if name not in table:
            raise InputError(
                f"the study has no such column; {suggestion(name, table)}",
                argument="name",
                value=name,
            )
        return np.array(table[name])

    def truth_of(self, cell: int) -> dict[str, float]:
        """Return the true parameters in a cell; they differ between cells if they are swept."""
        return self.truths[cell] if self.truths else self.truth

    def summary(self, *, within: float = 0.05) -> Summary:
        """Return mean, spread and, where the truth is known, bias and success of each cell.

        Parameters
        ----------
        within : float
            A trial succeeds if the relative error of each parameter is at most this. Default 0.05, as in
            the thesis.

        Raises
        ------
        InputError
            `within` is not above 0.
        """
        truths = [self.truth_of(cell) for cell in range(len(self.cells))]
        return summarise(self.cells, truths, self.rows, within)

    def to_pandas(self) -> pd.DataFrame:
        """Return the table as a data frame, one row per trial.

        Raises
        ------
        InputError
            pandas is not installed.
        """
        return data_frame(self._table())

    def save(self, path: str | os.PathLike[str]) -> None:
        """Write the table to .csv or .parquet, or the study itself to .jsonl; a failed write changes no file.

        Raises
        ------
        InputError
            Another extension, or the folder does not exist.
        """
        records = [header_of(self), *(row.asdict() for row in self.rows)]
        tables.save(self._table(), records, require_path("path", path))

    @staticmethod
    def load(path: str | os.PathLike[str]) -> Study:
        """Return the study of a .jsonl file, finished or not.

        Raises
        ------
        InputError
            The file cannot be read, or is not a study.
        """
        header, rows, _ = study_file.read(require_path("path", path))
        return study_of(header, rows)

    def _table(self) -> dict[str, list[Any]]:
        return tables.columns(self.swept, self.cells, self.rows)

    def __len__(self) -> int:
        return len(self.rows)

    def __str__(self) -> str:
        return str(self.summary())

    def __repr__(self) -> str:
        return f"<Study{self.title.removeprefix('study')}>"

    def _repr_html_(self) -> str:
        return str(
            element("div", element("b", f"jointid {self.title}"), html_summary(self.summary()))
        )


def study_of(header: Mapping[str, Any], rows: list[Row], seconds: float = 0.0) -> Study:
    """Return the study of a header and rows; of more trials than requested, the first ones."""
    wanted = sorted((r for r in rows if r.trial < header["trials"]), key=lambda row: row.place)
    return Study(
        swept=tuple(header["swept"]),
        cells=tuple(dict(cell) for cell in header["cells"]),
        trials=header["trials"],
        seed=header["seed"],
        truth=dict(header["truth"]),
        truths=tuple(dict(truth) for truth in header["truths"]),
        rows=tuple(wanted),
        settings=dict(header["settings"]),
        seconds=seconds,
    )


def header_of(study: Study, fingerprint: str = "") -> dict[str, Any]:
    """Return the first line of a study's file."""
    return {
        "format": FORMAT,
        "schema": SCHEMA,
        "version": study.settings.get("version", ""),
        "fingerprint": fingerprint or study.settings.get("fingerprint", ""),
        "swept": list(study.swept),
        "cells": list(study.cells),
        "trials": study.trials,
        "seed": study.seed,
        "truth": study.truth,
        "truths": list(study.truths),
        "settings": study.settings,
    }
