"""`jointid identify --robot`: one command from a log and a URDF to a table, a page and a file."""

import json
from pathlib import Path

import numpy as np
import pytest
from command_line_answers import answer
from small_arm import recording, urdf

import jointid as jid
from jointid.cli import main

pytest.importorskip("pinocchio")

FACTS = """gear_ratios = [32, 32, 45, -48, 45, 32]
zero_offsets_deg = [0, -90, 90, 0, 0, 0]
[couplings.joint_6]
joint_5 = 1.0
"""


@pytest.mark.slow
def test_one_command(shared_data: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    facts = tmp_path / "robot.toml"
    facts.write_text(FACTS, encoding="utf-8")
    log, urdf = shared_data / "tx40" / "tx40.csv.gz", shared_data / "tx40" / "tx40.urdf"
    page, saved = tmp_path / "arm.html", tmp_path / "arm.json"
    files = ("--report", str(page), "--save", str(saved))
    line = ["identify", str(log), "--robot", str(urdf), "--facts", str(facts), "-v", *files]
    assert main(line) == 0
    out = capsys.readouterr().out
    assert "turned_zero" not in out  # it is a fact now
    rows = {line.split()[0]: line for line in out.splitlines() if line.startswith("joint_")}
    assert len(rows) == 6
    assert "motor_coulomb [N·m]" in out
    document = json.loads(saved.read_text(encoding="utf-8"))
    assert document["joints"]["joint_1"]["parameters"]["viscous"]["value"] == pytest.approx(
        8.05, rel=0.05
    )
    html = page.read_text(encoding="utf-8")
    assert html.count("<svg ") == 12
    assert "joint_6" in html


def test_what_is_for_a_robot_needs_one(capsys: pytest.CaptureFixture[str]) -> None:
    code, told = answer(["identify", "run.csv", "--inertia", "free"], capsys)
    assert code == 2
    assert "--inertia" in told
    assert "--robot" in told


def test_facts_that_nobody_knows_are_refused(
    shared_data: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    facts = tmp_path / "robot.toml"
    facts.write_text("gear_ratio = 3\n", encoding="utf-8")
    log, urdf = shared_data / "tx40" / "tx40.csv.gz", shared_data / "tx40" / "tx40.urdf"
    line = ["identify", str(log), "--robot", str(urdf), "--facts", str(facts)]
    code, told = answer(line, capsys)
    assert code == 2
    assert "robot.toml" in told
    assert "gear_ratios" in told


def test_the_facts_hold_a_joints_model(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path, facts, saved = urdf(tmp_path), tmp_path / "robot.toml", tmp_path / "arm.json"
    run = recording(path, duration=6.0)
    assert run.torque is not None
    names = [f"{name}.{signal}" for signal in ("position", "torque") for name in run.names]
    table = np.column_stack([run.time, run.position, run.torque])
    log = tmp_path / "arm.csv"
    np.savetxt(log, table, delimiter=",", header=",".join(["time", *names]), comments="")
    facts.write_text('[joints.elbow]\nmodel = "coulomb_viscous:asymmetric"\n', encoding="utf-8")
    line = ["identify", str(log), "--robot", str(path), "--facts", str(facts), "-v"]
    page = tmp_path / "arm.html"
    assert main([*line, "--save", str(saved), "--report", str(page)]) == 0
    assert "viscous_difference" in capsys.readouterr().out
    assert page.read_text(encoding="utf-8").count("<svg ") == 4
    models = json.loads(saved.read_text(encoding="utf-8"))["settings"]["model"]
    assert models["elbow"] == "coulomb_viscous:asymmetric"
    assert main([*line, "--model", "coulomb_viscous"]) == 0
    assert "viscous_difference" not in capsys.readouterr().out


@pytest.fixture(name="saved", scope="module")
def _saved(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("robot")
    path = urdf(folder)
    found = jid.identify_robot(
        recording(path, duration=6.0), jid.Robot.from_urdf(path), model="coulomb_viscous"
    )
    return found.save(folder / "arm.json")


def test_a_saved_robot_has_a_page_again(
    saved: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    page = tmp_path / "arm.html"
    assert main(["report", str(saved), "--output", str(page)]) == 0
    assert page.read_text(encoding="utf-8").count("<svg ") == 4
    code, told = answer(["report", str(saved), "--output", str(page), "--joints", "1"], capsys)
    assert code == 2
    assert "all joints" in told


def test_a_saved_robot_is_written_into_its_urdf(
    saved: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    target = tmp_path / "out.urdf"
    line = ["export", str(saved), "--to", str(target), "--into", str(saved.with_name("small.urdf"))]
    assert main(line) == 0
    assert 'damping="0.1"' not in target.read_text(encoding="utf-8")
    broken = tmp_path / "broken.json"
    broken.write_text(saved.read_text(encoding="utf-8").replace('"kind": "revolute"', '"kind": 1'))
    code, told = answer(["export", str(broken), "--to", str(target)], capsys)
    assert code == 2
    assert "robot.joints[0].kind" in told
