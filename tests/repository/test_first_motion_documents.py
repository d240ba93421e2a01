"""docs/hardware.md: its commands print what the page shows, its code runs, and it has each code of a refusal."""

import re
import shutil
from pathlib import Path

import pytest
from documents import ROOT, enter, read, run_console_blocks, run_python_blocks

from jointid.hardware.proof.refusal import REASONS
from jointid.hardware.proof.result import UNCHECKED

PAGE = read("docs/hardware.md")
STEPS = PAGE.partition("\n## 1. ")[2].partition("\n## Another drive")[0]
REFUSED = 3  # exit code


@pytest.mark.parametrize(
    "parsed",
    [
        ["first-motion", "--cycles", "first/initial.csv"],
        pytest.param([], marks=pytest.mark.slow),
    ],
    ids=["checks", "all"],
)
def test_the_steps_run_and_print_what_is_shown(
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
        STEPS, joint, capsys, codes={"inverted.toml": REFUSED}, parsed=parsed
    )
    first = ["first-motion", "check", "first-motion", "first-motion"]
    assert commands == ["edit", *first, "edit", "run", "run", "identify", "run"]


@pytest.mark.parametrize("code", REASONS)
def test_each_reason_is_on_the_page(code: str) -> None:
    assert f"\n| `{code}` |" in PAGE


@pytest.mark.slow
def test_the_code_on_the_page_runs(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    names = run_python_blocks(PAGE, tmp_path, monkeypatch)
    assert (tmp_path / "motion.png").is_file()
    assert names["online"].estimate.parameters["coulomb"].value > 0.0


def test_what_is_unchecked_is_explained_in_whole_sentences() -> None:
    assert all(len(text) > 20 for text in UNCHECKED.values())
    assert not re.search(r"\bTODO\b", PAGE)
