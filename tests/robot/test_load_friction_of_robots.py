"""Friction that grows with the torque of the links: named, identified by the printed command, and judged until then."""

from __future__ import annotations

import json
import shlex
from pathlib import Path

import numpy as np
import pytest
import small_arm

import jointid as jid
from jointid.cli.command_line import main
from jointid.robot.links.inertia_modes import Inertia

pytest.importorskip("pinocchio")

SHARES = (0.15, 0.3)


@pytest.fixture(name="path", scope="module")
def _path(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return small_arm.urdf(tmp_path_factory.mktemp("loads"))


def loaded(path: Path, shares: tuple[float, float], seed: int = 0) -> jid.RobotRecording:
    """The arm, with friction of some shares of the links' torque."""
    return small_arm.recording(path, seed=seed, under_load=shares)


def off(found: jid.RobotEstimate) -> dict[str, float]:
    """How far Coulomb and viscous friction are from the truth, as shares."""
    joints = list(found.joints.values())
    return {
        f"{joint.name}.{name}": abs(joint.parameters[name].value / float(truth[k]) - 1.0)
        for k, joint in enumerate(joints)
        for name, truth in (("coulomb", small_arm.COULOMB), ("viscous", small_arm.VISCOUS))
    }


@pytest.mark.parametrize("inertia", ["urdf", "scaled", "free"])
@pytest.mark.parametrize("shares", [(0.0, SHARES[0]), (SHARES[1], SHARES[0])])
@pytest.mark.parametrize("seed", [0, 3])
def test_it_is_identified_with_its_error(
    path: Path, inertia: Inertia, shares: tuple[float, float], seed: int
) -> None:
    names = [name for name, share in zip(("shoulder", "elbow"), shares, strict=True) if share]
    models = dict.fromkeys(names, "coulomb_viscous:load_friction")
    run = loaded(path, shares, seed)
    found = jid.identify_robot(run, jid.Robot.from_urdf(path), inertia=inertia, model=models)
    assert max(off(found).values()) < 0.05
    for share, joint in zip(shares, found.joints.values(), strict=True):
        if share:
            p = joint.parameters["load_friction"]
            assert p.stderr is not None
            assert abs(p.value - share) < 0.005 + 4.0 * p.stderr
            assert p.stderr < 0.02
    assert found.verdict.level == "usable", found.report(verbose=True)


@pytest.mark.parametrize("shares", [(0.0, 0.15), (0.3, 0.15), (0.2, 0.0)])
@pytest.mark.parametrize("seed", [0, 2])
def test_the_call_that_the_finding_advises_is_right(
    path: Path, shares: tuple[float, float], seed: int
) -> None:
    run, robot = loaded(path, shares, seed), jid.Robot.from_urdf(path)
    found = jid.identify_robot(run, robot)
    told = [each for each in found.warnings if each.code == "load_friction"]
    concerned = {each.title.partition(":")[0] for each in told}
    assert concerned == {
        name for name, share in zip(("shoulder", "elbow"), shares, strict=True) if share
    }
    calls = [each.advice[0] for each in told]
    assert all(each == calls[0] for each in calls)  # one call for all of them
    again = jid.identify_robot(run, robot, **calls[0].arguments)
    assert max(off(again).values()) < 0.05
    assert again.verdict.level == "usable"


def test_values_that_it_moves_need_care_and_have_no_accuracy(path: Path) -> None:
    found = jid.identify_robot(loaded(path, (0.0, 0.15)), jid.Robot.from_urdf(path))
    use = found.verdict.uses["compensation"]
    assert use.level == "usable with care"
    assert "elbow.coulomb" in use.parameters
    assert not [name for name in use.parameters if name.startswith("shoulder.")]
    assert use.within is None


def test_the_printed_command_runs(
    path: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    run = tmp_path / "log.csv"
    loaded(path, (0.3, 0.15)).save(run)
    assert main(["identify", str(run), "--robot", str(path)]) == 0
    (line,) = [each for each in capsys.readouterr().out.splitlines() if "do: jointid" in each]
    words = shlex.split(line.partition("do: jointid ")[2])
    assert words[-2] == "--model"
    assert sorted(words[-1].partition("=")[0].split(",")) == ["elbow", "shoulder"]
    assert main([*words, "--json"]) == 0
    again = json.loads(capsys.readouterr().out)
    assert again["verdict"]["level"] == "usable"
    value = again["joints"]["elbow"]["parameters"]["coulomb"]["value"]
    assert value == pytest.approx(small_arm.COULOMB[1], rel=0.05)


@pytest.mark.parametrize(
    "text", ["elbow=", "=stribeck", "elbow=stribeck;wrist", "elbow,elbow=auto"]
)
def test_models_by_joint_are_checked(
    path: Path, tmp_path: Path, text: str, capsys: pytest.CaptureFixture[str]
) -> None:
    run = tmp_path / "log.csv"
    small_arm.recording(path, duration=1.0).save(run)
    assert main(["identify", str(run), "--robot", str(path), "--model", text]) == 2
    assert "--model" in capsys.readouterr().err


def test_it_is_saved_predicted_and_compared(path: Path, tmp_path: Path) -> None:
    robot = jid.Robot.from_urdf(path)
    run, other = (loaded(path, (0.3, 0.15), seed) for seed in (0, 5))
    model = "coulomb_viscous:load_friction"
    found = jid.identify_robot(run, robot, model=model, inertia="free")
    again = jid.RobotEstimate.load(found.save(tmp_path / "arm.json"))
    assert again.to_json() == found.to_json()
    assert again.predict(other).relative_residual < 0.02
    # Without a load there is none of it.
    alone = found.friction(np.array([[0.5, 0.5]]))[0]
    assert alone == pytest.approx(small_arm.COULOMB + 0.5 * small_arm.VISCOUS, rel=0.05)
    compared = jid.compare_robot_models(
        run, robot, models=["coulomb_viscous", model], inertia="urdf", folds=3
    )
    assert set(compared.models.values()) == {model}
    with pytest.raises(jid.InputError, match="friction under load"):
        jid.export(found, tmp_path / "new.urdf", into=path)
    jid.export(found, tmp_path / "new.urdf", into=path, approximate=True)


@pytest.mark.parametrize("seed", range(3))
def test_an_arm_without_it_has_none(path: Path, seed: int) -> None:
    found = jid.identify_robot(
        small_arm.recording(path, seed=seed),
        jid.Robot.from_urdf(path),
        model="coulomb_viscous:load_friction",
    )
    assert max(off(found).values()) < 0.05
    for joint in found.joints.values():
        assert joint.parameters["load_friction"].value < 0.01


def test_a_load_of_the_drive_is_refused(path: Path) -> None:
    with pytest.raises(jid.InputError, match="from the links' torque"):
        jid.identify_robot(
            small_arm.recording(path, duration=1.0),
            jid.Robot.from_urdf(path),
            model="stribeck:load_friction=drive",
        )
