"""Friction that differs between the directions, of one joint of an arm."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from small_arm import VISCOUS, recording, urdf

import jointid as jid
from jointid.robot.links.inertia_modes import Inertia

pytest.importorskip("pinocchio")
DIFFERENCE, OFFSET = 0.3, 0.2  # of the elbow, half of what is more in the positive direction


@pytest.fixture(name="path", scope="module")
def _path(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return urdf(tmp_path_factory.mktemp("asymmetric"))


@pytest.fixture(name="run", scope="module")
def _run(path: Path) -> jid.RobotRecording:
    run = recording(path)
    assert run.torque is not None
    torque = run.torque.copy()
    torque[:, 1] += OFFSET + DIFFERENCE * np.abs(np.gradient(run.position[:, 1], run.time))
    return jid.RobotRecording(
        time=run.time, position=run.position, torque=torque, names=list(run.names)
    )


@pytest.fixture(name="found", scope="module")
def _found(path: Path, run: jid.RobotRecording) -> jid.RobotEstimate:
    model = {"elbow": jid.Model("coulomb_viscous", asymmetric=True)}
    return jid.identify_robot(run, jid.Robot.from_urdf(path), model=model)


@pytest.mark.parametrize("inertia", ["urdf", "free"])
def test_it_comes_back(path: Path, run: jid.RobotRecording, inertia: Inertia) -> None:
    found = jid.identify_robot(
        run, jid.Robot.from_urdf(path), inertia=inertia, model={"elbow": "auto:asymmetric"}
    )
    elbow = found.joints["elbow"].parameters
    assert elbow["viscous_difference"].value == pytest.approx(DIFFERENCE, rel=0.05)
    assert elbow["viscous"].value == pytest.approx(VISCOUS[1], rel=0.03)
    assert elbow["torque_offset"].value == pytest.approx(OFFSET, rel=0.1)
    assert "viscous_difference" not in found.joints["shoulder"].parameters
    assert found.joints["elbow"].model == "coulomb_viscous:asymmetric"
    assert found.warnings == ()


def test_it_is_named_where_the_model_lacks_it(path: Path, run: jid.RobotRecording) -> None:
    found = jid.identify_robot(run, jid.Robot.from_urdf(path))
    (told,) = found.warnings
    assert told.code == "asymmetric_friction"
    assert "elbow" in told.cause
    assert "e+" not in told.cause  # 100 %, not 1e+02 %
    (advice,) = told.advice
    again = jid.identify_robot(run, jid.Robot.from_urdf(path), **advice.arguments)
    assert again.joints["elbow"].parameters["viscous_difference"].value == pytest.approx(
        DIFFERENCE, rel=0.05
    )
    plain = jid.identify_robot(recording(path), jid.Robot.from_urdf(path))
    assert plain.warnings == ()


def test_it_is_saved_predicted_and_drawn(
    found: jid.RobotEstimate, run: jid.RobotRecording, tmp_path: Path
) -> None:
    again = jid.RobotEstimate.load(found.save(tmp_path / "arm.json"))
    assert again.to_json() == found.to_json()
    ahead, back = again.friction([[0.0, 1.0], [0.0, -1.0]])[:, 1]
    assert ahead + back == pytest.approx(2.0 * DIFFERENCE, rel=0.05)
    assert again.predict(run).relative_residual < 0.01
    assert "viscous_difference" in found.report(verbose=True)
    assert found.bootstrap(20).parameters["elbow.viscous_difference"].interval is not None


def test_a_difference_below_0_is_drawn_anew(path: Path) -> None:
    run = recording(path, duration=6.0)
    fields = run.fields()
    speed = np.gradient(run.position, run.time, axis=0)
    fields["torque"] = fields["torque"] - DIFFERENCE * np.abs(speed) * [0.0, 1.0]
    model = {"elbow": "coulomb_viscous:asymmetric"}
    found = jid.identify_robot(jid.RobotRecording(**fields), jid.Robot.from_urdf(path), model=model)
    assert found.joints["elbow"].parameters["viscous_difference"].min == -np.inf
    drawn = found.bootstrap(20).parameters["elbow.viscous_difference"]
    assert drawn.interval is not None
    assert drawn.interval[0] < -DIFFERENCE * 0.95 < drawn.interval[1] + 0.05
    assert not drawn.near_bound


def test_a_urdf_has_no_place_for_it(path: Path, found: jid.RobotEstimate, tmp_path: Path) -> None:
    target = tmp_path / "arm.urdf"
    with pytest.raises(jid.InputError, match="elbow also has friction that differs"):
        jid.export(found, target, into=path)
    jid.export(found, target, into=path, approximate=True)
    assert "not in this file: friction that differs" in target.read_text(encoding="utf-8")


def test_what_a_robots_joint_has_not_is_refused(path: Path, run: jid.RobotRecording) -> None:
    with pytest.raises(jid.InputError, match="NAME:asymmetric"):
        jid.identify_robot(run, jid.Robot.from_urdf(path), model={"elbow": "stribeck:ripple=2"})


@pytest.mark.parametrize(
    "facts", ['[joints.elbow]\nmodel = "coulomb_viscous:asymmetric"', 'models.elbow = "stribeck"']
)
def test_a_file_of_facts_holds_models(
    path: Path, run: jid.RobotRecording, facts: str, tmp_path: Path
) -> None:
    file = tmp_path / "facts.toml"
    file.write_text(facts, encoding="utf-8")
    robot = jid.Robot.from_urdf(path, facts=file)
    wanted = facts.split('"')[1]
    assert robot.models == ("auto", wanted)
    assert jid.identify_robot(run, robot).joints["elbow"].model == wanted
    given = jid.identify_robot(run, robot, model={"shoulder": "stribeck"})
    assert [each.model for each in given.joints.values()] == ["stribeck", wanted]
    other = jid.identify_robot(run, robot, model="coulomb_viscous")
    assert other.joints["elbow"].model == "coulomb_viscous"


@pytest.mark.parametrize(
    ("facts", "reason"),
    [
        ('[joints.nix]\nmodel = "auto"', r"^facts\.toml: models is .nix.: the robot has no such"),
        ('[joints.elbow]\nmodel = "lugre"', r"^facts\.toml: models is .lugre"),
        ("[joints.elbow]\nratio = 3", r"^facts\.toml: joints\.elbow is .*joint's model"),
        ("models = 3", r"^facts\.toml: models is 3: a mapping from joint names to models"),
    ],
)
def test_a_model_that_does_not_fit_names_the_file(
    path: Path, facts: str, reason: str, tmp_path: Path
) -> None:
    file = tmp_path / "facts.toml"
    file.write_text(facts, encoding="utf-8")
    with pytest.raises(jid.InputError, match=reason):
        jid.Robot.from_urdf(path, facts=file)


def test_models_with_a_difference_are_compared(path: Path, run: jid.RobotRecording) -> None:
    models = ["coulomb_viscous", "coulomb_viscous:asymmetric"]
    found = jid.compare_robot_models(
        run, jid.Robot.from_urdf(path), models=models, inertia=["urdf"], folds=3
    )
    assert found.winner.model == models[1]
    assert found.models["elbow"] == models[1]
    assert "viscous_difference" in found.estimate.joints["elbow"].parameters
    assert models[1] in found.to_json()
