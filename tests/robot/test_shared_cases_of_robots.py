"""Whole robots' logs that other programs wrote: the plain command is right, or the one that its message prints."""

from __future__ import annotations

import shlex
import shutil
from pathlib import Path

import pytest
from shared_cases import case

import jointid as jid
from jointid.cli.command_line import main

pytest.importorskip("pinocchio")

COULOMB, VISCOUS = (4.0, 5.0, 3.0, 1.2), (6.0, 7.0, 3.5, 1.5)
GEARS = "robot-04-friction-rises-over-speed", "robot-10-friction-under-load"
SPRING = "robot-07-counterbalance-spring"


@pytest.fixture(name="folder")
def _folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, request: pytest.FixtureRequest) -> str:
    """A copy of a case, in which commands run."""
    name = str(request.param)
    shutil.copytree(case(name), tmp_path / name)
    monkeypatch.chdir(tmp_path / name)
    return name


def identified(line: str, capsys: pytest.CaptureFixture[str]) -> tuple[jid.RobotEstimate, str]:
    """What a command line saves and says."""
    saving = [] if "--save" in line else ["--save", "found.json"]
    assert main([*shlex.split(line), *saving, "--quiet"]) == 0
    return jid.RobotEstimate.load("found.json"), capsys.readouterr().out


def advised(said: str) -> str:
    """The command that an answer prints."""
    return next(
        each.split("jointid ", 1)[1] for each in said.splitlines() if "do: jointid identify" in each
    )


def check(found: jid.RobotEstimate, within: float) -> None:
    """Friction is the arm's."""
    for joint, coulomb, viscous in zip(found.joints.values(), COULOMB, VISCOUS, strict=True):
        assert joint.parameters["coulomb"].value == pytest.approx(coulomb, rel=within)
        assert joint.parameters["viscous"].value == pytest.approx(viscous, rel=within)


@pytest.mark.parametrize("folder", GEARS, indirect=True)
def test_the_printed_model_is_right(folder: str, capsys: pytest.CaptureFixture[str]) -> None:
    plain, said = identified("identify log.csv --robot arm.urdf", capsys)
    assert plain.verdict.level != "usable", folder
    found, _ = identified(advised(said), capsys)
    assert found.verdict.level == "usable"
    check(found, 0.03)


@pytest.mark.parametrize("folder", [SPRING], indirect=True)
@pytest.mark.usefixtures("folder")
def test_a_spring_is_named_and_taken(capsys: pytest.CaptureFixture[str]) -> None:
    plain, said = identified("identify log.csv --robot arm.urdf", capsys)
    assert plain.verdict.level == "not usable"
    assert "e+" not in said
    found, _ = identified(advised(said), capsys)
    check(found, 0.01)


@pytest.mark.parametrize("folder", ["robot-05-unsigned-current"], indirect=True)
@pytest.mark.usefixtures("folder")
def test_a_torque_without_sign_is_said(capsys: pytest.CaptureFixture[str]) -> None:
    found, said = identified("identify log.csv --robot arm.urdf", capsys)
    blocking = [each.code for each in found.findings if each.severity == "blocking"]
    assert blocking == ["unsigned_torque"], said
    assert "their signs are missing" in said


@pytest.mark.parametrize("folder", ["robot-06-current-taken-as-torque"], indirect=True)
@pytest.mark.parametrize("inertia", ["urdf", "scaled", "free"])
@pytest.mark.usefixtures("folder")
def test_currents_taken_as_torques_are_said(
    inertia: str, capsys: pytest.CaptureFixture[str]
) -> None:
    text = Path("log.csv").read_text(encoding="utf-8")
    head, rows = text.split("\n", 1)
    head = head.replace("current [A]", "effort [Nm]")
    Path("effort.csv").write_text(f"{head}\n{rows}", encoding="utf-8")
    line = f"identify effort.csv --robot arm.urdf --inertia {inertia}"
    found, said = identified(line, capsys)
    assert [each.code for each in found.findings] == ["scaled_torques"]
    facts = said.split("write ", 1)[1].split(" in robot.toml", 1)[0]
    Path("robot.toml").write_text(facts, encoding="utf-8")
    after, _ = identified(f"{line} --facts robot.toml", capsys)
    assert after.verdict.level == "usable"
    check(after, 0.02)


@pytest.mark.parametrize("folder", ["robot-03-commanded-positions-and-gains"], indirect=True)
@pytest.mark.usefixtures("folder")
def test_a_leg_without_torque_is_right_with_its_gains(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["identify", "log.csv", "--robot", "leg.urdf"]) == 2
    assert "drive = {kp = [" in capsys.readouterr().err
    facts = "drive = {kp = 20.0, kd = 1.5}\n"
    Path("robot.toml").write_text(facts, encoding="utf-8")
    found, _ = identified("identify log.csv --robot leg.urdf --facts robot.toml", capsys)
    truths = zip((0.008, 0.016, 0.035), (0.2, 0.2, 0.6), (0.15, 0.2, 0.2), strict=True)
    for joint, (armature, coulomb, viscous) in zip(found.joints.values(), truths, strict=True):
        values = {key: each.value for key, each in joint.parameters.items()}
        assert values["rotor_inertia"] == pytest.approx(armature, rel=0.03)
        assert values["coulomb"] == pytest.approx(coulomb, rel=0.03)
        assert values["viscous"] == pytest.approx(viscous, rel=0.03)
