"""README.md is short, and its numbers are those that the program prints."""

import json
import re
import runpy
from pathlib import Path

import pytest
from documents import ROOT, read, run_python_blocks

import jointid as jid

README = read("README.md")
NUMBER = re.compile(r"-?\d+(?:\.\d+)?")


def test_it_is_a_screen_and_a_half() -> None:
    assert len(README.split()) <= 700
    assert README.index("make demo") < README.index("make test") < README.index("## Your log")


def test_its_answer_is_what_identify_prints() -> None:
    kuka = jid.demo()
    printed = jid.identify(kuka.recording, kuka.joint).report().splitlines()
    start = README.index(printed[0])
    answer = README[start : README.index("```", start)].strip().splitlines()
    assert len(answer) == 6
    for line, found in zip(answer, printed, strict=False):
        assert re.sub(NUMBER, "#", line) == re.sub(NUMBER, "#", found)
        numbers, others = ([float(n) for n in NUMBER.findall(text)] for text in (line, found))
        assert numbers == pytest.approx(others, rel=0.02)


def test_the_published_values_are_those_of_the_demo() -> None:
    for name, value in jid.demo().published.items():
        assert f"{value:.0f} for {name}" in README or f"{value:.0f} for {name.title()}" in README


def test_its_blocks_run(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    names = run_python_blocks(README, tmp_path, monkeypatch)
    assert names["estimate"].status == "converged"
    assert (tmp_path / "joint.toml").is_file()


def test_it_says_that_no_real_drive_was_tried() -> None:
    assert "Never tried on real hardware" in README


def test_its_picture_shows_what_is_identified_now() -> None:
    drawn = json.loads(read("docs/pictures/friction_maps.json"))
    script = runpy.run_path(str(ROOT / "tools" / "pictures.py"))
    found = {title: script["numbers"](each) for title, each in script["estimates"]().items()}
    assert found.keys() == drawn.keys()
    for title, rows in found.items():
        for row, shown in zip(rows, drawn[title], strict=True):
            assert row == pytest.approx(shown, rel=0.01), title
