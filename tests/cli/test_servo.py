"""`jointid identify` of a servo's runs: files, a folder, one file of many, and what is refused."""

import json
from pathlib import Path

import numpy as np
import pytest
from simulated_servo import LOOP_GAIN, Truth, bench_runs

import jointid as jid
from jointid.cli.command_line import main

JOINT = f"""schema = 2
name = "servo"
[drive]
input = "voltage"
[drive.position_loop]
gain = {LOOP_GAIN}
[drive.signals]
driven = "torque_enabled"
[link]
mass = 0.49
centre_of_mass = 0.1
angle = "-90deg"
"""
HEADERS = "time_s,position_rad,goal_position_rad,duty,supply,torque_enabled,gain"


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    place = tmp_path_factory.mktemp("servo")
    (place / "servo.toml").write_text(JOINT, encoding="utf-8")
    (place / "runs").mkdir()
    tables = []
    for number, run in enumerate(bench_runs(Truth(), seed=2, runs=8)):
        assert run.reference is not None
        extra = [run.extra[name] for name in ("duty", "supply", "driven", "gain")]
        rows = np.column_stack([run.time, run.position, run.reference, *extra])
        tables.append(np.column_stack([rows, np.full(len(rows), number)]))
        path = place / "runs" / f"run{number}.csv"
        np.savetxt(path, rows, delimiter=",", header=HEADERS, comments="")
    whole = np.vstack(tables)
    np.savetxt(place / "all.csv", whole, delimiter=",", header=f"{HEADERS},run", comments="")
    return place


def answer(capsys: pytest.CaptureFixture[str], *words: str | Path) -> dict[str, object]:
    assert main(["identify", *map(str, words), "--json", "--quiet"]) in (0, None)
    found: dict[str, object] = json.loads(capsys.readouterr().out)
    return found


def test_files_a_folder_and_one_file_of_many_are_the_same(
    folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    joint = ("--joint", folder / "servo.toml")
    files = sorted((folder / "runs").iterdir())
    one = answer(capsys, *files, *joint)
    two = answer(capsys, folder / "runs", *joint)
    three = answer(capsys, folder / "all.csv", "--by", "run", *joint)
    assert one["parameters"] == two["parameters"] == three["parameters"]
    assert one["kind"] == "jointid servo"
    heavier = answer(capsys, folder / "runs", *joint, "--mass", "0.98")
    assert heavier["joint"]["link"]["mass"] == 0.98  # type: ignore[index]


def test_the_report_has_rollouts_and_the_joint_file_the_values(
    folder: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    page, saved = tmp_path / "servo.html", tmp_path / "servo.toml"
    command = ["identify", folder / "runs", "--joint", folder / "servo.toml", "--rollout"]
    files = ["--report", str(page), "--save", str(saved)]
    assert not main([*map(str, command), *files])
    lines = capsys.readouterr().out.splitlines()
    assert lines[0] == "servo, 8 runs: usable"
    assert lines[1].split()[:4] == ["torque_constant", "0.3581", "±", "0.0017"]
    assert "median of 8 runs" in lines[-3]
    estimate = tmp_path / "servo_estimate.json"
    assert lines[-1] == f"report: {page}   estimate: {estimate}   joint file: {saved}"
    assert jid.ServoEstimate.load(estimate).verdict.level == "usable"
    assert len(lines) <= 16
    assert not main([*map(str, command), *files, "-v"])
    assert "Rollouts" in capsys.readouterr().out
    html = page.read_text(encoding="utf-8")
    assert html.count("<svg") == 8
    assert "k_t" in html
    joint = jid.Joint.load(saved)
    assert joint.torque_constant == pytest.approx(Truth().torque_constant, rel=0.1)


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (["--selftest"], "selftest"),
        (["--windows", "400"], "0.05s"),
        (["--model", "stribeck"], "stribeck"),
        (["--by", "nothing"], "nothing"),
    ],
)
def test_what_a_servo_does_not_have_is_refused(
    folder: Path, capsys: pytest.CaptureFixture[str], words: list[str], message: str
) -> None:
    command = ["identify", str(folder / "runs"), "--joint", str(folder / "servo.toml"), *words]
    assert main(command) == 2
    assert message in capsys.readouterr().err


def test_a_torque_joint_has_no_rollout(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["identify", str(folder / "runs" / "run0.csv"), "--rollout"]) == 2
    assert "voltage" in capsys.readouterr().err


def test_a_supply_with_its_unit_is_found(
    folder: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    joint = ("--joint", folder / "servo.toml")
    text = (folder / "all.csv").read_text()
    for header in ("supply_V", "supply_A"):
        (tmp_path / f"{header}.csv").write_text(text.replace("supply", header, 1))
    right = answer(capsys, folder / "all.csv", "--by", "run", *joint)
    volts = answer(capsys, tmp_path / "supply_V.csv", "--by", "run", *joint)
    assert volts["parameters"] == right["parameters"]
    command = ["identify", tmp_path / "supply_A.csv", "--by", "run", *joint]
    assert main([*map(str, command)]) == 2
    assert "or name its column in [drive.signals]" in capsys.readouterr().err


def test_a_file_of_several_runs_is_read_whole(
    folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    command = ["identify", folder / "all.csv", "--joint", folder / "servo.toml"]
    assert main([*map(str, command)]) == 2
    assert capsys.readouterr().err.endswith("; identify with --by run (all runs)\n")


def test_one_run_is_one_run(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    command = ["identify", folder / "runs" / "run0.csv", "--joint", folder / "servo.toml"]
    assert main([*map(str, command), "--rollout"]) == 0
    assert "°, median of 1 run\n" in capsys.readouterr().out
