"""Two sweeps on one file: the second is refused in one sentence, and nothing is lost."""

import json
import subprocess
import sys
from pathlib import Path

import pytest

import jointid as jid
from jointid.study.row import Row
from jointid.study.study_file import StudyFile

_HEADER = {
    "format": "jointid-study",
    "schema": 1,
    "version": "0.1.0",
    "swept": ["windows"],
    "cells": [{"windows": 50}],
    "seed": 0,
    "settings": {},
    "fingerprint": "abc",
    "trials": 2,
    "truth": {},
    "truths": [],
}
_ROW = Row(cell=0, trial=0, seed=0, status="refused", message="too few")
_OTHER = """
import json, sys
from pathlib import Path
from jointid.study.study_file import StudyFile
with StudyFile(Path(sys.argv[1]), json.loads(sys.argv[2]), resume=True):
    print("open", flush=True)
    sys.stdin.read()
"""


@pytest.mark.skipif(sys.platform == "win32", reason="files are not locked there")
def test_a_file_that_another_program_writes_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "study.jsonl"
    with StudyFile(path, _HEADER, resume=False) as file:
        file.append([_ROW])
        with pytest.raises(jid.InputError, match=r"study\.jsonl: another program is writing"):
            StudyFile(path, _HEADER, resume=True)
    other = subprocess.Popen(
        [sys.executable, "-c", _OTHER, str(path), json.dumps(_HEADER)],
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        text=True,
    )
    try:
        assert other.stdout is not None
        assert other.stdout.readline() == "open\n"
        before = path.read_bytes()
        with pytest.raises(jid.InputError, match="another program is writing"):
            StudyFile(path, _HEADER, resume=True)
        assert path.read_bytes() == before
    finally:
        other.kill()  # a lock does not outlive its program
        other.communicate()
    with StudyFile(path, _HEADER, resume=True) as file:
        assert [row.trial for row in file.rows] == [0]


def test_a_refused_file_is_left_as_it_is(tmp_path: Path) -> None:
    """And open to others: what is refused keeps no lock."""
    path = tmp_path / "study.jsonl"
    path.write_text("something else\n", encoding="utf-8")
    for resume in (True, False):
        with pytest.raises(jid.InputError):
            StudyFile(path, _HEADER, resume=resume)
    assert path.read_text(encoding="utf-8") == "something else\n"
    path.write_text("", encoding="utf-8")
    with StudyFile(path, _HEADER, resume=False):
        pass
