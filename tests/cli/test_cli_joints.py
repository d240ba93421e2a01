"""Several joints on the command line: `identify --joints`, and one of them for the other commands."""

import json
from pathlib import Path

import numpy as np
import numpy.typing as npt
import pytest
from moving_joints import recorded, sines, torques

import jointid as jid
from jointid.cli import main


@pytest.fixture(scope="module")
def arm(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A file with two joints, the second one's friction acting on the first."""
    motion = sines(2, 1, duration=8.0)
    torque = torques(motion, 1)
    torque[:, 0] += motion.velocity[:, 1]
    path = tmp_path_factory.mktemp("arm") / "arm.csv"
    recorded(motion, torque).save(path)
    return path


def ran(capsys: pytest.CaptureFixture[str], *arguments: object) -> tuple[int, str, str]:
    code = main([str(each) for each in arguments])
    shown = capsys.readouterr()
    return code, shown.out, shown.err


def test_all_joints(arm: Path, capsys: pytest.CaptureFixture[str], tmp_path: Path) -> None:
    page, saved = tmp_path / "arm.html", tmp_path / "arm.json"
    code, out, _ = ran(
        capsys, "identify", arm, "--joints", "all", "--report", page, "--save", saved
    )
    assert code == 0
    assert out.startswith("robot, 2 joints: usable with care\n  1  usable with care  coulomb ")
    assert "joint 2's speed explains" in out
    assert out.endswith(f"report: {page}   estimate: {saved}\n")
    lines = out.splitlines()
    assert lines[4].startswith("joint 1: an effect is missing: ")
    assert len(lines) <= 8 + 2
    assert (
        max(len(line) for line in lines[:-1] if "do: " not in line and "why: " not in line) <= 100
    )
    assert json.loads(saved.read_text(encoding="utf-8"))["joints"].keys() == {"1", "2"}
    text = page.read_text(encoding="utf-8")
    # Of each joint a small map, and folded its map, its windows and its residual.
    assert text.count("<svg ") == 2 * 4
    assert '<details><summary><h2>Joint 2</h2></summary><div id="of-2">' in text
    assert '<a href="#of-2">2</a>' in text
    assert "joint 2&#x27;s speed explains" in text


def test_the_same_as_from_python(arm: Path, capsys: pytest.CaptureFixture[str]) -> None:
    code, out, _ = ran(capsys, "identify", arm, "--joints", "2,1", "--json")
    found = jid.identify_joints(jid.load_robot(arm), joints=[2, 1])
    document = json.loads(out)
    assert code == 0
    assert list(document["joints"]) == ["2", "1"]
    for name, estimate in found.items():
        value = document["joints"][name]["estimate"]["parameters"]["coulomb"]["value"]
        assert value == estimate.parameters["coulomb"].value


def test_one_joint_has_the_usual_report(arm: Path, capsys: pytest.CaptureFixture[str]) -> None:
    code, out, _ = ran(capsys, "identify", arm, "--joints", "2")
    assert code == 0
    assert out.startswith("joint 2: ")
    code, out, _ = ran(capsys, "info", arm, "--joints", "2")
    assert code == 0
    assert "position" in out


def test_gear_ratios(arm: Path, capsys: pytest.CaptureFixture[str], tmp_path: Path) -> None:
    whole = jid.load_robot(arm)
    at_motor = tmp_path / "motor.csv"
    lines = ["time_s,motor_position_1_rad,motor_position_2_rad,motor_torque_1_Nm,motor_torque_2_Nm"]
    for time, q, torque in zip(whole.time, whole.position, whole.torque, strict=True):  # type: ignore[arg-type]
        row = (time, 10.0 * q[0], -20.0 * q[1], torque[0] / 10.0, torque[1] / -20.0)
        lines.append(",".join(repr(float(each)) for each in row))
    at_motor.write_text("\n".join([*lines, ""]), encoding="utf-8")
    arguments = ("identify", at_motor, "--joints", "all", "--json", "--gear-ratio")
    code, out, _ = ran(capsys, *arguments, "10,-20")
    assert code == 0
    expected = jid.identify_joints(whole, couplings=False)
    for name, each in json.loads(out)["joints"].items():
        value = expected[name].parameters["coulomb"].value
        assert each["estimate"]["parameters"]["coulomb"]["value"] == pytest.approx(value, rel=1e-6)
    code, _, error = ran(capsys, *arguments, "1,2,3")
    assert (code, "--gear-ratio" in error) == (2, True)


def test_a_joint_file_for_each_joint(
    arm: Path, capsys: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    for name, inertia in (("1", 1.25), ("2", 0.75)):
        jid.Joint(name=f"axis {name}", inertia=inertia).save(tmp_path / f"axis_{name}.toml")
    files = tmp_path / "axis_{joint}.toml"
    code, out, _ = ran(capsys, "identify", arm, "--joints", "all", "--joint", files, "--json")
    found = json.loads(out)["joints"]
    assert code == 0
    values = [found[name]["estimate"]["parameters"]["inertia"]["value"] for name in ("1", "2")]
    assert values == [1.25, 0.75]
    (tmp_path / "axis_2.toml").unlink()
    code, _, error = ran(capsys, "identify", arm, "--joints", "all", "--joint", files)
    assert (code, "axis_2.toml" in error) == (2, True)


@pytest.mark.parametrize(
    ("arguments", "says"),
    [
        (("identify",), "load with --joints 1 (or another joint); or load with --joints all"),
        (("compare",), "2 joints (1, 2)"),
        (("identify", "--joints", "7"), "--joints 7: there is no such joint"),
        (("identify", "--joints", "1,7"), "there is no such joint"),
        (("identify", "--joints", "1,,2"), "names or numbers"),
        (("compare", "--joints", "all"), "this command reads one joint"),
        (("identify", "--joints", "all", "--causes"), "this option is for one joint"),
        (("identify", "--joints", "all", "--selftest"), "this option is for one joint"),
        (("identify", "--joints", "all", "--bootstrap"), "this option is for one joint"),
        (("identify", "--joints", "all", "--save", "x.toml"), "saved as .json"),
        (
            ("identify", "--joints", "all", "--report", "x.pdf"),
            "the file of a report ends in one of .html",
        ),
        (("identify", "--joints", "all", "--gear-ratio", "1,x"), "numbers such as"),
        (("identify", "--joints", "2", "--gear-ratio", "1,2"), "one gear ratio is expected"),
        (("identify", "--joints", "2", "--torque-constant", "1,2"), "one torque constant is"),
    ],
)
def test_what_cannot_be_done(
    arguments: tuple[str, ...], says: str, arm: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    command, *rest = arguments
    code, _, error = ran(capsys, command, arm, *rest)
    assert code == 2
    assert says in error
    assert error.count("\n") == 1


def test_a_number_that_names_no_joint(capsys: pytest.CaptureFixture[str], tmp_path: Path) -> None:
    """What is advised can be pasted."""
    motion = sines(2, 1, duration=2.0)
    robot = jid.RobotRecording(
        time=motion.time, position=motion.position, names=["elbow_joint", "wrist_3_joint"]
    )
    robot.save(path := tmp_path / "arm.csv")
    code, _, error = ran(capsys, "info", path, "--joints", "3")
    assert code == 2
    assert "there are elbow_joint, wrist_3_joint" in error
    assert "load with --joints elbow_joint (or another joint)" in error
    assert ran(capsys, "info", path, "--joints", "elbow_joint")[0] == 0
    code, _, error = ran(capsys, "identify", path, "--joints", "3,elbow_joint")
    assert (code, "load with --joints elbow_joint (or another joint)" in error) == (2, True)


def test_one_of_several_estimates(
    arm: Path, capsys: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    """Exported and reported; what is advised can be pasted."""
    found = jid.identify_joints(jid.load_robot(arm), couplings=False)
    found.save(saved := tmp_path / "robot.json")
    header, page = tmp_path / "friction.h", tmp_path / "page.html"
    exported, reported = ("export", saved, "--to", header), ("report", saved, "--output", page)
    code, _, error = ran(capsys, *exported)
    assert code == 2
    assert "estimates of 2 joints (1, 2)" in error
    assert "load with --joints 1 (or another joint)" in error
    assert ran(capsys, *reported)[0] == 0
    assert '<div id="of-2">' in page.read_text(encoding="utf-8")
    for command in (exported, reported):
        assert ran(capsys, *command, "--joints", "2")[0] == 0
        code, _, error = ran(capsys, *command, "--joints", "7")
        assert (code, "--joints 7: there is no such joint" in error) == (2, True)
    jid.export(found["2"], expected := tmp_path / "expected.h")
    assert header.read_text(encoding="utf-8") == expected.read_text(encoding="utf-8")
    assert page.is_file()
    with pytest.raises(
        jid.InputError, match=r"several joints \(1, 2\).*choose one: `source\['1'\]`"
    ):
        jid.export(found, header)  # type: ignore[arg-type]


def test_a_term_without_its_column(arm: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """Nobody typed --extra."""
    for joints in ("1", "all"):
        code, _, error = ran(capsys, "identify", arm, "--joints", joints, "--term", "q9=inertia")
        assert code == 2
        assert "--term q9: no such header" in error
        assert "--extra" not in error


def text_log(path: Path, headers: list[str], columns: list[npt.ArrayLike]) -> Path:
    np.savetxt(path, np.column_stack(columns), delimiter=",", header=",".join(headers), comments="")
    return path


def test_a_current_and_a_commanded_torque(
    arm: Path, capsys: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    """As a UR robot logs them; what is advised can be pasted."""
    robot = jid.load_robot(arm)
    headers = ["timestamp", "actual_q_0", "actual_q_1", "actual_current_0", "actual_current_1"]
    headers += ["target_moment_0", "target_moment_1"]
    torque = np.asarray(robot.torque)
    values: list[npt.ArrayLike] = [robot.time, robot.position, torque / 10.0, torque]
    log = text_log(tmp_path / "ur.csv", headers, values)
    advised = "--column torque='target_moment_{joint}' (a commanded torque)"
    for joints in (("1",), ("1", "--gear-ratio", "100"), ("all",), ("all", "--gear-ratio", "9,9")):
        code, out, error = ran(capsys, "identify", log, "--joints", *joints)
        assert code == 2
        assert advised in out + error
        assert "--torque-constant VALUE --gear-ratio RATIO (facts of motor and gear" in out + error
        column = ("--column", "torque=target_moment_{joint}")
        assert ran(capsys, "identify", log, "--joints", *joints, *column)[0] == 0


def test_a_torque_of_the_motor_needs_the_ratio(
    arm: Path, capsys: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    robot = jid.load_robot(arm)
    headers = ["time_s", "pos_1_rad", "pos_2_rad", "motor_torque_1_Nm", "motor_torque_2_Nm"]
    values: list[npt.ArrayLike] = [robot.time, robot.position, np.asarray(robot.torque) / 50.0]
    log = text_log(tmp_path / "kr.csv", headers, values)
    for joints, ratio in (("2", "50"), ("all", "50,50")):
        code, out, error = ran(capsys, "identify", log, "--joints", joints)
        assert code == 2
        assert "load with --gear-ratio RATIO (motor angle per joint angle" in out + error
        code, out, _ = ran(
            capsys, "identify", log, "--joints", joints, "--gear-ratio", ratio, "--json"
        )
        assert code == 0
        document = json.loads(out)
        estimate = document["joints"]["2"]["estimate"] if joints == "all" else document
        value = jid.identify(robot.joint(2)).parameters["coulomb"].value
        assert estimate["parameters"]["coulomb"]["value"] == pytest.approx(value, rel=1e-6)


def test_the_advice_works(arm: Path, capsys: pytest.CaptureFixture[str]) -> None:
    _, _, error = ran(capsys, "identify", arm)
    assert "--joints 1" in error
    assert ran(capsys, "identify", arm, "--joints", "1")[0] == 0
