"""Wrong command lines: one line, no Python in it, and advice that runs when it is pasted."""

import re
import shlex
import tomllib
from pathlib import Path
from typing import Any

import pytest
from command_line_answers import OPTION, advised, answer, commands, obeyed, python_in
from wrong_files import write_wrong_files

from jointid.cli.command_line import main
from jointid.cli.options import FILES, FLAGS, OPTIONS, PLACEHOLDERS, option_of

CORPUS: list[dict[str, Any]] = tomllib.loads(
    Path(__file__).with_name("wrong_command_lines.toml").read_text(encoding="utf-8")
)["lines"]
assert len(CORPUS) >= 100


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("wrong")
    write_wrong_files(path)
    return path


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
        code, again = answer(obeyed(line, options), capsys)
        assert again != text, options
        if entry.get("remedied"):
            assert code == 0, (options, again)
    assert alternatives or not entry.get("remedied"), f"no advice in: {text}"


@pytest.mark.parametrize(
    "line",
    [
        "identify encoder.csv --column position=enc1",
        "identify good.csv",
        "identify sensor.csv",
        "identify sensor.csv --model coulomb_viscous --method separable",
    ],
)
def test_warnings_advise_what_runs(
    line: str, folder: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(folder)
    words = shlex.split(line)
    assert main([*words, "--quiet"]) == 0
    warnings = [
        text
        for text in capsys.readouterr().out.splitlines()
        if text.startswith(("info (", "warning (", "blocking ("))
    ]
    for text in warnings:
        assert not python_in(text), (python_in(text), text)
        for options in advised(text, words, {"UNIT": "deg", "HEADER": "enc1", "NAME": "stribeck"}):
            assert options[0] in commands()["identify"]._option_string_actions
            assert answer([*words, *options, "--quiet"], capsys)[0] == 0, (options, text)


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
        if option in FILES and not flag:
            assert known[option].type is Path, option
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


@pytest.mark.parametrize(
    "line",
    [
        "identify good.csv --model stribeck:ripple=",
        "identify good.csv --set inertia=",
        "identify good.csv --scale position=",
        "simulate true.toml --duration ",
        "sweep good.csv --grid windows=",
    ],
)
def test_numbers_beyond_all_floats(
    line: str, folder: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(folder)
    code, text = answer(shlex.split(line + "9" * 400), capsys)
    assert code == 2, text
    assert "Traceback" not in text
