"""A log of others reaches an estimate after at most one correction, made by pasting what is printed."""

import json
import re
import shlex
from pathlib import Path

import pytest
from command_line_answers import answer
from foreign_text_logs import LOGS, write_log

from jointid.cli.command_line import main

ROOT = Path(__file__).resolve().parents[2]
SHORTENED = Path(__file__).with_name("foreign_logs")

# File → corrections, what only the user knows, and a value that the estimate must come near, with its tolerance.
FILES: dict[str, tuple[int, dict[str, str], tuple[str, float, float]]] = {
    "kr300/kr300_A.csv.gz": (1, {"RATIO": "256.86"}, ("coulomb", 370.0, 0.2)),
    "emps/DATA_EMPS.mat": (1, {"HEADER": "vir"}, ("inertia", 95.11 / 35.150652, 0.01)),
    "emps/emps_train.csv.gz": (0, {}, ("inertia", 95.11, 0.01)),
    "tx40/tx40.csv.gz": (1, {}, ("viscous", 8.05 / 32**2, 0.1)),
    "ak80/ak80_swing_up.csv": (0, {}, ("coulomb", 0.22, 0.2)),
}
COPIES: dict[str, tuple[int, dict[str, str], tuple[str, float, float]]] = {
    "kr300_125_hz.csv.gz": (1, {"RATIO": "256.86"}, ("coulomb", 370.0, 0.2)),
    "tx40_200_hz.csv.gz": (1, {}, ("viscous", 8.05 / 32**2, 0.2)),
    "ak80_swing_up.csv.gz": FILES["ak80/ak80_swing_up.csv"],
}


def pasted(sentence: str, known: dict[str, str]) -> list[str]:
    """The options behind the first `with`, as a shell reads them; what only the user knows is filled in."""
    options: list[str] = []
    advice = re.sub(r"\((?:[^()]*)\)", "", sentence.partition(" with ")[2])
    words = shlex.split(advice.partition(" or ")[0])
    for option, value in zip(words[::2], words[1::2], strict=False):
        assert option.startswith("--"), sentence
        name, equals, stated = value.rpartition("=")
        options += [option, f"{name}{equals}{known.get(stated, stated)}"]
    assert options, sentence
    return options


def estimated(
    line: list[str], known: dict[str, str], capsys: pytest.CaptureFixture[str]
) -> tuple[int, dict[str, dict[str, float]]]:
    """The corrections that a command needs, and the parameters that it then finds."""
    for corrections in range(3):
        code, sentence = answer([*line, "--quiet"], capsys)
        if code == 0:
            assert main([*line, "--quiet", "--json"]) == 0
            found = json.loads(capsys.readouterr().out)
            return corrections, found["parameters"]
        line = [*line, *pasted(sentence, known)]
    raise AssertionError(sentence)


def check(
    path: Path,
    wanted: tuple[int, dict[str, str], tuple[str, float, float]],
    capsys: pytest.CaptureFixture[str],
) -> None:
    corrections, known, (name, value, tolerance) = wanted
    needed, parameters = estimated(["identify", str(path)], known, capsys)
    assert needed == corrections <= 1
    assert parameters[name]["value"] == pytest.approx(value, rel=tolerance)


@pytest.mark.parametrize("name", FILES)
def test_a_real_log(
    name: str, request: pytest.FixtureRequest, capsys: pytest.CaptureFixture[str]
) -> None:
    if name.startswith("emps/"):
        path = request.getfixturevalue("emps") / name.removeprefix("emps/")
    else:
        path = request.getfixturevalue("shared_data") / name
    check(path, FILES[name], capsys)


@pytest.mark.parametrize("name", COPIES)
def test_a_shortened_log(name: str, capsys: pytest.CaptureFixture[str]) -> None:
    check(SHORTENED / name, COPIES[name], capsys)


@pytest.mark.parametrize(
    "name", ["foreign_logs/xl330_two_runs.csv.gz", "../data/xl330/bam_xl330.csv.gz"]
)
def test_a_servo_log_has_no_torque(
    name: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """A duty is not offered as a torque: the advice leads to the joint file of docs/servos.md, and to a motor."""
    path = Path(__file__).parent / name
    for command in ("identify", "compare"):
        code, sentence = answer([command, str(path), "--quiet"], capsys)
        assert code == 2
        assert "the log has no torque" in sentence
        assert "torque=" not in sentence
    page = (ROOT / "docs" / "servos.md").read_text(encoding="utf-8")
    servo = tmp_path / "servo.toml"
    servo.write_text(page.partition("```toml\n")[2].partition("```")[0], encoding="utf-8")
    options = pasted(sentence, {"SERVO.toml": str(servo)})
    assert options == ["--joint", str(servo), "--by", "run_index"]
    assert main(["identify", str(path), *options, "--quiet"]) == 0
    assert "torque_constant" in capsys.readouterr().out


def test_a_motor_side_without_a_gear_ratio_is_said(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    line = ["identify", str(SHORTENED / "tx40_200_hz.csv.gz"), "--joints", "1", "--quiet"]
    said = "motor_side"
    page = tmp_path / "page.html"
    assert main([*line, "--report", str(page)]) == 0
    assert said in capsys.readouterr().out
    assert "no gear ratio is known: the values are on the motor" in page.read_text("utf-8")
    assert main([*line, "--gear-ratio", "32"]) == 0
    assert "motor_side" not in capsys.readouterr().out


@pytest.mark.parametrize("name", LOGS)
def test_a_text_log(name: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """What middleware and controllers write; the joint is the one of `foreign_text_logs`."""
    known = {"RATIO": "1", "VALUE": "10", "HEADER": "2"}
    needed, parameters = estimated(["identify", str(write_log(tmp_path, name))], known, capsys)
    assert needed <= 1
    assert parameters["viscous"]["value"] == pytest.approx(2.0, rel=0.2)
