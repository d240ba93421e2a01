"""The commands of docs/hardware.md print what the page shows, and docs/first_motion.md has each code and option."""

import doctest
import re
import shlex
import shutil
from dataclasses import fields
from pathlib import Path

import pytest
from documents import ROOT, blocks, enter, read

from jointid.cli import main
from jointid.hardware.bench.first_motion_options import FirstMotionOptions
from jointid.hardware.proof.refusal import REASONS
from jointid.hardware.proof.result import UNCHECKED

PAGE = read("docs/first_motion.md")
SHOWN = [block.partition("\n") for block in blocks(read("docs/hardware.md"), "console")]
INVERTED = 3  # exit code of a bench that is refused


def test_the_path_shows_each_step() -> None:
    commands = [shlex.split(line)[1:3] for line, _, _ in SHOWN]
    assert [command for command, *_ in (words[1:] for words in commands)] != []
    names = [words[1] for words in commands]
    assert names == ["first-motion", "check", "first-motion", "first-motion", "run", "run"]


@pytest.mark.parametrize("number", range(len(SHOWN)))
def test_a_command_prints_what_is_shown(
    number: int,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    line, _, expected = SHOWN[number]
    prompt, program, *arguments = shlex.split(line)
    assert (prompt, program) == ("$", "jointid")
    shutil.copy(ROOT / "examples" / "hardware" / "joint.toml", tmp_path / "joint.toml")
    text = (tmp_path / "joint.toml").read_text(encoding="utf-8")
    wrong = text.replace("[session.emulated]", "[session.emulated]\nencoder_sign = -1", 1)
    (tmp_path / "inverted.toml").write_text(wrong, encoding="utf-8")
    enter(tmp_path, monkeypatch)
    code = main(arguments)
    assert code == (INVERTED if "inverted.toml" in arguments else 0)
    printed = capsys.readouterr().out
    shown = expected.rstrip("\n") + ("\n" if "REFUSED" not in expected else " ...\n")
    same = doctest.OutputChecker().check_output(
        shown, printed, doctest.ELLIPSIS | doctest.NORMALIZE_WHITESPACE
    )
    assert same, printed


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
