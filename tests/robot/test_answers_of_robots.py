"""The answer of a robot: few short lines, the worst joint first, and advice that can be done as it is printed."""

import re
import shlex
from pathlib import Path

import numpy as np
import pytest
import small_arm

import jointid as jid
from jointid.cli import main
from jointid.estimate.findings import Finding
from jointid.robot.result.finding_types import TYPES

pytest.importorskip("pinocchio")


@pytest.fixture(name="run", scope="module")
def _run(tmp_path_factory: pytest.TempPathFactory) -> jid.RobotRecording:
    return small_arm.recording(small_arm.urdf(tmp_path_factory.mktemp("run")), duration=6.0)


def saved(run: jid.RobotRecording, path: Path, **signals: object) -> Path:
    fields = {"time": run.time, "position": run.position, "torque": run.torque, "names": run.names}
    jid.RobotRecording(**{**fields, **signals}).save(path)  # type: ignore[arg-type]
    return path


def reversed_torque(run: jid.RobotRecording) -> dict[str, object]:
    return {"torque": np.asarray(run.torque) * (1.0, -1.0)}


def in_degrees(run: jid.RobotRecording) -> dict[str, object]:
    return {"position": np.rad2deg(run.position)}


def off(run: jid.RobotRecording) -> dict[str, object]:
    return {"position": run.position + np.deg2rad((5.0, 0.0))}


def smaller(run: jid.RobotRecording) -> dict[str, object]:
    return {"torque": np.asarray(run.torque) / 50.0}


@pytest.mark.parametrize(
    ("defect", "code", "worst"),
    [
        (reversed_torque, "wrong_torque_sign", "elbow"),
        (in_degrees, "implausible_unit", ""),
        (off, "wrong_zero", ""),
        (smaller, "scaled_torques", ""),
    ],
)
def test_what_is_advised_cures(
    run: jid.RobotRecording,
    tmp_path: Path,
    capsys: pytest.CaptureFixture[str],
    monkeypatch: pytest.MonkeyPatch,
    defect: object,
    code: str,
    worst: str,
) -> None:
    monkeypatch.chdir(tmp_path)
    log = saved(run, Path("arm.csv"), **defect(run))  # type: ignore[operator]
    line = ["identify", str(log), "--robot", str(small_arm.urdf(Path()))]
    main([*line, "--model", "coulomb_viscous", "--save", "arm.json"])
    lines = capsys.readouterr().out.splitlines()
    assert len(lines) <= 8 + 2
    assert lines[-1] == "estimate: arm.json"
    assert f"why: jointid explain {code} arm.json" in lines
    assert max(len(each) for each in lines if "do:" not in each) <= 100
    assert not worst or next(each for each in lines if "coulomb" in each).split()[0] == worst
    main(["explain", code, "arm.json"])
    told = capsys.readouterr().out
    assert f"({code}): " in told
    assert f"{code} of a robot" in told
    (act,) = [each.strip().removeprefix("do: ") for each in lines if "do:" in each]
    if act.startswith("jointid "):
        again = shlex.split(act)[1:]
    else:
        written = re.match(r"write (.*) in robot.toml, and add --facts robot.toml", act)
        assert written
        Path("robot.toml").write_text(f"{written[1]}\n", encoding="utf-8")
        again = [*line, "--model", "coulomb_viscous", "--facts", "robot.toml"]
    assert main(again) == 0
    assert capsys.readouterr().out.startswith("small: usable\n")


def test_what_a_comparison_advises_is_a_command_that_identifies(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    true = small_arm.URDF.replace('mass value="3"', 'mass value="4"')
    run = small_arm.recording(small_arm.urdf(tmp_path, true), duration=5.0)
    line = ["compare", str(saved(run, Path("arm.csv"))), "--robot", str(small_arm.urdf(Path()))]
    assert not main([*line, "--inertia", "urdf", "--model", "coulomb_viscous", "--folds", "3"])
    out = capsys.readouterr().out
    (act,) = re.findall(r"do: jointid (.*)", out)
    assert act == "identify arm.csv --robot small.urdf --inertia scaled"
    assert main(shlex.split(act)) == 0
    assert "wrong_inertia" not in capsys.readouterr().out


def test_titles_are_short_even_of_long_names(run: jid.RobotRecording, tmp_path: Path) -> None:
    names = ("shoulder_pan_joint", "shoulder_lift_joint")
    text = small_arm.URDF
    for short, name in zip(run.names, names, strict=True):
        text = text.replace(f'joint name="{short}"', f'joint name="{name}"')
    robot = jid.Robot.from_urdf(small_arm.urdf(tmp_path, text))
    swapped = {"torque": np.asarray(run.torque)[:, ::-1]}
    found: list[Finding] = []
    for change in (reversed_torque(run), in_degrees(run), off(run), smaller(run), swapped):
        fields = {"time": run.time, "position": run.position, "torque": run.torque}
        recording = jid.RobotRecording(**{**fields, "names": names, **change})  # type: ignore[arg-type]
        found += jid.identify_robot(recording, robot, model="coulomb_viscous").findings
    assert {"swapped_torques", "wrong_zero"} <= {each.code for each in found}
    assert [each.title for each in found if len(each.title) > 90] == []
    assert {each.code for each in found} <= TYPES.keys()
