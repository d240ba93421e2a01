"""Text logs that end in the middle of a line: it is left out and said, whatever separates the cells."""

import gzip
from pathlib import Path

import numpy as np
import pytest

import jointid as jid


def text(separator: str = ",", comma: bool = False, form: str = "{:.4f}", rows: int = 60) -> str:
    time = np.arange(rows) * 0.005
    values = np.column_stack([time, np.sin(4.0 * time) + 1.3, np.cos(4.0 * time) + 1.3])
    lines = [separator.join(form.format(value) for value in row) for row in values]
    if comma:
        lines = [line.replace(".", ",") for line in lines]
    return "\n".join([separator.join(("time_s", "position_rad", "torque_Nm")), *lines, ""])


@pytest.mark.parametrize(
    ("separator", "comma"), [(",", False), (";", True), ("\t", False), (" ", False)]
)
@pytest.mark.parametrize("lost", [4, 9, 16])  # within the last number, its neighbour, the stamp
def test_cut_line_is_left_out_and_said(
    tmp_path: Path, separator: str, comma: bool, lost: int
) -> None:
    path = tmp_path / "killed.csv"
    whole = text(separator, comma)
    path.write_text(whole[:-lost])
    loaded = jid.load(path)
    path.write_text(whole)
    assert loaded.time.tolist() == jid.load(path).time[:59].tolist()
    assert loaded.metadata["incomplete"] == "the last line is incomplete and left out"


def test_cut_line_may_end_in_a_newline_or_be_in_a_long_or_packed_file(tmp_path: Path) -> None:
    (tmp_path / "a.csv").write_text(text()[:-9] + "\n")
    (tmp_path / "b.csv").write_text(text(rows=60_000)[:-9])
    (tmp_path / "c.csv.gz").write_bytes(gzip.compress(text()[:-9].encode()))
    assert [len(jid.load(tmp_path / name)) for name in ("a.csv", "b.csv", "c.csv.gz")] == [
        *(59, 59_999, 59)
    ]


def test_whole_last_line_without_a_newline_stays(tmp_path: Path) -> None:
    for form in ("{:.4f}", "{:g}"):
        path = tmp_path / "whole.csv"
        path.write_text(text(form=form).rstrip("\n"))
        loaded = jid.load(path)
        assert len(loaded) == 60
        assert "incomplete" not in loaded.metadata


def test_short_line_further_up_is_still_refused(tmp_path: Path) -> None:
    path = tmp_path / "torn.csv"
    lines = text().splitlines()
    path.write_text("\n".join([*lines[:30], lines[30][:9], *lines[31:]]))
    with pytest.raises(jid.InputError, match="line 31: 2 cells, but 3 headers"):
        jid.load(path)
