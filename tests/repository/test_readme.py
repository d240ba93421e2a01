"""README.md is short, and what it prints is what the program prints."""

import re
from pathlib import Path

import pytest
from documents import ROOT, read, run_python_blocks
from example_recordings import WELL_EXCITED

import jointid as jid

README = read("README.md")
NUMBER = re.compile(r"-?\d+(?:\.\d+)?")


def test_it_is_one_screen_and_a_table_of_links() -> None:
    assert (ROOT / "README.md").stat().st_size <= 8192


def test_the_first_table_is_what_identify_reports() -> None:
    recording = jid.load(WELL_EXCITED)
    printed = {
        line.split()[0]: line
        for line in jid.identify(recording, jid.thesis_joint()).report().splitlines()
        if line
    }
    start = README.index("parameter  ")
    table = README[start : README.index("```", start)].strip().splitlines()
    assert len(table) == 11
    for line in table[2:]:
        shown, found = (
            [float(number) for number in NUMBER.findall(text)]
            for text in (line, printed[line.split()[0]])
        )
        assert shown == pytest.approx(found, rel=0.02), line
        assert shown[0] == pytest.approx(found[0], rel=1e-5), line


def test_its_blocks_run(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    names = run_python_blocks(README, tmp_path, monkeypatch)
    assert names["estimate"].status == "converged"
    assert (tmp_path / "joint.toml").is_file()


def test_it_says_that_no_real_drive_was_tried() -> None:
    assert "never on real hardware" in " ".join(README.split())
