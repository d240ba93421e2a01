"""A bug of jointid ends with a traceback and exit code 70; only bad input ends with one line and 2."""

import errno
import os
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest
from example_recordings import WELL_EXCITED

import jointid as jid
from jointid.cli import session
from jointid.cli.command_line import main
from jointid.hardware.emulated.bus import EmulatedBus
from jointid.hardware.session.guard import Guard

WELL = str(WELL_EXCITED)
BENCH = str(Path(__file__).resolve().parents[2] / "examples" / "hardware" / "joint.toml")
DEPTHS = {
    "the command": "jointid.cli.commands.load_all",
    "a reader": "jointid.recording.readers.csv_reader.CsvTable.numbers",
    "the preparation": "jointid.identification.identification.prepare",
    "inference": "jointid.identification.conclusion.parameter_covariance",
}


def raising(error: BaseException) -> Any:
    def broken(*_: Any, **__: Any) -> None:
        raise error

    return broken


@pytest.mark.parametrize("kind", [TypeError, ValueError, KeyError])
@pytest.mark.parametrize("place", DEPTHS.values(), ids=DEPTHS.keys())
def test_a_bug_ends_with_a_traceback(
    kind: type[Exception],
    place: str,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    monkeypatch.setattr(place, raising(kind("injected")))
    assert main(["identify", WELL, "--method", "separable"]) == 70
    lines = capsys.readouterr().err.splitlines()
    assert lines[0] == "Traceback (most recent call last):"
    assert "injected" in lines[-2]
    assert lines[-1].startswith("jointid identify: this is an error in the program")
    assert "please report it" in lines[-1]


def test_a_bug_in_a_process_of_its_own(tmp_path: Path) -> None:
    # Site customisation stands for a bug that was shipped.
    (tmp_path / "sitecustomize.py").write_text(
        "import jointid.recording.readers.loading as loading\n"
        "def broken(*arguments, **options):\n    return {}['injected']\n"
        "loading.load = broken\n",
        encoding="utf-8",
    )
    path = os.pathsep.join([str(tmp_path), os.environ.get("PYTHONPATH", "")])
    result = subprocess.run(
        [sys.executable, "-m", "jointid", "info", WELL],
        capture_output=True,
        text=True,
        timeout=60,
        env=os.environ | {"PYTHONPATH": path},
        check=False,
    )
    assert result.returncode == 70
    assert result.stderr.startswith("Traceback")
    assert "KeyError: 'injected'" in result.stderr
    assert result.stdout == ""


@pytest.mark.parametrize(
    ("error", "code", "text"),
    [
        (jid.InputError("injected"), 2, "jointid info: injected\n"),
        (OSError(13, "Permission denied", "run.csv"), 2, "jointid info: run.csv: Permission den"),
        (KeyboardInterrupt(), 130, "jointid: interrupted\n"),
    ],
)
def test_what_is_no_bug(
    error: BaseException,
    code: int,
    text: str,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    monkeypatch.setattr("jointid.cli.contents.load_all", raising(error))
    assert main(["info", WELL]) == code
    written = capsys.readouterr().err
    assert written.startswith(text)
    assert written.count("\n") == 1


def test_a_full_disk_is_not_a_bug(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    full = OSError(errno.ENOSPC, "No space left on device")
    monkeypatch.setattr("jointid.cli.contents.load_all", raising(full))
    assert main(["info", WELL]) == 2
    assert capsys.readouterr().err == "jointid info: the output: No space left on device\n"


def test_a_broken_pipe_that_is_not_our_output_is_not_passed_over() -> None:
    program = (
        "import sys\nfrom jointid.cli import contents, main\n"
        "def broken(_):\n    raise BrokenPipeError\n"
        "contents.info = broken\nsys.exit(main(['info', 'x.csv']))"
    )
    done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True)
    assert done.returncode == 70
    assert "BrokenPipeError" in done.stderr


def test_notes_of_a_bug_are_repeated_at_the_end(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    error = KeyError("injected")
    error.add_note("the motor is off")
    monkeypatch.setattr("jointid.cli.contents.load_all", raising(error))
    assert main(["info", WELL]) == 70
    assert capsys.readouterr().err.splitlines()[-1].endswith("(the motor is off)")


def test_the_end_of_the_input_is_a_no(monkeypatch: pytest.MonkeyPatch) -> None:
    def ended(_: str) -> str:
        raise EOFError

    monkeypatch.setattr("builtins.input", ended)
    assert session._yes("Is the space free?") is False


def test_an_error_of_the_system_without_a_file_is_a_bug(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr("jointid.cli.contents.load_all", raising(OSError("injected")))
    assert main(["info", WELL]) == 70
    assert "injected" in capsys.readouterr().err


@pytest.mark.parametrize("kind", [TypeError, ValueError, KeyError])
def test_a_bug_in_a_session_switches_the_motor_off_first(
    kind: type[Exception],
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    devices: list[Any] = []
    construct, check = EmulatedBus.__init__, Guard.measured
    motor_was_on: list[bool] = []

    def constructed(self: EmulatedBus, *attached: Any, **options: Any) -> None:
        devices.extend(each for each in attached if hasattr(each, "motor_on"))
        construct(self, *attached, **options)

    def broken(self: Guard, *arguments: Any) -> None:
        motor_was_on.append(devices[0].motor_on)
        if sum(motor_was_on) > 600:
            raise kind("injected")
        check(self, *arguments)

    monkeypatch.setattr(EmulatedBus, "__init__", constructed)
    monkeypatch.setattr(Guard, "measured", broken)
    runs = tmp_path / "runs"
    assert main(["run", BENCH, "--emulate", "--output", str(runs), "--quiet"]) == 70
    lines = capsys.readouterr().err.splitlines()
    assert lines[0] == "Traceback (most recent call last):"
    assert any(line.startswith(kind.__name__) and "injected" in line for line in lines)
    assert lines[-1].startswith("jointid run: this is an error in the program")
    assert motor_was_on[-1]
    assert [device.motor_on for device in devices] == [False]
    assert len(jid.load(runs / "initial.csv")) > 200, "closed, whole, and it reads back"
