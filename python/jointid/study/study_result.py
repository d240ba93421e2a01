"""The result of a sweep: one row per trial, as a table, a file and a summary."""

from __future__ import annotations

import os
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from jointid.base.argument_checks import require_path
from jointid.base.error_text import printable
from jointid.base.errors import InputError
from jointid.base.frames import data_frame
from jointid.base.json_layout import json_text, json_types
from jointid.base.result import KeptResult, Overview, require_text
from jointid.joint.checks import suggestion
from jointid.study import study_file, tables
from jointid.study.row import Row
from jointid.study.saved_header import FORMAT, KIND, SCHEMA
from jointid.study.summary import Summary, summarise

if TYPE_CHECKING:
    import pandas as pd


@dataclass(frozen=True, slots=True, kw_only=True, repr=False)
class Study(KeptResult):
    """Result of a sweep, with one row for each identification.

    Attributes
    ----------
    swept : tuple of str
        Names of the swept settings.
    cells : tuple of dict
        Combinations of the swept settings, as mappings from setting to value. Labels replace long values.
    trials : int
        Requested number of trials in each cell.
    seed : int
        Seed of the first trial; trial t has the seed `seed` + t.
    truth : dict of str to float
        Known true parameters [SI].
    truths : tuple of dict
        Known true parameters of each cell, if cells differ; otherwise empty.
    rows : tuple of Row
        One row for each trial, ordered by cell and then by trial.
    settings : dict
        Description of recordings or scenario, joint, options and version.
    seconds : float
        Wall time [s]; for a resumed study, only of the last run.

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

    _KIND = "study"

    @property
    def complete(self) -> bool:
        """Whether every trial is finished."""
        return len(self.rows) >= len(self.cells) * self.trials

    @property
    def title(self) -> str:
        """Title line with the swept settings and the number of finished trials."""
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
            The column does not exist.
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
        """Return the true parameters of a cell. Cells differ if true parameters are swept."""
        return self.truths[cell] if self.truths else self.truth

    def summary(self, *, within: float = 0.05) -> Summary:
        """Return mean and spread of each cell; with known true parameters, also bias and success.

        Parameters
        ----------
        within : float
            Largest relative error of each parameter in a successful trial. Default 0.05, as in the thesis.

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

    @property
    def overview(self) -> Overview:
        """Summary for a report page."""
        from jointid.study.overview import overview_of

        seeds = range(self.seed, self.seed + max(self.trials, 1))
        missing = len(self.cells) * self.trials - len(self.rows)
        return overview_of(self.title, self.summary(), self.settings, seeds, missing)

    def report(self, *, verbose: bool = False) -> str:
        """Return the title and the summary of the cells as text.

        Parameters
        ----------
        verbose : bool
            Whether to return all cells. Default False: only the best ten cells.
        """
        summary = self.summary()
        text = summary.text(len(self.cells)) if verbose else str(summary)
        return printable(f"{self.title}\n\n{text}")

    def to_dict(self) -> dict[str, Any]:
        """Return header and rows of the study in JSON types. A number that is not finite becomes a text."""
        rows = [row.asdict() for row in self.rows]
        document: dict[str, Any] = json_types({"kind": KIND, **header_of(self), "rows": rows})
        return document

    document = to_dict

    def to_json(self) -> str:
        """Return `to_dict` as JSON text; `from_json` reads the text."""
        return json_text(self.to_dict())

    @classmethod
    def from_json(cls, text: str) -> Study:
        """Return the study from a JSON text.

        Parameters
        ----------
        text : str
            JSON text from `to_json`.

        Raises
        ------
        InputError
            The text is not JSON, is not a study, has another schema, or has an invalid value. The message shows the
            place in the text.
        """
        from jointid.study.reading_back import read_study

        header, rows = read_study(require_text(text))
        return study_of(header, rows)

    def save(self, path: str | os.PathLike[str]) -> Path:
        """Write the table to .csv or .parquet, or the study to .jsonl or .json.

        If writing fails, an existing file is unchanged.

        Returns
        -------
        Path
            Path of the file.

        Raises
        ------
        InputError
            The file name has another ending, or the folder does not exist.
        """
        file = require_path("path", path)
        records = [header_of(self), *(row.asdict() for row in self.rows)]
        tables.save(self._table(), records, self.to_json, file)
        return file

    @classmethod
    def load(cls, path: str | os.PathLike[str]) -> Study:
        """Return the study from a .jsonl or .json file, finished or not.

        Raises
        ------
        InputError
            The file cannot be read, or is not a study.
        """
        file = require_path("path", path)
        if file.suffix == ".json":
            return super(Study, cls).load(file)
        header, rows, _ = study_file.read(file)
        return study_of(header, rows)

    def _table(self) -> dict[str, list[Any]]:
        return tables.columns(self.swept, self.cells, self.rows)

    def __len__(self) -> int:
        return len(self.rows)

    def __str__(self) -> str:
        return str(self.summary())

    def __repr__(self) -> str:
        return f"<Study{self.title.removeprefix('study')}>"


def study_of(header: Mapping[str, Any], rows: list[Row], seconds: float = 0.0) -> Study:
    """Return the study of a header and rows. If there are more trials than requested, use the first ones."""
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
