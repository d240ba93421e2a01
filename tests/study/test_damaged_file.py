"""A study's file that was damaged: one sentence with the line, whatever the damage."""

import json
import math
from pathlib import Path
from typing import Any

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

import jointid as jid
from jointid.study import study_file
from jointid.study.row import Row

HEADER: dict[str, Any] = {
    "format": "jointid-study",
    "schema": 1,
    "version": "0.1.0",
    "swept": ["windows"],
    "cells": [{"windows": 50}, {"windows": 100}],
    "seed": 0,
    "settings": {"version": "0.1.0", "joint": "Joint()", "fingerprint": "abc"},
    "fingerprint": "abc",
    "trials": 2,
    "truth": {},
    "truths": [],
}
ROWS = [
    Row(cell=0, trial=0, seed=0, status="converged", penalty=1.5, values={"coulomb": 2.0}).asdict(),
    Row(cell=0, trial=1, seed=1, status="converged", penalty=1.5, values={"coulomb": 2.5}).asdict(),
    Row(cell=1, trial=0, seed=0, status="refused", message="too few").asdict(),
]
JUNK = st.sampled_from(
    [None, True, 7, -1, 1.5, "x", "\ud800", [], [1], {}, {"a": "b"}, 10**400, math.inf, math.nan]
)


def write(path: Path, *lines: object) -> None:
    texts = (line if isinstance(line, str) else json.dumps(line) for line in lines)
    path.write_text("".join(f"{text}\n" for text in texts))


def test_rows_without_a_penalty_are_read(tmp_path: Path) -> None:
    path = tmp_path / "a.jsonl"
    write(path, HEADER | {"future": 1}, *ROWS)
    study = jid.Study.load(path)
    assert math.isnan(study.rows[2].penalty)
    assert [row.asdict() for row in study.rows[:2]] == ROWS[:2]
    assert study.summary().cells[0].mean == {"coulomb": 2.25}


BAD_HEADERS = [
    {"settings": None},
    {"cells": 7},
    {"cells": [7]},
    {"cells": [{"other": 1}]},
    {"trials": 0},
    {"trials": math.inf},
    {"truth": 3},
    {"truths": [{}]},
    {"seed": "1"},
    {"swept": None},
    {"schema": 2},
]
BAD_ROWS = [
    {"cell": 7},
    {"cell": -1},
    {"cell": math.inf},
    {"seed": 10**400},
    {"penalty": 10**400},
    {"penalty": "1"},
    {"values": {"viscous": 1.0}},
    {"values": None},
    {"values": {"coulomb": math.inf}},
    {"penalty": -math.inf},
    {"status": 3},
]


@pytest.mark.parametrize("change", BAD_HEADERS, ids=repr)
def test_a_damaged_header_is_one_sentence(change: dict[str, Any], tmp_path: Path) -> None:
    path = tmp_path / "a.jsonl"
    write(path, HEADER | change, *ROWS)
    with pytest.raises(jid.InputError, match=rf"a\.jsonl, line 1.*{next(iter(change))}"):
        jid.Study.load(path)
    with pytest.raises(jid.InputError, match=r"a\.jsonl, line 1"):
        study_file.StudyFile(path, HEADER, resume=True)


@pytest.mark.parametrize("change", BAD_ROWS, ids=lambda change: repr(change)[:30])
def test_a_damaged_row_is_one_sentence(change: dict[str, Any], tmp_path: Path) -> None:
    path = tmp_path / "a.jsonl"
    write(path, HEADER, ROWS[0], ROWS[1] | change)
    with pytest.raises(jid.InputError, match=rf"a\.jsonl, line 3.*{next(iter(change))}"):
        jid.Study.load(path)


@pytest.mark.parametrize(
    "line",
    ["[" * 100_000, "7", "null", '{"cell": 1e999}', "\x00", "1" * 5000],
    ids=lambda line: line[:10],
)
@pytest.mark.parametrize("number", [1, 2])
def test_a_line_of_something_else(line: str, number: int, tmp_path: Path) -> None:
    path = tmp_path / "a.jsonl"
    write(path, *([HEADER] if number == 2 else []), line, *ROWS)
    with pytest.raises(jid.InputError, match=rf"a\.jsonl, line {number}"):
        jid.Study.load(path)


def test_a_second_header_belongs_to_the_same_study(tmp_path: Path) -> None:
    path = tmp_path / "a.jsonl"
    write(path, HEADER, *ROWS, HEADER | {"trials": 5})
    assert jid.Study.load(path).trials == 5
    write(path, HEADER, *ROWS, HEADER | {"cells": HEADER["cells"][:1]})
    with pytest.raises(jid.InputError, match=r"line 5: cells: this field differs"):
        jid.Study.load(path)


@settings(max_examples=300, suppress_health_check=list(HealthCheck), deadline=None)
@given(number=st.integers(0, 3), data=st.data())
def test_any_damage_is_read_or_refused(number: int, data: st.DataObject, tmp_path: Path) -> None:
    """A value that is replaced or removed, anywhere in a line."""
    lines = [json.loads(json.dumps(each)) for each in (HEADER, *ROWS)]
    where = lines[number]
    key = data.draw(st.sampled_from(sorted(where)))
    while isinstance(where[key], dict) and where[key] and data.draw(st.booleans()):
        where = where[key]
        key = data.draw(st.sampled_from(sorted(where)))
    if data.draw(st.booleans()):
        where[key] = data.draw(JUNK)
    else:
        del where[key]
    path = tmp_path / "a.jsonl"
    write(path, *lines)
    refusal = ""
    try:
        study = jid.Study.load(path)
    except jid.InputError as error:
        refusal = str(error)
    if refusal:
        assert refusal.startswith(f"{path}, line ")
        return
    str(study)
    study.summary().asdict()
    study.save(tmp_path / "b.csv")
    study.save(tmp_path / "b.jsonl")
