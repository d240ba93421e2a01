"""Reading the project's documents, and running what stands in them."""

import doctest
import re
import shlex
from collections.abc import Collection, Mapping
from pathlib import Path
from typing import Any

import pytest

from jointid.cli import main
from jointid.cli.parser import command_parser

ROOT = Path(__file__).resolve().parents[1]


def read(name: str) -> str:
    """The text of a document, named from the repository's root."""
    return (ROOT / name).read_text(encoding="utf-8")


def blocks(text: str, language: str) -> list[str]:
    """The fenced blocks of one language, in order."""
    return re.findall(rf"^```{language}\n(.*?)^```", text, re.DOTALL | re.MULTILINE)


def enter(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Make an empty folder look like the repository to a reader's code, which may write there."""
    (folder / "examples").symlink_to(ROOT / "examples")
    monkeypatch.chdir(folder)


def run_python_blocks(text: str, folder: Path, monkeypatch: pytest.MonkeyPatch) -> dict[str, Any]:
    """Run a document's Python blocks one after the other in one namespace, and return it."""
    pyplot = pytest.importorskip("matplotlib.pyplot")
    enter(folder, monkeypatch)
    found = blocks(text, "python")
    names: dict[str, Any] = {}
    assert found
    try:
        for block in found:
            exec(compile(block, "document", "exec"), names)
    finally:
        pyplot.close("all")
    return names


def run_console_blocks(
    text: str,
    joint: Path,
    capsys: pytest.CaptureFixture[str],
    *,
    codes: Mapping[str, int] | None = None,
    whole: bool = False,
    within: float = 0.0,
    parsed: Collection[str] = (),
) -> list[str]:
    """Run a page's console blocks in the working folder, and compare what they print with what the page shows.

    Parameters
    ----------
    joint : Path
        The joint file that a toml block between them edits.
    codes : mapping of str to int, optional
        Exit code of a command line that has this word. Default: 0 for all.
    whole : bool
        Whether a toml block replaces tables, not only keys. Default False.
    within : float
        By which share a printed number may differ from the page's. Default: digit by digit the same.
    parsed : collection of str, optional
        A command line that has one of these words is parsed, and not run.

    Returns
    -------
    list of str
        The commands, and "edit" for a toml block.
    """
    commands = []
    shown = re.findall(r"^```(console|toml)\n(.*?)^```", text, re.DOTALL | re.MULTILINE)
    for language, block in shown:
        if language == "toml":
            commands.append("edit")
            _edit(joint, block, whole=whole)
            continue
        line, _, expected = block.partition("\n")
        prompt, program, *arguments = shlex.split(line)
        assert (prompt, program) == ("$", "jointid")
        commands.append(arguments[0])
        if set(arguments) & {*parsed}:
            command_parser().parse_args(arguments)
            continue
        wanted = [code for word, code in (codes or {}).items() if word in arguments]
        assert main(arguments) == (wanted or [0])[0]
        printed = capsys.readouterr().out
        same = same_text(expected, printed, within)
        assert same, f"{line}\n{printed}"
    return commands


def parsed_commands(text: str) -> list[str]:
    """Parse the commands in a page's sh blocks and in its sentences, and return their names."""
    lines = "".join(blocks(text, "sh")).replace("\\\n", " ").splitlines()
    lines += re.findall(r"`(jointid [^`]+)`", text)
    given = [shlex.split(each, comments=True) for each in lines if "…" not in each]
    commands = [words[1:] for words in given if words[:1] == ["jointid"]]
    for words in commands:
        assert command_parser().parse_args(words).command == words[0], words
    return [words[0] for words in commands]


_NUMBER = re.compile(r"(?<![\w.])-?\d+(?:\.\d+)?(?![\w]|\.\d)")


def same_text(expected: str, printed: str, within: float) -> bool:
    """Whether a text is what a page shows; what the page leaves out at the end is left out."""
    if not within:
        return doctest.OutputChecker().check_output(
            f"{expected.rstrip()} ...\n",
            f"{printed} .\n",
            doctest.ELLIPSIS | doctest.NORMALIZE_WHITESPACE,
        )
    # Widths of columns, and so the lengths of their rules, are those of the numbers.
    expected, printed = (re.sub(r"-{3,}", "---", text) for text in (expected, printed))
    wanted = [float(text) for text in _NUMBER.findall(expected)]
    pattern = re.escape(_NUMBER.sub("§", " ".join(expected.split())))
    pattern = pattern.replace(r"\.\.\.", ".*?").replace("§", f"({_NUMBER.pattern})")
    found = re.match(pattern, " ".join(printed.split()))
    return found is not None and all(
        abs(float(text) - number) <= within * abs(number) + 1e-9
        for text, number in zip(found.groups(), wanted, strict=True)
    )


def _edit(path: Path, block: str, *, whole: bool) -> None:
    """Change a joint file as a page's reader does: tables as in the block, or only the keys that it has."""
    text = path.read_text(encoding="utf-8")
    for table, keys in re.findall(r"^\[(.+)\]\n((?:[^\[\n].*\n)*)", block, re.MULTILINE):
        begin, head, rest = text.partition(f"[{table}]")
        assert head, table
        inside, bracket, behind = rest.partition("\n[")
        if whole:
            inside = f"\n{keys}"
        for line in [] if whole else keys.splitlines():
            key = line.partition(" = ")[0]
            inside, found = re.subn(rf"^{key} = .*$", line, inside, flags=re.MULTILINE)
            if not found:
                inside += f"{line}\n"
        text = begin + head + inside + bracket + behind
    path.write_text(text, encoding="utf-8")
