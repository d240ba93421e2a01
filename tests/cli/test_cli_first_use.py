"""What a first-time user met: outputs that fail late, files that lose values, sentences that mislead."""

import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from command_line_answers import answer
from example_recordings import WELL_EXCITED
from wrong_files import write_wrong_files

import jointid as jid
from jointid import _core
from jointid.cli.command_line import main
from jointid.cli.values import as_typed, in_sentence
from jointid.identification.search.search import METHODS
from jointid.joint.checks import suggestion

WELL = str(WELL_EXCITED)
BENCH = Path(__file__).resolve().parents[2] / "examples" / "hardware" / "joint.toml"


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    write_wrong_files(tmp_path)
    monkeypatch.chdir(tmp_path)
    return tmp_path


@pytest.mark.parametrize("encoding", ["ascii", "cp1252"])
def test_a_terminal_without_a_root_sign_gets_the_report(encoding: str) -> None:
    result = subprocess.run(
        [sys.executable, "-m", "jointid", "identify", WELL, "--model", "stribeck", "--quiet", "-v"],
        capture_output=True,
        timeout=120,
        env=os.environ | {"PYTHONIOENCODING": encoding, "PYTHONUTF8": "0"},
        check=False,
    )
    assert result.returncode == 0, result.stderr
    assert b"= 1/?stribeck" in result.stdout


def test_identify_says_what_it_wrote(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    line = ["identify", WELL, "--model", "stribeck", "--quiet", "--report", "page.html", "--save"]
    for name, said in (
        ("new.toml", "estimate: page_estimate.json   joint file: new.toml"),
        ("new.json", "estimate: new.json"),
    ):
        assert main([*line, name]) == 0
        assert capsys.readouterr().out.endswith(f"\nreport: page.html   {said}\n")
    assert jid.Estimate.load("page_estimate.json").parameters
    assert main([*line, "new.json", "--json"]) == 0
    assert capsys.readouterr().out.endswith("}\n")


@pytest.fixture
def blocked(folder: Path) -> str:
    """A recording whose torque never changes."""
    time = np.arange(0.0, 5.0, 0.002)
    position = 0.5 * np.sin(2.0 * time)
    table = np.column_stack([time, position, np.full_like(time, 3.0)])
    header = "time_s,position_rad,torque_Nm"
    np.savetxt(folder / "constant.csv", table, delimiter=",", header=header, comments="")
    return "constant.csv"


@pytest.mark.parametrize(
    "words",
    [
        ["identify", "--model", "coulomb_viscous"],
        ["compare", "--model", "coulomb_viscous", "--folds", "2"],
    ],
)
def test_values_that_cannot_be_used_stay_out_of_a_joint_file(
    words: list[str], blocked: str, folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    jid.thesis_joint().with_parameters({"coulomb": 25.0}).save(folder / "mine.toml")
    before = (folder / "mine.toml").read_bytes()
    words = [words[0], blocked, *words[1:], "--quiet"]
    assert main([*words, "--save", "mine.toml", "--report", "page.html"]) == 2
    written = capsys.readouterr()
    assert "coulomb" in written.out
    assert written.err.count("\n") == 1
    assert written.err.startswith(f"jointid {words[0]}: the finding constant_signal is blocking: ")
    assert "mine.toml was not written; --save estimate.json keeps the result" in written.err
    assert (folder / "mine.toml").read_bytes() == before
    assert (folder / "page.html").is_file()
    assert main([*words, "--save", "kept.json"]) == 0
    assert (folder / "kept.json").is_file()


def test_an_emulated_session_leaves_the_joint_file_alone(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    own = tmp_path / "joint.toml"
    own.write_bytes(BENCH.read_bytes())
    words = ["run", str(own), "--emulate", "--cycles", "1", "--quiet", "--save"]
    assert main([*words, str(own)]) == 2
    assert "cannot overwrite it; give another name" in capsys.readouterr().err
    assert own.read_bytes() == BENCH.read_bytes()


@pytest.mark.parametrize(
    ("line", "says"),
    [
        ("sweep good.csv --plot x.txt", "--plot x.txt: a plot is written as .png, .pdf or .svg"),
        ("identify good.csv --set coulomb=3 --set coulomb=4", "--set coulomb=4: it is given twice"),
        ("info good.csv --column position=1 --column position=2", "position=2: it is given twice"),
        (
            "info good.csv --unit position=rad --unit position=deg",
            "position=deg: it is given twice",
        ),
        ("info good.csv --scale torque=2 --scale torque=3", "--scale torque=3: it is given twice"),
        ("info runs.csv --where run=1 --where run=2", "--where run=2: it is given twice"),
        (
            "identify good.csv --modl stribeck",
            "jointid identify: there is no option --modl; did you mean --model?; "
            "see jointid identify --help\n",
        ),
        ("identify good.csv --gear 101", "there is no option --gear; did you mean --gear-ratio?"),
        ("info good.csv --quiet", "jointid info: there is no option --quiet; see jointid info"),
        ("sweep good.csv --tracking", "--simulate JOINT"),
        ("sweep good.csv --grid sensors.torque_noise=1", "--simulate JOINT"),
        ("simulate true.toml --gain saturation=-1", "no saturation; choose one of bandwidth, "),
        ("identify good.csv --joint sensor.toml", "or delete [sensor] from sensor.toml\n"),
        ("identify good.csv --joint text_ratio.toml", 'gear_ratio is "101": a number is expected'),
        (
            "report text.json",
            "text.json: an estimate is expected: a .json file that identify saved",
        ),
        ("report broken.json", "broken.json: not JSON: line 1, column 2\n"),
        ("report text_ratio.toml", "text_ratio.toml: an estimate is expected: a .json file"),
        (
            "demo --output /proc/demo",
            "--output /proc/demo: no file can be written in the folder /proc; give another name",
        ),
        ("demo --output no/demo", "--output no/demo: the folder no does not exist"),
        ("demo --output good.csv", "--output good.csv: this is a file; a folder is expected"),
    ],
)
def test_the_sentence_says_what_to_do(
    line: str, says: str, folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (folder / "text_ratio.toml").write_text('schema = 2\n[drive]\ngear_ratio = "101"\n', "utf-8")
    (folder / "text.json").write_text("oops", encoding="utf-8")
    (folder / "broken.json").write_text("{", encoding="utf-8")
    code, text = answer(line.split(), capsys)
    assert code == 2
    assert says in text
    assert text.count("\n") == 1


def test_a_session_into_a_full_folder_asks_for_another_name(
    folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["run", str(BENCH), "--emulate", "--output", str(folder)]) == 2
    assert "does not overwrite files; give another name\n" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("value", "text"),
    [
        ("101", '"101"'),
        ("1e-3", '"1e-3"'),
        ("true", '"true"'),
        ("three", "three"),
        ("1.2.3", "1.2.3"),
        (["2", 4], '"2", 4'),
        (101, "101"),
        (True, "true"),
        (None, "none"),
    ],
)
def test_a_text_that_looks_like_another_value_is_quoted(value: object, text: str) -> None:
    assert in_sentence(value) == text


def test_what_was_typed_is_shown_as_it_was_typed() -> None:
    assert as_typed("101") == "101"


@pytest.mark.parametrize(
    ("name", "phrase"),
    [
        ("down", "choose one of none, known, free"),
        ("knwon", "did you mean 'known'?"),
        ("frree", "did you mean 'free'?"),
    ],
)
def test_a_short_list_is_shown_instead_of_a_guess(name: str, phrase: str) -> None:
    assert suggestion(name, ("none", "known", "free")) == phrase


@pytest.mark.parametrize("command", ["identify", "compare"])
def test_help_names_every_method(command: str, capsys: pytest.CaptureFixture[str]) -> None:
    text = _help(command, capsys)
    stated = text[text.rindex("--method METHOD") :].partition("--residual")[0]
    assert all(name in stated for name in METHODS)


def test_help_names_every_model_and_every_output(capsys: pytest.CaptureFixture[str]) -> None:
    text = _help("identify", capsys)
    assert all(name in text for name in _core.model_names())
    text = _help("run", capsys)
    assert all(name in text for name in ("report.html", "ring.json", "ring.txt"))


def _help(command: str, capsys: pytest.CaptureFixture[str]) -> str:
    with pytest.raises(SystemExit):
        main([command, "--help"])
    return capsys.readouterr().out
