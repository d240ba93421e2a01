"""What users get wrong about a robot: one sentence each, which names the place."""

from pathlib import Path

import numpy as np
import pytest
from small_arm import recording, urdf

import jointid as jid

pytest.importorskip("pinocchio")


@pytest.fixture(name="path", scope="module")
def _path(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return urdf(tmp_path_factory.mktemp("small"))


@pytest.mark.parametrize(
    ("content", "reason"),
    [
        (b"x", "line 1"),
        (b"\xff\xfe\x00", "UTF-8"),
        (b"<mujoco/>", "begins with <mujoco>"),
        (b"<robot name='a'><link name='b'></robot>", "mismatched tag"),
        (b"<robot name='a'><link name='b'/></robot>", "no moving joint"),
    ],
)
def test_a_file_that_is_no_urdf(
    content: bytes, reason: str, tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    path = tmp_path / "arm.urdf"
    path.write_bytes(content)
    with pytest.raises(jid.InputError, match=reason):
        jid.Robot.from_urdf(path)
    assert capfd.readouterr().err == ""  # nobody else complains


@pytest.mark.parametrize(
    ("facts", "reason"),
    [
        ("gear_ratios = [32]", r"^facts\.toml: gear_ratios is \[32\]: 2 numbers"),
        ('joints = "elbow"', r"^facts\.toml: joints is .elbow.: a list of names"),
        ("joints = 5", r"^facts\.toml: joints is 5: a list of names"),
        ('joints = ["wrist"]', r"^facts\.toml: joints is .wrist.: .*shoulder, elbow"),
        ("[couplings]\nelbow = 3", r"^facts\.toml: couplings\.elbow is 3"),
        ('side = "link"', r"^facts\.toml: side is .link.: joint or motor"),
    ],
)
def test_a_fact_that_does_not_fit_names_its_file(
    path: Path, facts: str, reason: str, tmp_path: Path
) -> None:
    file = tmp_path / "facts.toml"
    file.write_text(facts, encoding="utf-8")
    with pytest.raises(jid.InputError, match=reason):
        jid.Robot.from_urdf(path, facts=file)


def test_an_argument_is_not_blamed_on_the_file(path: Path, tmp_path: Path) -> None:
    file = tmp_path / "facts.toml"
    file.write_text("gear_ratios = [1, 1]", encoding="utf-8")
    with pytest.raises(jid.InputError, match=r"^gear_ratios is \[3"):
        jid.Robot.from_urdf(path, gear_ratios=[3.0], facts=file)


def test_the_joint_without_torque_is_named_whatever_turns_with_it(path: Path) -> None:
    run = recording(path, duration=2.0)
    assert run.torque is not None
    lacking = run.torque * np.array([1.0, np.nan])
    motors = jid.RobotRecording(
        time=run.time, position=run.position, motor_torque=lacking, names=run.names, side="motor"
    )
    robot = jid.Robot.from_urdf(
        path, gear_ratios=[1.0, 1.0], couplings={"elbow": {"shoulder": 1.0}}
    )
    with pytest.raises(jid.InputError, match=r".elbow.: this joint has no torque"):
        jid.identify_robot(motors, robot)
    bare = jid.Robot.from_urdf(path)
    whole = jid.RobotRecording(
        time=run.time, position=run.position, motor_torque=run.torque, names=run.names, side="motor"
    )
    with pytest.raises(jid.InputError, match="gear_ratios"):
        jid.identify_robot(whole, bare)


def test_a_log_of_fewer_joints_says_which_it_has(path: Path) -> None:
    run = recording(path, duration=2.0)
    assert run.torque is not None
    one = jid.RobotRecording(
        time=run.time, position=run.position[:, :1], torque=run.torque[:, :1], names=["shoulder"]
    )
    with pytest.raises(jid.InputError, match=r"the robot has .*elbow, the recording shoulder"):
        jid.identify_robot(one, jid.Robot.from_urdf(path))
