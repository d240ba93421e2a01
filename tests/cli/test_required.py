"""`identify --require`: a verdict worse than the one asked for ends with exit code 4, and only with that option."""

from pathlib import Path

import numpy as np
import pytest
from defects import changed
from example_recordings import WELL_EXCITED

import jointid as jid
from jointid.cli import main


def ran(capsys: pytest.CaptureFixture[str], *arguments: object) -> tuple[int, str]:
    code = main(["identify", *map(str, arguments), "--quiet"])
    return code, capsys.readouterr().err


@pytest.fixture(scope="module")
def logs(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Path]:
    """A good log, one that somebody pushes, and noise."""
    run = jid.load(WELL_EXCITED)
    assert run.torque is not None
    push = 6.0 * ((run.time > 5.0) & (run.time < 5.5))
    random = 50.0 * np.random.default_rng(5).normal(size=run.torque.size)
    made = {"usable": run.torque, "care": run.torque + push, "bad": random}
    folder = tmp_path_factory.mktemp("logs")
    for name, torque in made.items():
        changed(run, torque=torque).save(folder / f"{name}.csv")
    return {name: folder / f"{name}.csv" for name in made}


def test_a_worse_verdict_exits_4_only_where_it_is_asked_for(
    logs: dict[str, Path], capsys: pytest.CaptureFixture[str]
) -> None:
    expected = {"usable": (0, 0, 0), "care": (0, 0, 4), "bad": (0, 4, 4)}
    for name, codes in expected.items():
        for option, code in zip(((), ("care",), ("usable",)), codes, strict=True):
            given = ("--require", *option) if option else ()
            found, said = ran(capsys, logs[name], "--model", "stribeck", *given)
            assert found == code, (name, option, said)
            assert ("--require needs" in said) == (code == 4)


def test_what_is_asked_for_is_written_all_the_same(
    logs: dict[str, Path], capsys: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    save = ("--save", tmp_path / "estimate.json", "--require", "care")
    code, said = ran(capsys, logs["bad"], *save)
    assert code == 4
    assert 'the verdict is "not usable", but --require needs "usable with care": ' in said
    assert (tmp_path / "estimate.json").exists()


def test_every_joint_of_a_file_counts(capsys: pytest.CaptureFixture[str], tmp_path: Path) -> None:
    from moving_joints import recorded, sines, torques

    motion = sines(2, 1, duration=8.0)
    torque = torques(motion, 1)
    torque[:, 1] = 50.0 * np.random.default_rng(5).normal(size=len(torque))
    recorded(motion, torque).save(tmp_path / "arm.csv")
    code, said = ran(capsys, tmp_path / "arm.csv", "--joints", "all", "--require", "care")
    assert code == 4
    assert "the verdict on 2 is" in said
    assert "the verdict on 1 is" not in said


def test_a_robot_has_one_verdict(capsys: pytest.CaptureFixture[str], tmp_path: Path) -> None:
    pytest.importorskip("pinocchio")
    import small_arm

    urdf = small_arm.urdf(tmp_path)
    run = small_arm.recording(urdf, duration=4.0)
    assert run.torque is not None
    noise = np.random.default_rng(1).normal(scale=5.0, size=run.torque.shape)
    noisy = jid.RobotRecording(time=run.time, position=run.position, names=run.names, torque=noise)
    noisy.save(tmp_path / "arm.csv")
    code, said = ran(capsys, tmp_path / "arm.csv", "--robot", urdf, "--require", "care")
    assert code == 4
    assert 'the verdict is "not usable"' in said
