"""Candidates compared on torque that they were not fitted to."""

import json
from pathlib import Path

import numpy as np
import pytest
from small_arm import ROTOR, URDF, recording, urdf

import jointid as jid
from jointid.cli import main

pytest.importorskip("pinocchio")

SHORT = 8.0  # [s]


@pytest.fixture(name="path", scope="module")
def _path(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return urdf(tmp_path_factory.mktemp("small"))


def mixed(path: Path) -> jid.RobotRecording:
    """Static friction at the elbow alone."""
    plain, rich = (recording(path, static=static, duration=SHORT) for static in (0.0, 0.5))
    assert plain.torque is not None
    assert rich.torque is not None
    both = np.column_stack([plain.torque[:, 0], rich.torque[:, 1]])
    return jid.RobotRecording(**{**plain.fields(), "torque": both})


@pytest.fixture(name="found", scope="module")
def _found(path: Path) -> jid.RobotComparison:
    robot = jid.Robot.from_urdf(path, rotor_inertias=list(ROTOR))
    return jid.compare_robot_models(mixed(path), robot)


def test_each_joint_has_its_model(found: jid.RobotComparison) -> None:
    assert [(row.inertia, row.model) for row in found.rows] == [
        (inertia, model)
        for inertia in ("urdf", "scaled", "free")
        for model in ("coulomb_viscous", "stribeck")
    ]
    assert (
        found.winner.inertia == "urdf"
    )  # no other explains more, and it has the fewest parameters
    assert found.models == {"shoulder": "coulomb_viscous", "elbow": "stribeck"}
    models = {name: joint.model for name, joint in found.estimate.joints.items()}
    assert models == found.models
    plain, rich = found.rows[:2]
    assert np.mean(plain.joints["elbow"]) > 3.0 * np.mean(rich.joints["elbow"])
    assert plain.parameters == rich.parameters - 4 == 6


def test_a_wrong_urdf_loses(path: Path, tmp_path: Path) -> None:
    wrong = urdf(tmp_path, URDF.replace('mass value="3"', 'mass value="2"'))
    robot = jid.Robot.from_urdf(wrong, rotor_inertias=list(ROTOR))
    run = recording(path, duration=SHORT)
    found = jid.compare_robot_models(run, robot, models=["coulomb_viscous"], folds=3)
    assert found.winner.inertia == "free"
    assert "worse than the best" in found.rows[0].reason
    assert found.settings["folds"] == 3


def test_held_out_torque_is_not_fitted(path: Path) -> None:
    """Another torque in one block changes that block's score with the values of all others."""
    run = recording(path, duration=SHORT)
    assert run.torque is not None
    torque = run.torque.copy()
    last = run.time > 0.85 * SHORT
    torque[last] += 2.0 * np.sign(np.gradient(run.position[last], axis=0))
    other = jid.RobotRecording(**{**run.fields(), "torque": torque})
    robot = jid.Robot.from_urdf(path)
    before, after = (
        jid.compare_robot_models(
            each, robot, models=["coulomb_viscous"], inertia=["urdf"], folds=4, windows=0.05
        )
        for each in (run, other)
    )
    scores = after.rows[0].fold_scores
    assert scores[-1] > 5.0 * before.rows[0].fold_scores[-1]
    # The others are told by values that the changed torque pulled.
    assert all(
        each > 1.5 * was for each, was in zip(scores, before.rows[0].fold_scores, strict=True)
    )


def test_several_recordings_are_held_out_whole(path: Path) -> None:
    runs = [recording(path, duration=4.0, seed=seed) for seed in range(3)]
    found = jid.compare_robot_models(
        runs, jid.Robot.from_urdf(path), models="coulomb_viscous", inertia="urdf"
    )
    assert found.settings["held_out"] == "recording"
    assert len(found.rows[0].fold_scores) == 3
    assert "one recording held out" in found.report(verbose=True)
    both = jid.compare_robot_models(
        runs, jid.Robot.from_urdf(path), models="coulomb_viscous", inertia="urdf", folds=2
    )
    assert both.settings["held_out"] == "recordings"


def test_text_and_json_say_the_same(found: jid.RobotComparison) -> None:
    text = found.report(verbose=True)
    assert "chosen: inertia urdf, stribeck" in text
    assert "chosen" in text
    document = json.loads(found.to_json())
    assert document["winner"] == {"inertia": "urdf", "model": "stribeck"}
    assert document["models"] == dict(found.models)
    again = jid.RobotEstimate.from_json(json.dumps(document["estimate"]))
    assert again.report(verbose=True) == found.estimate.report(verbose=True)
    assert f"<b>Use {found.winner.name}: " in found._repr_html_()


@pytest.mark.parametrize(
    ("options", "argument"),
    [
        ({"inertia": "all"}, "inertia"),
        ({"inertia": []}, "inertia"),
        ({"models": ["stribeck:ripple=2"]}, "model"),
        ({"models": ["auto"]}, "models"),
        ({"models": []}, "models"),
        ({"folds": 1}, "folds"),
        ({"folds": 900}, "folds"),
    ],
)
def test_what_cannot_be_compared_is_refused(
    path: Path, options: dict[str, object], argument: str
) -> None:
    run = recording(path, duration=3.0)
    with pytest.raises(jid.InputError) as caught:
        jid.compare_robot_models(run, jid.Robot.from_urdf(path), **options)  # type: ignore[arg-type]
    assert caught.value.argument == argument


def test_one_command(path: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    log = tmp_path / "arm.csv"
    recording(path, duration=SHORT).save(log)
    page, saved = tmp_path / "arm.html", tmp_path / "arm.json"
    line = ["compare", str(log), "--robot", str(path), "--inertia", "urdf", "--folds", "3"]
    assert main([*line, "--report", str(page), "--save", str(saved)]) == 0
    out = capsys.readouterr().out
    assert out.startswith("small: inertia urdf, coulomb_viscous of 2 candidates, usable\n")
    assert out.endswith(f"report: {page}   estimate: {saved}\n")
    lines = out.splitlines()
    assert len(lines) <= 8 + 2
    assert max(map(len, lines[:-1])) <= 100
    assert main([*line, "-v"]) == 0
    assert "chosen: inertia urdf, coulomb_viscous" in capsys.readouterr().out
    assert "torque that was not used for the fit" in page.read_text(encoding="utf-8")
    assert jid.RobotEstimate.load(saved).inertia == "urdf"
    assert main([*line, "--json"]) == 0
    assert json.loads(capsys.readouterr().out)["kind"] == "jointid robot comparison"
    assert main(["compare", str(log), "--inertia", "free"]) == 2
    assert "--robot" in capsys.readouterr().err
