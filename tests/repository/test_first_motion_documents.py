"""The commands of docs/hardware.md print what the page shows, and docs/first_motion.md has each code and option."""

import re
import shutil
from dataclasses import fields
from pathlib import Path

import pytest
from documents import ROOT, enter, read, run_console_blocks

from jointid.hardware.bench.first_motion_options import FirstMotionOptions
from jointid.hardware.proof.refusal import REASONS
from jointid.hardware.proof.result import UNCHECKED

PAGE = read("docs/first_motion.md")
PATH = read("docs/hardware.md").partition("\n## From an unpacked drive")[2].partition("\n## ")[0]
REFUSED = 3  # exit code


@pytest.mark.parametrize(
    "parsed",
    [
        ["first-motion", "--cycles", "first/initial.csv"],
        pytest.param([], marks=pytest.mark.slow),
    ],
    ids=["checks", "all"],
)
def test_the_path_runs_and_prints_what_is_shown(
    parsed: list[str],
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    shutil.copy(ROOT / "examples" / "hardware" / "joint.toml", tmp_path / "joint.toml")
    text = (tmp_path / "joint.toml").read_text(encoding="utf-8")
    wrong = text.replace("[session.emulated]", "[session.emulated]\nencoder_sign = -1", 1)
    (tmp_path / "inverted.toml").write_text(wrong, encoding="utf-8")
    enter(tmp_path, monkeypatch)
    joint = tmp_path / "joint.toml"
    commands = run_console_blocks(
        PATH, joint, capsys, codes={"inverted.toml": REFUSED}, parsed=parsed
    )
    first = ["first-motion", "check", "first-motion", "first-motion"]
    assert commands == [*first, "edit", "run", "run", "identify", "run"]


@pytest.mark.parametrize("code", REASONS)
def test_each_reason_is_on_the_page(code: str) -> None:
    assert f"`{code}`" in PAGE


def test_each_option_is_on_the_page() -> None:
    rows = " ".join(line for line in PAGE.splitlines() if line.startswith("| `"))
    for field in fields(FirstMotionOptions):
        assert f"`{field.name}`" in rows, field.name


def test_what_is_unchecked_is_explained_in_whole_sentences() -> None:
    assert all(len(text) > 20 for text in UNCHECKED.values())
    assert not re.search(r"\bTODO\b", PAGE)
