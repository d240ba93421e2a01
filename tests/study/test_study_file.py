"""A study's file is continued: of a row that stands twice the first counts, and what a crash cut off goes."""

import copy
from pathlib import Path
from typing import Any

import pytest

import jointid as jid
from jointid.study.row import Row
from jointid.study.study_file import StudyFile, read

HEADER: dict[str, Any] = {
    "format": "jointid-study",
    "schema": 1,
    "version": "0.1.0",
    "swept": ["windows"],
    "cells": [{"windows": 50}, {"windows": 100}],
    "seed": 0,
    "settings": {},
    "fingerprint": "abc",
    "trials": 3,
    "truth": {},
    "truths": [],
}


def row(cell: int, trial: int, value: float) -> Row:
    values = {"coulomb": value}
    return Row(cell=cell, trial=trial, seed=trial, status="converged", penalty=1.0, values=values)


def written(path: Path, *rows: Row) -> Path:
    with StudyFile(path, HEADER, resume=False) as file:
        file.append(rows)
    return path


def test_of_a_row_that_stands_twice_the_first_counts(tmp_path: Path) -> None:
    path = written(tmp_path / "a.jsonl", row(0, 0, 1.0), row(0, 0, 2.0))
    _, rows, _ = read(path)
    assert [each.values for each in rows] == [{"coulomb": 1.0}]


def test_rows_come_in_the_order_of_the_cells(tmp_path: Path) -> None:
    path = written(tmp_path / "a.jsonl", row(1, 1, 3.0), row(0, 2, 2.0), row(0, 1, 1.0))
    _, rows, _ = read(path)
    assert [each.place for each in rows] == [(0, 1), (0, 2), (1, 1)]


def test_a_line_that_was_cut_off_goes_and_the_next_row_stands_whole(tmp_path: Path) -> None:
    path = written(tmp_path / "a.jsonl", row(0, 0, 1.0))
    whole = path.stat().st_size
    with path.open("ab") as file:
        file.write(b'{"cell": 0, "trial": 1, "seed": 1, "status": "conver')
    assert read(path)[2] == whole
    with StudyFile(path, HEADER, resume=True) as study:
        assert path.stat().st_size == whole
        study.append([row(0, 1, 2.0)])
    assert [each.place for each in read(path)[1]] == [(0, 0), (0, 1)]


def test_a_study_of_more_trials_says_so_once(tmp_path: Path) -> None:
    path = written(tmp_path / "a.jsonl", row(0, 0, 1.0))
    StudyFile(path, HEADER, resume=True).__exit__(None, None, None)
    lines = path.read_text().splitlines()
    assert sum('"format"' in line for line in lines) == 1
    more = copy.deepcopy(HEADER) | {"trials": 5}
    StudyFile(path, more, resume=True).__exit__(None, None, None)
    assert read(path)[0]["trials"] == 5
    assert len(path.read_text().splitlines()) == len(lines) + 1


def test_another_study_is_refused(tmp_path: Path) -> None:
    path = written(tmp_path / "a.jsonl", row(0, 0, 1.0))
    other = copy.deepcopy(HEADER) | {"fingerprint": "xyz", "seed": 1}
    with pytest.raises(jid.InputError, match="belongs to another study: another seed"):
        StudyFile(path, other, resume=True)


def test_a_row_of_no_cell_is_refused(tmp_path: Path) -> None:
    path = written(tmp_path / "a.jsonl", row(2, 0, 1.0))
    with pytest.raises(jid.InputError, match="line 2: cell is 2: the study has 2 cells"):
        read(path)


def test_a_row_with_other_columns_than_its_cell_is_refused(tmp_path: Path) -> None:
    other = Row(cell=0, trial=1, seed=1, status="converged", penalty=1.0, values={"viscous": 1.0})
    path = written(tmp_path / "a.jsonl", row(0, 0, 1.0), other)
    with pytest.raises(jid.InputError, match="this row has other names"):
        read(path)
