"""Wrong command lines: one line, no Python in it, and advice that runs when it is pasted."""

import argparse
import re
import shlex
import tomllib
from pathlib import Path
from typing import Any

import pytest
from wrong_files import write_wrong_files

from jointid.cli.command_line import main
from jointid.cli.options import FLAGS, OPTIONS, PLACEHOLDERS, option_of
from jointid.cli.parser import command_parser

CORPUS: list[dict[str, Any]] = tomllib.loads(
    Path(__file__).with_name("wrong_command_lines.toml").read_text(encoding="utf-8")
)["lines"]
assert len(CORPUS) >= 100

PYTHON = re.compile(
    r"\{'|=\(|=\{|\['|\(\)|\b(?:True|False|None|argument|arguments|positional|keyword)\b"
    r"|\b(?:jid|jointid|_core)\.[A-Za-z]|<class|\bobject at 0x|\b[A-Z][a-z]+(?:[A-Z][a-z]+)+\b"
    r"|(?<![-\w=,:{} ])['\"]\w+['\"]=|Error\b|\bNOT_GIVEN\b"
)
# name=value that is no option's: a Python keyword. Options, and paths of a grid, stand behind `--…`.
KEYWORD = re.compile(r"(?:^|[\s(])([a-z_]+)=(?=[\w'\"({\[.,;)]|$)")
OPTION = re.compile(r"(--[a-z][a-z-]+)((?: (?!--|or\b|and\b|with\b)[^\s;,:)(]+)?)")
# In these options values of the form name=value stand.
NAMED = re.compile(r"--(?:column|unit|scale|where|set|gain|sensor|grid|trajectory|model) \S+")


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("wrong")
    write_wrong_files(path)
    return path


def answer(line: list[str], capsys: pytest.CaptureFixture[str]) -> tuple[int, str]:
    """Exit code and standard error."""
    try:
        code = main(line)
    except SystemExit as ended:  # the grammar's own refusals
        code = int(str(ended.code))
    return code, capsys.readouterr().err


def python_in(sentence: str) -> str:
    """What in a sentence is Python's, or nothing."""
    found = PYTHON.search(sentence) or KEYWORD.search(NAMED.sub("", sentence))
    return found[0] if found else ""


def commands() -> dict[str, argparse.ArgumentParser]:
    """The parsers by command."""
    (action,) = (
        each for each in command_parser()._actions if isinstance(each, argparse._SubParsersAction)
    )
    return dict(action.choices)


def advised(sentence: str, line: list[str], fill: dict[str, str]) -> list[list[str]]:
    """The alternatives that a sentence advises, each as the options to add."""
    alternatives = []
    for part in re.split(r" or |; |, ", sentence):
        options: list[str] = []
        for option, text in OPTION.findall(part):
            value = text.strip()
            typed = any(option == word for word in line) and (not value or value in line)
            if typed:  # the sentence repeats what was typed
                continue
            if not value and option not in FLAGS:
                value = fill.get(option, "")
            elif option in fill and value.isupper():
                value = fill[option]
            for placeholder in (*set(PLACEHOLDERS.values()), "JOINT", "NAME"):
                value = re.sub(rf"\b{placeholder}\b", fill.get(placeholder, placeholder), value)
            options += [option, *([value.strip("'")] if value else [])]
        if options:
            alternatives.append(options)
    return alternatives


@pytest.mark.parametrize("entry", CORPUS, ids=[entry["line"] for entry in CORPUS])
def test_a_wrong_command_line_is_answered_in_one_line(
    entry: dict[str, Any],
    folder: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    monkeypatch.chdir(folder)
    line = shlex.split(entry["line"])
    code, text = answer(line, capsys)
    assert code == 2, text
    assert text.count("\n") == 1, text
    assert entry["says"] in text
    assert len(text) < 450, "a sentence, not a dump"
    assert not python_in(text), (python_in(text), text)
    sentence = text.partition(": ")[2]
    if line[0] not in OPTIONS:
        return
    known = commands()[line[0]]._option_string_actions
    for option, _ in OPTION.findall(sentence):
        assert option in (*known, *line), f"{line[0]} has no {option}"
    alternatives = advised(sentence.partition("; see jointid")[0], line, entry.get("fill", {}))
    for options in alternatives:
        assert not re.search(r"\b[A-Z]{4,}\b", " ".join(options)), f"fill {options}"
        code, again = answer([*line, *options], capsys)
        assert again != text, options
        if entry.get("remedied"):
            assert code == 0, (options, again)
    assert alternatives or not entry.get("remedied"), f"no advice in: {text}"


@pytest.mark.parametrize("command", OPTIONS)
def test_every_option_of_the_table_exists(command: str) -> None:
    known = commands()[command]._option_string_actions
    for argument, option in OPTIONS[command].items():
        assert option in known, (command, argument)
        flag = known[option].nargs == 0
        assert not flag or option in FLAGS, option
        metavar = known[option].metavar
        assert (isinstance(metavar, str) and "=" in metavar and "[" not in metavar) == (
            option in PLACEHOLDERS
        ), option
        assert option_of(command, argument) == (option, "")


def test_every_command_is_in_the_table() -> None:
    assert OPTIONS.keys() == commands().keys()


@pytest.mark.parametrize(
    "sentence",
    [
        "load with columns={'velocity': None}",
        "use ripple=(2,)",
        "x must be True",
        "use jointid.Joint.load",
        "GaOptions is expected",
        "identify() got an unexpected keyword",
        "residual='sensor' needs a sensor",
        "go on with resume=",
        "(stderr=1)",
    ],
)
def test_the_detector_finds_python(sentence: str) -> None:
    assert python_in(sentence)


@pytest.mark.parametrize(
    "sentence",
    [
        "load with --column velocity=none or --unit position=deg --unit velocity=deg/s",
        "set vary = true under [parameters.inertia] in the joint file",
        "--trajectory sine:foo=3,bar=4: there is no foo",
        "'x' is not known; did you mean 'y'?",
    ],
)
def test_the_detector_passes_plain_sentences(sentence: str) -> None:
    assert not python_in(sentence)
