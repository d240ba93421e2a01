"""Text logs of other programs load after at most one correction, made by pasting what is printed."""

import ast
import shlex
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from foreign_text_logs import LOGS, POSITION, TIME, TORQUE, write_log

import jointid as jid
from jointid.cli.command_line import main


def pasted_python(message: str) -> dict[str, Any]:
    """The arguments behind the first `load with`, as Python reads them."""
    text = message.partition("load with ")[2]
    for end in reversed(range(len(text) + 1)):
        try:
            call = ast.parse(f"load({text[:end]})", mode="eval").body
        except SyntaxError:
            continue
        assert isinstance(call, ast.Call)
        return {str(each.arg): ast.literal_eval(each.value) for each in call.keywords}
    raise AssertionError(message)


def pasted_options(message: str) -> list[str]:
    """The options behind the first `with`, as a shell reads them."""
    words = shlex.split(message.partition(" with ")[2])
    options: list[str] = []
    for option, value in zip(words[::2], words[1::2], strict=False):
        if not option.startswith("--"):
            break
        options += [option, value.replace("torque=HEADER", "torque=2")]
    return options


def check(recording: jid.Recording, name: str) -> None:
    np.testing.assert_allclose(
        recording.time - recording.time[0], TIME, atol=1e-9 if name != "plotjuggler" else 1e-6
    )
    np.testing.assert_allclose(recording.position, POSITION, atol=1e-8)
    if name == "robot_arm_controller":  # it logs what it commands, and the current
        assert recording.torque is None
        np.testing.assert_allclose(recording.current, TORQUE / 10.0)  # type: ignore[arg-type]
    else:
        assert recording.torque is not None
        np.testing.assert_allclose(recording.torque, TORQUE, atol=1e-8)


@pytest.mark.parametrize("name", LOGS)
def test_python(name: str, tmp_path: Path) -> None:
    path = write_log(tmp_path, name)
    needs_correction = LOGS[name][2]
    if needs_correction:
        with pytest.raises(jid.InputError) as caught:
            jid.load(path)
        pasted = pasted_python(str(caught.value))
        if name == "serial_port":  # no header says which column is the torque
            assert "which column is the torque or current?" in str(caught.value)
            pasted["columns"]["torque"] = 2
        check(jid.load(path, **pasted), name)
    else:
        check(jid.load(path), name)


@pytest.mark.parametrize("name", LOGS)
@pytest.mark.parametrize("command", ["info", "identify"])
def test_command_line(
    name: str, command: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = write_log(tmp_path, name)
    line = [command, str(path)]
    if command == "identify":
        line += ["--model", "coulomb_viscous", "--method", "separable"]
    if command == "identify" and name == "robot_arm_controller":
        line += ["--column", "torque=target_moment_2"]  # its current needs a torque constant
    if LOGS[name][2]:
        assert main(line) == 2
        message = capsys.readouterr().err
        assert message.count("\n") == 1
        assert len(message) - len(str(path)) < 450
        line += pasted_options(message)
    assert main(line) == 0, capsys.readouterr().err
