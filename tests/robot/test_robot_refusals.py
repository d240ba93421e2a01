"""What users get wrong about a robot: one sentence each, which names the place."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from small_arm import URDF, recording, urdf

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
    ("content", "reason"),
    [
        (b"<link name='a'/>" * 1001, "at most 1000 links"),
        (b"<joint name='a'/>" * 1001, "at most 1000 joints"),
        (b"<link " + b" ".join(b"a%d='1'" % k for k in range(101)) + b"/>", "at most 100 attrib"),
        (b"<a>" * 50 + b"</a>" * 50, "at most 50 elements inside each other"),
    ],
)
def test_a_urdf_on_which_pinocchio_ends_the_process(
    content: bytes, reason: str, tmp_path: Path
) -> None:
    path = tmp_path / "arm.urdf"
    path.write_bytes(b"<robot name='a'>" + content + b"</robot>")
    with pytest.raises(jid.InputError, match=reason):
        jid.Robot.from_urdf(path)


@pytest.mark.parametrize(
    ("facts", "reason"),
    [
        (
            "gear_ratios = [32]",
            r"^facts\.toml: gear_ratios is 32.0: one gear ratio is given for 2 joints",
        ),
        (
            "torque_constants = [1, 2, 3]",
            r"^facts\.toml: torque_constants is .*: one torque constant for each",
        ),
        ('joints = "elbow"', r"^facts\.toml: joints is .elbow.: a list of names"),
        ("joints = 5", r"^facts\.toml: joints is 5: a list of names"),
        ('joints = ["wrist"]', r"^facts\.toml: joints is .wrist.: .*shoulder, elbow"),
        (
            f"gear_ratios = [{10**400}, 1]",
            r"^facts\.toml: gear_ratios\[0\]: the number is too large",
        ),
        (
            f"rotor_inertias = [{10**400}, 1]",
            r"^facts\.toml: rotor_inertias\[0\]: the number is too large",
        ),
        (f"couplings = [[1, {10**400}], [0, 1]]", r"^facts\.toml: couplings"),
        (f"[couplings.elbow]\nshoulder = {10**400}", r"^facts\.toml: couplings\.elbow\.shoulder"),
        (
            f"zero_offsets_deg = [{10**400}, 1]",
            r"^facts\.toml: zero_offsets_deg\[0\]: the number is too large",
        ),
        ("[couplings]\nelbow = 3", r"^facts\.toml: couplings\.elbow is 3"),
        (
            "[couplings.wrist]\nelbow = 3",
            r"couplings\.wrist: the robot has no such joint; it has sh",
        ),
        ("[couplings.elbow]\nwrist = 3", r"couplings\.elbow\.wrist: the robot has no such joint"),
        (
            "[couplings]\nelbow = {shoulder = 1}\nzero_offsets_deg = [0, 0]",
            r"is below \[couplings\] .*; write zero_offsets_deg above the first table",
        ),
        (
            "[couplings.elbow]\nshoulder = 1\ngear_ratios = [2, 2]",
            r"is below \[couplings.elbow\] .*; write gear_ratios above the first table",
        ),
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
    with pytest.raises(jid.InputError, match=r"^gear_ratios is 3"):
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
    with pytest.raises(jid.InputError, match="elbow has no torque"):
        jid.identify_robot(motors, robot)
    bare = jid.Robot.from_urdf(path)
    whole = jid.RobotRecording(
        time=run.time, position=run.position, motor_torque=run.torque, names=run.names, side="motor"
    )
    with pytest.raises(jid.InputError, match="needed for each of shoulder, elbow") as caught:
        jid.identify_robot(whole, bare)
    assert caught.value.argument == "gear_ratios"
    (advice,) = caught.value.remedy
    assert isinstance(advice, jid.Action)
    assert advice.arguments == {"gear_ratios": [..., ...]}


def test_a_log_of_fewer_joints_says_which_it_has(path: Path) -> None:
    run = recording(path, duration=2.0)
    assert run.torque is not None
    one = jid.RobotRecording(
        time=run.time, position=run.position[:, :1], torque=run.torque[:, :1], names=["shoulder"]
    )
    with pytest.raises(
        jid.InputError, match=r"the robot has .*elbow, the recording has shoulder"
    ) as caught:
        jid.identify_robot(one, jid.Robot.from_urdf(path))
    assert caught.value.argument == ""  # no option was typed
    (advice,) = caught.value.remedy
    assert isinstance(advice, jid.Action)
    robot = jid.Robot.from_urdf(path, **advice.arguments)
    assert robot.columns_of(one) == [0]


def test_a_log_of_none_of_the_joints_says_so(path: Path) -> None:
    run = recording(path, duration=2.0)
    one = jid.RobotRecording(time=run.time, position=run.position[:, :1], names=["wrist"])
    with pytest.raises(
        jid.InputError, match="no joint of the recording has the name of a robot joint"
    ):
        jid.Robot.from_urdf(path).columns_of(one)


def renamed(run: jid.RobotRecording, names: list[str]) -> jid.RobotRecording:
    return jid.RobotRecording(time=run.time, position=run.position, torque=run.torque, names=names)


def test_some_names_that_match_do_not_become_an_order(path: Path) -> None:
    run = renamed(recording(path, duration=2.0), ["elbow", "arm_2"])
    with pytest.raises(
        jid.InputError, match=r"lacks shoulder: .* give the recording's joints the URDF's"
    ):
        jid.identify_robot(run, jid.Robot.from_urdf(path))


def test_an_order_that_was_assumed_is_told(path: Path) -> None:
    run = renamed(recording(path), ["a", "b"])
    found = jid.identify_robot(run, jid.Robot.from_urdf(path))
    (told,) = [each for each in found.findings if each.code == "joints_in_order"]
    assert "shoulder is a, elbow is b" in told.cause


def test_a_joint_is_named_once(path: Path) -> None:
    with pytest.raises(
        jid.InputError, match=r"joints is .elbow.: each joint may be named only once"
    ):
        jid.Robot.from_urdf(path, joints=["elbow", "elbow"])


def test_joints_in_another_order_are_refused(path: Path) -> None:
    # Taken in the URDF's order, the elbow's gear ratio would be the shoulder's, and nothing would say so.
    with pytest.raises(
        jid.InputError, match=r"expected in the order of the URDF.*shoulder, elbow.*gear_ratios"
    ):
        jid.Robot.from_urdf(path, joints=["elbow", "shoulder"], gear_ratios=[100.0, 50.0])


def test_a_urdf_that_is_missing_is_named(tmp_path: Path) -> None:
    with pytest.raises(jid.InputError, match=r"missing\.urdf.*no such file"):
        jid.Robot.from_urdf(tmp_path / "missing.urdf")
    with pytest.raises(jid.InputError, match=r"cannot be read"):
        jid.Robot.from_urdf(tmp_path)


def test_a_locked_joint_that_moves_is_told(path: Path) -> None:
    robot = jid.Robot.from_urdf(path, joints=["shoulder"])
    found = jid.identify_robot(recording(path), robot)
    assert "elbow moves" in next(each for each in found.warnings).cause


def test_degrees_are_noticed(path: Path) -> None:
    run = recording(path, duration=4.0)
    degrees = jid.RobotRecording(
        time=run.time, position=np.degrees(run.position), torque=run.torque, names=run.names
    )
    found = jid.identify_robot(degrees, jid.Robot.from_urdf(path))
    (told,) = found.warnings
    assert (told.code, told.severity) == ("implausible_unit", "blocking")
    assert told.advice[0].arguments == {"units": {"position": "deg"}}


@pytest.mark.parametrize("factor", [180.0 / np.pi, np.pi / 180.0])
def test_velocity_and_position_of_different_units_are_noticed(path: Path, factor: float) -> None:
    run = recording(path, duration=4.0)
    velocity = factor * np.gradient(run.position, run.time, axis=0)
    mixed = jid.RobotRecording(
        time=run.time, position=run.position, velocity=velocity, torque=run.torque, names=run.names
    )
    found = jid.identify_robot(mixed, jid.Robot.from_urdf(path))
    told = [each.cause for each in found.warnings if each.code == "implausible_unit"]
    assert len(told) == 2
    assert told[0].startswith("the velocity of") == (factor > 1.0)


def test_a_joint_that_leaves_its_range_is_in_no_other_unit(path: Path, tmp_path: Path) -> None:
    text = URDF.replace('lower="-3" upper="3"', 'lower="-0.1" upper="0.1"')
    robot = jid.Robot.from_urdf(urdf(tmp_path, text))
    assert jid.identify_robot(recording(path, duration=4.0), robot).warnings == ()


@pytest.mark.parametrize(
    ("options", "reason"),
    [
        (
            {"windows": 100_000},
            r"windows is 100000: a duration from 0\.004 to 1\.999 seconds .*at most 499",
        ),
        ({"windows": 100.0}, r"windows is 100\.0: a duration from"),
        ({"windows": True}, r"windows is True: a duration from"),
        ({"model": {"nix": "stribeck"}}, r"model is .nix.: the robot has no such joint; it has sh"),
        ({"shift": {"torqe": 0.001}}, r"shift is .torqe.: there is no such signal"),
        ({"mask_standstill": 3}, r"mask_standstill is 3: true or false"),
    ],
)
def test_an_option_that_cannot_be_used(path: Path, options: dict[str, Any], reason: str) -> None:
    with pytest.raises(jid.InputError, match=reason):
        jid.identify_robot(recording(path, duration=2.0), jid.Robot.from_urdf(path), **options)


def test_friction_has_finite_speeds_and_no_gravity_is_told(path: Path) -> None:
    found = jid.identify_robot(
        recording(path, duration=4.0), jid.Robot.from_urdf(path, gravity=[0, 0, 0])
    )
    assert any(each.code == "no_gravity" for each in found.findings)
    with pytest.raises(jid.InputError, match="finite speeds"):
        found.friction([np.nan, 1.0])


def test_an_offset_in_radians_and_degrees_is_refused(path: Path, tmp_path: Path) -> None:
    file = tmp_path / "facts.toml"
    file.write_text("zero_offsets = [0, 0]\nzero_offsets_deg = [0, 0]", encoding="utf-8")
    with pytest.raises(jid.InputError, match=r"^facts\.toml: zero_offsets_deg .*in radians"):
        jid.Robot.from_urdf(path, facts=file)


@pytest.mark.parametrize(("number", "reason"), [(10**80, "singular"), (10**400, "large")])
def test_integers_that_numpy_has_not(number: int, reason: str, tmp_path: Path) -> None:
    path, file = urdf(tmp_path), tmp_path / "facts.toml"
    file.write_text(f"[couplings.elbow]\nshoulder = {number}", encoding="utf-8")
    with pytest.raises(jid.InputError, match=reason):
        jid.Robot.from_urdf(path, facts=file)
    for wrong in ({"rotor_inertias": [10**400, 1]}, {"couplings": [[1, 10**400], [0, 1]]}):
        with pytest.raises(jid.InputError, match="expected"):
            jid.Robot.from_urdf(path, gear_ratios=[1, 1], **wrong)


@pytest.mark.parametrize("headers", ["q1 q2", "q0 q1", "a.position b.position"])
def test_joints_that_are_listed_are_in_the_listed_order(headers: str, tmp_path: Path) -> None:
    text = URDF.replace("shoulder", "joint_1").replace("elbow", "joint_2")
    robot = jid.Robot.from_urdf(urdf(tmp_path, text))
    log = tmp_path / "log.csv"
    rows = "\n".join(f"{0.01 * k},{k},{-k}" for k in range(20))
    log.write_text(f"t,{headers.replace(' ', ',')}\n{rows}\n", encoding="utf-8")
    names = jid.load(log, robot).names
    assert robot.columns_of(jid.load(log, robot)) == [0, 1]
    listed = jid.load(log, robot, joints=names[::-1])
    assert robot.columns_of(listed) == [0, 1]
    assert listed.names == names[::-1]
    assert robot.columns_of(jid.load(log, robot).select(names[::-1])) == [0, 1]


def test_listed_joints_with_the_robots_names_keep_them(path: Path) -> None:
    run = recording(path, duration=2.0).select(["elbow", "shoulder"])
    assert jid.Robot.from_urdf(path).columns_of(run) == [1, 0]


def test_a_drive_without_wanted_positions_names_the_joints_and_the_column(path: Path) -> None:
    run = recording(path, duration=2.0)
    robot = jid.Robot.from_urdf(path, drive={"kp": 20, "kd": 1})
    wanted = run.position * np.array([1.0, np.nan])
    for reference, lacking in ((None, "shoulder, elbow"), (wanted, "elbow")):
        bare = jid.RobotRecording(
            time=run.time, position=run.position, reference=reference, names=run.names, name="leg"
        )
        reason = f"^leg: the wanted positions of {lacking} are missing.*; load with columns="
        with pytest.raises(jid.InputError, match=reason):
            jid.identify(bare, robot)
