"""The commands of docs/hardware.md print what the page shows, and docs/first_motion.md has each code and option."""

import doctest
import json
import re
import shlex
import shutil
import tomllib
from dataclasses import fields
from pathlib import Path

import pytest
from documents import ROOT, enter, read

from jointid.cli import main
from jointid.hardware.bench.first_motion_options import FirstMotionOptions
from jointid.hardware.proof.refusal import REASONS
from jointid.hardware.proof.result import UNCHECKED

PAGE = read("docs/first_motion.md")
PATH = read("docs/hardware.md").partition("\n## From an unpacked drive")[2].partition("\n## ")[0]
SHOWN = re.findall(r"^```(console|toml)\n(.*?)^```", PATH, re.DOTALL | re.MULTILINE)
REFUSED = 3  # exit code


def test_the_path_runs_and_prints_what_is_shown(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    shutil.copy(ROOT / "examples" / "hardware" / "joint.toml", tmp_path / "joint.toml")
    text = (tmp_path / "joint.toml").read_text(encoding="utf-8")
    wrong = text.replace("[session.emulated]", "[session.emulated]\nencoder_sign = -1", 1)
    (tmp_path / "inverted.toml").write_text(wrong, encoding="utf-8")
    enter(tmp_path, monkeypatch)
    commands = []
    for language, block in SHOWN:
        if language == "toml":
            commands.append("edit")
            _edit(tmp_path / "joint.toml", block)
            continue
        line, _, expected = block.partition("\n")
        prompt, program, *arguments = shlex.split(line)
        assert (prompt, program) == ("$", "jointid")
        commands.append(arguments[0])
        assert main(arguments) == (REFUSED if "inverted.toml" in arguments else 0)
        printed = capsys.readouterr().out
        # What a page leaves out at the end of a text is left out here.
        same = doctest.OutputChecker().check_output(
            f"{expected.rstrip()} ...\n",
            f"{printed} .\n",
            doctest.ELLIPSIS | doctest.NORMALIZE_WHITESPACE,
        )
        assert same, f"{line}\n{printed}"
    first = ["first-motion", "check", "first-motion", "first-motion"]
    assert commands == [*first, "edit", "run", "run", "identify", "run"]


def _edit(path: Path, block: str) -> None:
    """Give keys in a joint file the values that they have in a block of the page, as its reader does."""
    text = path.read_text(encoding="utf-8")
    for table, keys in tomllib.loads(block)["session"].items():
        begin, head, rest = text.partition(f"[session.{table}]")
        assert head, table
        inside, bracket, behind = rest.partition("\n[")
        for key, value in keys.items():
            line = f"{key} = {json.dumps(value)}"
            inside, found = re.subn(rf"^{key} = .*$", line, inside, flags=re.MULTILINE)
            if not found:
                inside += f"{line}\n"
        text = begin + head + inside + bracket + behind
    path.write_text(text, encoding="utf-8")


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
