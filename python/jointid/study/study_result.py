"""What a sweep gives: a row for every trial, as a table, a file, a summary."""

from __future__ import annotations

import os
from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from jointid.base.argument_checks import require_path
from jointid.base.errors import InputError
from jointid.joint.checks import suggestion
from jointid.study import study_file, tables
from jointid.study.row import Row
from jointid.study.summary import Summary, summarise

if TYPE_CHECKING:
    import pandas as pd


@dataclass(frozen=True, slots=True, kw_only=True, repr=False)
class Study:
    """Many identifications, a row each.

    Attributes
    ----------
    swept : tuple of str
        Names of the swept settings.
    cells : tuple of dict
        Their values, one combination each; long values by their labels.
    trials : int
        Wanted of each cell.
    seed : int
        Trial t has the seed `seed` + t.
    truth : dict of str to float
        True parameters, as far as they are known [SI].
    truths : tuple of dict
        The same for each cell, where they differ; else empty.
    rows : tuple of Row
        In the order of cells, then trials.
    settings : dict
        What was identified, and how; for the record.
    seconds : float
        Wall time; of a study that went on, of the last part.
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
        """Whether every trial is there."""
        return len(self.rows) >= len(self.cells) * self.trials

    @property
    def parameters(self) -> tuple[str, ...]:
        """Names of all parameters that a row has."""
        names = {name: None for row in self.rows for name in row.values}
        return tuple(names)

    @property
    def columns(self) -> tuple[str, ...]:
        """Names of the table's columns."""
        return tuple(tables.columns(self))

    def column(self, name: str) -> NDArray[Any]:
        """One column of the table, shape (rows,).

        Raises
        ------
        InputError
            No such column.
        """
        table = tables.columns(self)
        if name not in table:
            raise InputError(
                f"the study has no such column; {suggestion(name, table)}",
                argument="name",
                value=name,
            )
        return np.array(table[name])

    def truth_of(self, cell: int) -> dict[str, float]:
        """True parameters in a cell: where they are swept, they differ."""
        return self.truths[cell] if self.truths else self.truth

    def summary(self, *, within: float = 0.05) -> Summary:
        """Mean, spread and, where the truth is known, bias and success of each cell.

        Parameters
        ----------
        within : float
            A trial succeeds when each parameter is this near to the truth, relatively. Default 0.05,
            the thesis's acceptance.
        """
        return summarise(self, within)

    def to_pandas(self) -> pd.DataFrame:
        """The table as a data frame, a row a trial.

        Raises
        ------
        InputError
            pandas is not installed: it comes with the extra `jointid[pandas]`.
        """
        return tables.data_frame(tables.columns(self))

    def save(self, path: str | os.PathLike[str]) -> None:
        """Write the table to .csv or .parquet, or the study itself to .jsonl, whole or not at all.

        Raises
        ------
        InputError
            Another extension, or the folder does not exist.
        """
        tables.save(self, require_path("path", path))

    @staticmethod
    def load(path: str | os.PathLike[str]) -> Study:
        """The study of a .jsonl file, whether it was finished or not.

        Raises
        ------
        InputError
            The file cannot be read, or is no study.
        """
        header, rows, _ = study_file.read(require_path("path", path))
        return study_of(header, rows)

    def __len__(self) -> int:
        return len(self.rows)

    def __str__(self) -> str:
        return str(self.summary())

    def __repr__(self) -> str:
        done = len(self.rows)
        whole = "" if self.complete else f" of {len(self.cells) * self.trials}"
        over = ", ".join(self.swept) or "nothing"
        return f"<Study over {over}: {len(self.cells)} cells, {done}{whole} trials>"

    def _repr_html_(self) -> str:
        return self.summary().to_html()


def study_of(header: Mapping[str, Any], rows: list[Row], seconds: float = 0.0) -> Study:
    """The study of a header and rows; of more trials than wanted, the first ones."""
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
    """The first line of a study's file."""
    return {
        "format": study_file.FORMAT,
        "schema": study_file.SCHEMA,
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
