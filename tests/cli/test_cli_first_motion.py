"""`jointid check`, `jointid first-motion`, and what `jointid run` asks for before a real joint moves."""

import json
import re
import shutil
from contextlib import AbstractContextManager
from pathlib import Path
from typing import Any

import pytest

import jointid.commissioning  # before `wired` replaces what it imports  # noqa: F401
from jointid.cli import main
from jointid.hardware.bench import opened_drive
from jointid.hardware.bench.bench import Bench
from jointid.hardware.elmo.emulated_settings import ElmoSettings
from jointid.hardware.elmo.options import ElmoOptions
from jointid.hardware.proof import check, procedure
from jointid.hardware.proof.steps import Steps

EXAMPLE = Path(__file__).resolve().parents[2] / "examples" / "hardware" / "joint.toml"
KEYS = {
    *("passed", "reason", "travel", "largest_torque"),
    *("breakaway", "signs", "unchecked"),
}


def copied(folder: Path) -> Path:
    """A copy of the example, whose bus is none of this machine's, at half its rate."""
    path = folder / "joint.toml"
    shutil.copy(EXAMPLE, path)
    edited(path, 'interface = "socketcan"', 'interface = "virtual"')
    edited(path, "period = 0.002 ", "period = 0.004 ")
    return path


@pytest.fixture
def joint(tmp_path: Path) -> Path:
    return copied(tmp_path)


def edited(joint: Path, before: str, after: str) -> None:
    text = joint.read_text(encoding="utf-8")
    assert before in text
    joint.write_text(text.replace(before, after, 1), encoding="utf-8")


def wire(monkeypatch: pytest.MonkeyPatch) -> None:
    """Put an emulated drive in the place of the real one."""
    real = opened_drive.open_drive

    def emulated(
        bench: Bench, *, emulate: bool = False, seed: int = 0
    ) -> AbstractContextManager[Any]:
        del emulate
        return real(bench, emulate=True, seed=seed)

    for module in (opened_drive, check, procedure):
        monkeypatch.setattr(module, "open_drive", emulated)


@pytest.fixture
def wired(monkeypatch: pytest.MonkeyPatch) -> None:
    wire(monkeypatch)


@pytest.fixture(scope="module")
def first_moved(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The certificate of a first motion by the command, of a real joint."""
    path = copied(tmp_path_factory.mktemp("certified"))
    with pytest.MonkeyPatch.context() as monkeypatch:
        wire(monkeypatch)
        assert main(["first-motion", str(path), "--yes", "--quiet"]) == 0
    return path.with_suffix(".certificate.toml")


def test_json_has_the_keys_that_programs_read(joint: Path, capsys: Any) -> None:
    assert main(["first-motion", str(joint), "--emulate", "--json"]) == 0
    found = json.loads(capsys.readouterr().out)
    assert set(found) == KEYS
    assert found["passed"] is True
    assert found["reason"] is None
    assert len(found["breakaway"]) == 2
    assert not joint.with_suffix(".certificate.toml").exists()


def test_a_refusal_is_exit_code_three_and_says_why(joint: Path, capsys: Any) -> None:
    edited(joint, "[session.emulated] ", "[session.emulated]\nencoder_sign = -1\n# ")
    assert main(["first-motion", str(joint), "--emulate", "--json"]) == 3
    shown = capsys.readouterr()
    assert json.loads(shown.out)["reason"] == "torque_and_encoder_disagree"
    assert "encoder" in shown.err
    assert main(["first-motion", str(joint), "--emulate"]) == 3
    shown = capsys.readouterr()
    assert "REFUSED (torque_and_encoder_disagree)" in shown.out
    assert "AGAINST the torque" in shown.out


def test_a_cap_ends_it(joint: Path, capsys: Any) -> None:
    arguments = ["first-motion", str(joint), "--emulate", "--largest-torque", "5", "--json"]
    assert main(arguments) == 3
    found = json.loads(capsys.readouterr().out)
    assert found["reason"] == "no_motion_up_to_torque_cap"
    assert 4.5 < found["largest_torque"] <= 5.0
    arguments[4] = "-5"
    assert main(arguments) == 2
    assert "--largest-torque" in capsys.readouterr().err


def test_nobody_agrees_to_a_motion_from_a_script(joint: Path, capsys: Any) -> None:
    for words in (["first-motion"], ["run", "--force"]):
        assert main([*words, str(joint)]) == 3
        assert "--yes" in capsys.readouterr().err
        other = joint.with_name("other.toml")
        shutil.copy(joint, other)
        edited(other, 'interface = "virtual"', 'interface = "socketcan"')
        edited(other, 'channel = "can0"', 'channel = "nocan9"')
        assert main([*words, str(other)]) == 2
        error = capsys.readouterr().err
        assert "nocan9" in error
        assert "--yes" not in error  # nobody is asked about a bus that is not there


def test_check_shows_what_is_connected(joint: Path, capsys: Any) -> None:
    assert main(["check", str(joint), "--emulate"]) == 0
    shown = capsys.readouterr().out
    for part in ("serial", "PL[1]", "CL[1]", "HL[2]", "1016h:1", "position", "torque sensor"):
        assert part in shown, part
    assert main(["check", str(joint), "--emulate", "--json"]) == 0
    found = json.loads(capsys.readouterr().out)
    assert found["passed"] is True
    assert found["problems"] == found["differences"] == []


def test_check_refuses_a_joint_that_moves(joint: Path, capsys: Any) -> None:
    edited(joint, "coulomb = 25.0\nstatic = 20.0", "coulomb = 1.0\nstatic = 0.0")
    edited(joint, "position = 0.0  ", "position = 0.9  ")
    assert main(["check", str(joint), "--emulate"]) == 3
    assert "PROBLEM: the joint moves" in capsys.readouterr().out


def test_check_names_a_drive_that_may_do_more_than_the_joint(joint: Path, capsys: Any) -> None:
    edited(joint, "torque = 160.0  ", "torque = 100.0  ")
    assert main(["check", str(joint), "--emulate"]) == 0
    edited(joint, "[session.limits] ", "[session.limits]\ntorque = 50.0\n# ")
    assert main(["check", str(joint), "--emulate"]) == 3
    assert "PL[1]" in capsys.readouterr().out.splitlines()[-1]


def test_a_real_joint_is_not_run_without_a_certificate(
    joint: Path, first_moved: Path, capsys: Any, wired: None
) -> None:
    del wired
    assert main(["run", str(joint), "--yes", "--quiet"]) == 3
    error = capsys.readouterr().err
    assert "joint.certificate.toml" in error
    assert "--force" in error
    # A first motion of the real bench writes it, and it then holds.
    path = joint.with_suffix(".certificate.toml")
    shutil.copy(first_moved, path)
    assert main(["check", str(joint)]) == 0
    assert "certificate: holds" in capsys.readouterr().out
    # It does not hold for another joint file, and another drive.
    other = joint.with_name("other.toml")
    shutil.copy(joint, other)
    shutil.copy(path, other.with_suffix(".certificate.toml"))
    edited(other, "torque_constant = 0.198 ", "torque_constant = 0.2 ")
    assert main(["run", str(other), "--yes", "--quiet"]) == 3
    assert "torque_constant was 0.198 and is 0.2" in capsys.readouterr().err
    # Nor for a watchdog that waits longer than the one that was certified, although the joint may go so far.
    edited(joint, "heartbeat = 0.05 ", "heartbeat = 0.06 ")
    assert main(["run", str(joint), "--yes", "--quiet"]) == 3
    assert "the watchdog's time was 0.05 and is 0.06" in capsys.readouterr().err
    edited(joint, "heartbeat = 0.06 ", "heartbeat = 0.05 ")
    serial = next(line for line in path.read_text().splitlines() if '"serial"' in line)
    edited(path, serial, '"serial" = "another"')
    assert main(["run", str(joint), "--yes", "--quiet"]) == 3
    assert "serial was another" in capsys.readouterr().err


def test_a_drive_that_declares_no_watchdog_gets_none(
    joint: Path, capsys: Any, wired: None, monkeypatch: pytest.MonkeyPatch
) -> None:
    del wired
    monkeypatch.setattr(ElmoOptions, "watchdog", None)
    monkeypatch.setattr(Steps, "run", Steps._ready)
    assert main(["first-motion", str(joint), "--yes", "--quiet"]) == 3
    assert "no certificate: the drive declares no watchdog" in capsys.readouterr().err
    assert not joint.with_suffix(".certificate.toml").exists()
    assert main(["check", str(joint), "--emulate"]) == 0
    assert "REMARK: the drive declares no watchdog" in capsys.readouterr().out


def test_a_watchdog_that_is_too_slow_is_refused_by_each_command(joint: Path, capsys: Any) -> None:
    edited(joint, "heartbeat = 0.05 ", "heartbeat = 10.0 ")
    for command in ("check", "first-motion", "run"):
        assert main([command, str(joint), "--emulate"]) == 3
        shown = capsys.readouterr()
        assert "the longest acceptable time is 0.082 s" in shown.out + shown.err


def test_force_goes_on_without_one(joint: Path, capsys: Any) -> None:
    assert main(["run", str(joint), "--yes", "--quiet", "--force"]) == 3
    error = capsys.readouterr().err
    assert "certificate" not in error
    assert "boot-up" in error  # nobody is on that bus


def test_check_marks_what_the_file_does_not_state(joint: Path, capsys: Any) -> None:
    edited(joint, "counts_per_turn = 8000 ", "# ")
    edited(joint, "velocity = 4.0  ", "# ")
    edited(joint, 'amplitude = "60deg"', "")
    assert main(["check", str(joint), "--emulate"]) == 0
    lines = capsys.readouterr().out.splitlines()
    mark = "   DEFAULT: the file has no such key"
    for line in (
        f"  velocity: 10 rad/s{mark}",
        f"  counts_per_turn: 8000{mark}",
        f"  amplitude: 0.349066{mark}",
        "  position: -1.4 to 1.4 rad",
        "  torque: 159.984 N·m",
        "  cycle: 3 s",
    ):
        assert line in lines, line
    assert any("(-20.0° to 20.0°)" in line for line in lines)
    assert main(["check", str(joint), "--emulate", "--json"]) == 0
    found = json.loads(capsys.readouterr().out)["in_force"]
    assert found["limits"]["velocity"] == 10.0
    assert {"limits.velocity", "drive.counts_per_turn"} < {*found["defaults"]}
    assert "limits.torque" not in found["defaults"]


def test_check_remarks_a_speed_limit_of_the_drive_that_protects_nothing(
    joint: Path, capsys: Any, monkeypatch: pytest.MonkeyPatch
) -> None:
    assert main(["check", str(joint), "--emulate", "--json"]) == 0
    high, low = json.loads(capsys.readouterr().out)["remarks"]
    assert "HL[2] is 1000000000 count/s, 1944 times" in high
    assert "LL[2] slightly beyond -514389 count/s" in low
    settings = ElmoSettings.__init__

    def narrow(self: ElmoSettings, **given: Any) -> None:
        settings(self, **{**given, "speed_limit": 600_000.0})

    monkeypatch.setattr(ElmoSettings, "__init__", narrow)
    assert main(["check", str(joint), "--emulate", "--json"]) == 0
    assert json.loads(capsys.readouterr().out)["remarks"] == []


def test_a_dry_run_asks_for_the_certificate_too(
    joint: Path, first_moved: Path, capsys: Any, wired: None, tmp_path: Path
) -> None:
    del wired
    output = tmp_path / "runs"
    words = ["run", str(joint), "--dry-run", "--output", str(output)]
    assert main(words) == 3
    shown = capsys.readouterr()
    assert "there is no joint.certificate.toml" in shown.err
    assert "passed" not in shown.out
    shutil.copy(first_moved, joint.with_suffix(".certificate.toml"))
    assert main(words) == 0
    shown = capsys.readouterr()
    assert "  repeated_positions: 10   DEFAULT: the file has no such key" in shown.out
    assert shown.out.endswith("all pre-flight checks passed\n")
    edited(joint, "gear_ratio = 101", "gear_ratio = 100")
    assert main([*words, "--json"]) == 3
    found = json.loads(capsys.readouterr().out)
    assert (found["status"], found["reason"]) == ("refused", "certificate")
    assert "gear_ratio was 101" in found["message"]
    assert main([*words, "--json", "--force"]) == 0
    found = json.loads(capsys.readouterr().out)
    assert found["status"] == "passed"
    assert found["in_force"]["motion"]["highest"] == pytest.approx(1.047, abs=0.001)
    assert not output.exists()


def test_a_certificate_without_a_table_is_one_sentence(
    joint: Path, first_moved: Path, capsys: Any, wired: None
) -> None:
    del wired
    path = joint.with_suffix(".certificate.toml")
    shutil.copy(first_moved, path)
    whole = path.read_text(encoding="utf-8")
    for table, after in (("wiring", "drive"), ("drive", "found")):
        head, _, rest = whole.partition(f"[{table}]\n")
        path.write_text(
            f"{head}[{table}]\n\n[{after}]{rest.partition(f'[{after}]')[2]}", encoding="utf-8"
        )
        capsys.readouterr()
        assert main(["check", str(joint)]) == 0
        said = capsys.readouterr().out.splitlines()[-1]
        assert said == (
            f"certificate: the certificate has no table [{table}], but the bench states these facts; "
            "run `jointid first-motion` before `jointid run`"
        )
    path.write_text(re.sub(r'date = ".*"', 'date = "soon"', whole), encoding="utf-8")
    assert main(["run", str(joint), "--dry-run"]) == 3
    expected = "date is 'soon': a date such as \"2026-01-31T12:00:00+00:00\""
    assert expected in capsys.readouterr().err


def test_the_watchdog_is_tried_and_certified(joint: Path, capsys: Any, wired: None) -> None:
    del wired
    assert main(["first-motion", str(joint), "--yes", "--watchdog", "--json"]) == 0
    found = json.loads(capsys.readouterr().out)
    assert set(found) == KEYS
    assert "watchdog" not in found["unchecked"]
    text = joint.with_suffix(".certificate.toml").read_text(encoding="utf-8")
    assert '"watchdog" = 0.05' in text
    # Its failure is gone from the drive; a moved zero is said, and wider limits are refused.
    edited(joint, "position_offset = 0.0", "position_offset = 0.3")
    assert main(["check", str(joint)]) == 0
    shown = capsys.readouterr().out
    assert "certificate: holds" in shown
    assert "note: position_offset was 0 and is 0.3 rad" in shown
    edited(joint, "[session.limits] ", "[session.limits]\ntorque = 400.0\n# ")
    assert main(["run", str(joint), "--yes", "--quiet"]) == 3
    assert "torque limit is wider than certified: it was" in capsys.readouterr().err
