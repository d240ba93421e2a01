"""Several joints identified from one recording: each as if alone, and what couples them."""

import _thread
import json
import threading
import time
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from moving_joints import recorded, sines, torques

import jointid as jid
from jointid.joints.record import JointResult
from jointid.joints.tables import value_with_error


def coupled(seed: int, strength: float = 1.0) -> jid.RobotRecording:
    """Two joints; the second one's friction acts on the first, too."""
    motion = sines(2, seed)
    torque = torques(motion, seed, unmodelled=0.3)
    other = motion.velocity[:, 1]
    torque[:, 0] += strength * (np.sign(other) + 0.5 * other)
    return recorded(motion, torque, names=["elbow", "wrist"])


@pytest.fixture(scope="module")
def robot() -> jid.RobotRecording:
    motion = sines(3, 5)
    return recorded(motion, torques(motion, 5), name="arm")


@pytest.fixture(scope="module")
def found(robot: jid.RobotRecording) -> jid.JointEstimates:
    return jid.identify_joints(robot)


def test_each_joint_as_if_alone(robot: jid.RobotRecording, found: jid.JointEstimates) -> None:
    assert list(found) == ["1", "2", "3"]
    for name, estimate in found.items():
        alone = jid.identify(robot[name])
        values = {each: p.value for each, p in estimate.parameters.items()}
        assert values == {each: p.value for each, p in alone.parameters.items()}


def test_known_parameters_come_back(found: jid.JointEstimates) -> None:
    random = np.random.default_rng([5, 1])
    inertia, coulomb = random.uniform(0.5, 2.0, 3), random.uniform(3.0, 8.0, 3)
    viscous = random.uniform(2.0, 8.0, 3)
    for number, estimate in enumerate(found.values()):
        for name, truth in (("inertia", inertia), ("coulomb", coulomb), ("viscous", viscous)):
            assert estimate.parameters[name].value == pytest.approx(truth[number], rel=0.03)


def test_the_threads_do_not_change_a_bit(
    robot: jid.RobotRecording, found: jid.JointEstimates
) -> None:
    again = jid.identify_joints(robot, search=jid.Search(threads=1))
    for name, estimate in again.items():
        values = [p.value for p in estimate.parameters.values()]
        assert values == [p.value for p in found[name].parameters.values()]
        assert again.results[name].others == found.results[name].others


def test_a_coupled_pair_is_found_and_named() -> None:
    found = jid.identify_joints(coupled(1))
    (share, *_) = found.results["elbow"].others
    assert (share.joint, share.by, share.certain) == ("wrist", "speed", True)
    assert 0.5 < share.share <= 1.0
    assert any(
        text.startswith("joint wrist's speed explains") and "of joint elbow's residual" in text
        for text in found.sentences()
    )
    assert not any(each.certain for each in found.results["wrist"].others)
    unexplained = [
        each for each in found["elbow"].findings if each.code in ("structured_residual", "poor_fit")
    ]
    assert unexplained
    for finding in unexplained:
        assert "joint wrist's speed explains" in finding.cause
        assert "known causes" not in finding.cause
        assert finding.evidence["explained_by_others"].value == found.results["elbow"].explained
    alone = jid.identify(coupled(1).joint("elbow"))
    assert [each.code for each in alone.findings] == [each.code for each in found["elbow"].findings]


@pytest.mark.parametrize(
    ("seed", "unmodelled", "alike"),
    # Some explain a tenth out of sample, by chance: without the comparison with shifted motion they would claim it.
    [(0, 0.0, False), (4, 0.0, False), (1, 1.0, True), (2, 1.0, False)],
)
def test_independent_joints_are_not_coupled(seed: int, unmodelled: float, alike: bool) -> None:
    """Of 300 joints, most with effects that no model here has, 10 were said to owe something to another one."""
    motion = sines(3, seed, alike=alike)
    robot = recorded(motion, torques(motion, seed, unmodelled=unmodelled))
    found = jid.identify_joints(robot, search="separable")
    assert found.sentences() == ()


def test_what_the_own_motion_explains_is_not_credited_to_another_joint() -> None:
    motion = sines(2, 7)
    first = motion.position[:, 0]
    # The second joint follows the first one, as in a motion that is planned for both.
    for array in (motion.position, motion.velocity, motion.acceleration):
        array[:, 1] = 0.8 * array[:, 0] + 0.05 * array[:, 1]
    torque = torques(motion, 7)
    torque[:, 0] += 3.0 * np.sin(2.0 * first)  # of the first joint alone, and no model here has it
    found = jid.identify_joints(
        recorded(motion, torque), model="coulomb_viscous", search="separable"
    )
    assert found["1"].residuals.relative > 0.1
    assert found.results["1"].explained == 0.0


def test_one_joint_that_fails_does_not_lose_the_others() -> None:
    motion = sines(3, 2)
    position = motion.position.copy()
    position[:, 1] = 0.25  # it stands still
    robot = jid.RobotRecording(time=motion.time, position=position, torque=torques(motion, 2))
    found = jid.identify_joints(robot)
    assert found.failed == ("2",)
    assert [each.status for each in found.results.values()] == [
        "identified",
        "failed",
        "identified",
    ]
    assert "joint 2" in str(found.results["2"].error)
    assert "joint 2 failed: recording 0 (joint 2): the joint never" in found.report()
    assert "no warnings" not in found.report()
    assert list(found) == ["1", "3"]
    with pytest.raises(KeyError, match="failed"):
        found["2"]


def test_some_joints_of_a_recording(robot: jid.RobotRecording) -> None:
    found = jid.identify_joints(robot, joints=[3], couplings=False)
    assert list(found) == ["3"]
    assert found[3] is found["3"]
    with pytest.raises(KeyError, match="the only one is 3"):
        found["4"]
    with pytest.raises(jid.InputError, match="no such joint"):
        jid.identify_joints(robot, joints=[4])
    with pytest.raises(jid.InputError, match="at least one"):
        jid.identify_joints(robot, joints=[])


def test_gear_ratios_of_the_joints_are_used_once() -> None:
    motion = sines(2, 3)
    torque = torques(motion, 3)
    ratios = np.array([50.0, -30.0])
    at_motor = jid.RobotRecording(
        time=motion.time, position=motion.position * ratios, torque=torque / ratios, side="motor"
    )
    at_joint = recorded(motion, torque)
    expected = jid.identify_joints(at_joint, couplings=False)
    joints = {"1": jid.Joint(gear_ratio=50.0), "2": jid.Joint(gear_ratio=-30.0)}
    for found in (
        jid.identify_joints(at_motor, joint=joints, couplings=False),
        jid.identify_joints(at_motor.with_gear_ratio(ratios), couplings=False),
        jid.identify_joints(at_motor.with_gear_ratio(ratios), joint=joints, couplings=False),
    ):
        for name, estimate in found.items():
            for each in ("coulomb", "viscous", "inertia"):
                value = expected[name].parameters[each].value
                assert estimate.parameters[each].value == pytest.approx(value, rel=1e-6)
    with pytest.raises(jid.InputError, match="state the gear ratio only once"):
        jid.identify_joints(at_motor.with_gear_ratio([50.0, 30.0]), joint=joints)


def test_without_ratios_the_motors_side_is_told() -> None:
    motion = sines(2, 3)
    robot = recorded(motion, torques(motion, 3), side="motor")
    found = jid.identify_joints(robot)
    assert {each.side for each in found.results.values()} == {"motor"}
    assert (
        "no gear ratio is known: the values of joints 1, 2 are on the motor side"
        in found.report(verbose=True)
    )
    assert found.report().startswith(
        "robot, 2 joints: usable (on the motor side, because no gear ratio is known)"
    )


def test_the_result_as_json(found: jid.JointEstimates, tmp_path: Path) -> None:
    document = json.loads(found.to_json())
    assert document == found.document()
    assert (document["kind"], document["schema"]) == ("jointid joints", 1)
    first = document["joints"]["1"]
    assert first["status"] == "identified"
    assert (
        first["estimate"]["parameters"]["coulomb"]["value"]
        == found["1"].parameters["coulomb"].value
    )
    path = found.save(tmp_path / "arm.json")
    assert json.loads(path.read_text(encoding="utf-8")) == document
    with pytest.raises(jid.InputError, match="json"):
        found.save(tmp_path / "arm.toml")


def test_the_table(found: jid.JointEstimates) -> None:
    lines = found.report(verbose=True).splitlines()
    assert lines[0] == "jointid estimates — arm"
    assert lines[2].split()[:3] == ["joint", "model", "coulomb"]
    assert [line.split()[0] for line in lines[4:7]] == ["1", "2", "3"]
    assert "±" in lines[4]


@pytest.mark.parametrize(
    ("value", "stderr", "at_bound", "shown"),
    [
        (8.676e-13, None, "min", "0 (at bound)"),
        (8.676e-13, 3.1e-07, None, "0 ± "),
        (7.74, 0.21, None, "7.74 ± 0.21"),
        (5.0, None, "max", "5 (at bound)"),
    ],
)
def test_a_value_that_is_nothing_is_shown_as_zero(
    value: float, stderr: float | None, at_bound: str | None, shown: str, found: jid.JointEstimates
) -> None:
    inertia = next(iter(found.values())).parameters["inertia"]
    changed = replace(inertia, value=value, stderr=stderr, at_bound=at_bound)
    assert value_with_error(changed).startswith(shown)


def test_no_recording_of_a_robot() -> None:
    with pytest.raises(jid.InputError, match="RobotRecording"):
        jid.identify_joints("arm.csv")  # type: ignore[arg-type]


def test_a_search_says_what_to_do_with_several_joints(robot: jid.RobotRecording) -> None:
    with pytest.raises(jid.InputError, match="name a joint"):
        jid.sweep(robot, grid={"windows": [100]})  # type: ignore[arg-type]


def test_a_failed_joint_says_nothing_of_others() -> None:
    assert JointResult(name="1", status="failed").sentences() == ()


def test_ctrl_c_ends_it(robot: jid.RobotRecording) -> None:
    ended: list[float] = []

    def interrupt(joint: str, number: int, count: int) -> None:
        if number == 0:
            threading.Timer(0.5, end).start()

    def end() -> None:
        ended.append(time.perf_counter())
        _thread.interrupt_main()

    slow = jid.Search(ga=jid.GaOptions(population=400, generations=100_000))
    with pytest.raises(KeyboardInterrupt):
        jid.identify_joints(
            robot,
            model="stribeck",
            search=slow,
            callback=interrupt,
        )
    assert time.perf_counter() - ended[0] < 2.0  # 0.1 s on a machine with nothing else to do


@pytest.mark.parametrize(
    "joints", [[2, 3], pytest.param([1, 2, 3, 4, 5, 6], marks=pytest.mark.slow)], ids=len
)
def test_tx40(shared_data: Path, joints: list[int]) -> None:
    """The wrist is coupled: the drive of joint 6 turns with joints 5 and 6."""
    ratios = [[32, 32, 45, -48, 45, 32][joint - 1] for joint in joints]
    robot = jid.load_robot(shared_data / "tx40" / "tx40.csv.gz", joints, gear_ratio=ratios)
    found = jid.identify_joints(robot, search="separable")
    assert list(found) == [str(joint) for joint in joints]
    shares = {name: each.others for name, each in found.results.items()}
    # Gravity of the two parallel links.
    assert (shares["2"][0].joint, shares["2"][0].by) == ("3", "position")
    assert shares["3"][0].joint == "2"
    if 6 in joints:
        assert next((each.joint, each.by) for each in shares["5"] if each.certain) == ("6", "speed")
        assert "5" in {each.joint for each in shares["6"]}
        # The inertia about the vertical axis.
        assert {each.joint for each in shares["1"]} == {"2", "3"}


def test_kr300(shared_data: Path) -> None:
    robot = jid.load_robot(
        shared_data / "kr300" / "kr300_A.csv.gz", [1, 2, 3], gear_ratio=[256.86, 267.43, 252.33]
    )
    found = jid.identify_joints(robot)
    assert found["1"].parameters["coulomb"].value == pytest.approx(388.0, rel=0.05)
    assert "explains" in "".join(found.sentences())


def test_a_log_of_wanted_positions_names_the_way_by_the_whole_robot() -> None:
    motion = sines(3, 2)
    bare = jid.RobotRecording(time=motion.time, position=motion.position)
    driven = jid.RobotRecording(
        time=motion.time, position=motion.position, reference=motion.position
    )
    said = [jid.identify_joints(each).report() for each in (bare, driven)]
    assert "joint 1 failed: torque: the recording has no signal torque; " in said[0]
    assert ["a position drive in the robot's facts" in each for each in said] == [False, True]
