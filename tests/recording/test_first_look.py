"""What a file holds before anybody said what its columns are."""

from __future__ import annotations

from pathlib import Path

import pytest
from example_recordings import WELL_EXCITED

import jointid as jid
from jointid.recording.plausibility import range_remark
from jointid.recording.readers.table_preview import first_look


def written(path: Path, header: str, rows: int = 20) -> Path:
    lines = [
        ",".join(f"{k * (c + 1) / 100:.4f}" for c in range(header.count(",") + 1))
        for k in range(rows)
    ]
    path.write_text("\n".join([header, *lines]), encoding="utf-8")
    return path


def test_headers_that_say_enough_need_no_proposal() -> None:
    look = first_look(WELL_EXCITED)
    assert look.certain
    assert not look.problem
    assert {"time", "position", "velocity", "torque", "sensor"} == set(look.signals)
    position = look.columns[look.signals["position"]]
    assert position.unit == "rad"
    assert position.low == pytest.approx(-1.046, abs=0.01)


def test_words_of_headers_are_proposed(tmp_path: Path) -> None:
    look = first_look(written(tmp_path / "log.csv", "bench_clock,enc_link,drive_trq,ok"))
    assert not look.certain
    assert {name: look.columns[k].header for name, k in look.signals.items()} == {
        "time": "bench_clock",
        "position": "enc_link",
        "torque": "drive_trq",
    }
    assert look.units["position"] == "rad"


def test_what_has_no_proposal_says_why(tmp_path: Path) -> None:
    path = tmp_path / "log.csv"
    path.write_text("name,note\none,good\ntwo,bad\n", encoding="utf-8")
    look = first_look(path)
    assert look.problem
    assert [each.header for each in look.columns] == ["name", "note"]


def test_a_column_of_text_has_no_range(tmp_path: Path) -> None:
    path = tmp_path / "log.csv"
    path.write_text("time,position,note\n0,0,good\n1,1,bad\n", encoding="utf-8")
    assert first_look(path).columns[2].low is None


def test_what_cannot_be_read_is_refused(tmp_path: Path) -> None:
    with pytest.raises(jid.InputError):
        first_look(tmp_path / "log.exe")


@pytest.mark.parametrize(
    ("signal", "low", "high", "kind", "word"),
    [
        ("position", -3.0, 12.5, "revolute", ""),
        ("position", -3.0, 12.6, "revolute", "turns"),
        ("position", 0.0, 10.1, "prismatic", "millimetres"),
        ("velocity", -20.1, 3.0, "revolute", "rpm"),
        ("torque", -5001.0, 3.0, "revolute", "mN·m"),
        ("current", -1.0, 201.0, "revolute", "mA"),
        ("current", -1.0, 199.0, "revolute", ""),
        ("velocity", 0.0, 0.0, "revolute", "never changes"),
    ],
)
def test_what_is_odd_about_a_range(
    signal: str, low: float, high: float, kind: str, word: str
) -> None:
    remark = range_remark(signal, low, high, kind)
    assert (word in remark) if word else remark == ""


def test_a_motors_column_is_proposed_with_its_side(tmp_path: Path) -> None:
    path = tmp_path / "motor.csv"
    path.write_text("t_s,motor_position,tau_Nm\n0,1,2\n1,2,3\n", encoding="utf-8")
    seen = first_look(path)
    assert seen.signals["position"] == 1
    assert seen.side == {"position": "motor"}
