"""What a verb does not do for a subject is refused in one sentence that names both, and nothing internal."""

import re
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
import simulated_servo
import small_arm
from example_recordings import WELL_EXCITED

import jointid as jid

INTERNAL = (
    r"identify_\w+|compare_\w+|load_\w+|design_excitation|rollout\(|motion_after|takes \d|NoneType"
)


class Bench:
    """All subjects, with recordings of them."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self.run = jid.load(WELL_EXCITED)
        self.joint = jid.thesis_joint()
        self.estimate = jid.identify(self.run, self.joint)
        self.runs = simulated_servo.bench_runs(simulated_servo.Truth(), seed=1)
        self.servo = simulated_servo.servo_joint()
        self.servo_estimate = jid.identify(self.runs, self.servo, draws=0)
        urdf = small_arm.urdf(folder)
        self.arm = small_arm.recording(urdf, duration=6.0)
        self.robot = jid.Robot.from_urdf(urdf)
        self.robot_estimate = jid.identify(self.arm, self.robot)
        self.joint_estimates = jid.identify(self.arm, couplings=False)
        self.arm.save(folder / "arm.csv")
        self.estimate.save(folder / "estimate.json")
        self.law = jid.Pd(stiffness=8000.0, damping=400.0)
        self.motion = jid.Trajectory.thesis(duration=2.0)


@pytest.fixture(scope="module")
def bench(tmp_path_factory: pytest.TempPathFactory) -> Bench:
    pytest.importorskip("pinocchio")
    return Bench(tmp_path_factory.mktemp("bench"))


verbs: Any = jid  # what is refused is an error of types, too

CASES: dict[str, tuple[Callable[[Bench], object], str]] = {
    "several recordings of a robot, and a joint": (
        lambda b: verbs.identify([b.arm, b.arm], b.joint),
        "subject is a Joint: identify of several recordings of a robot needs a jid.Robot; give jid.Robot.from_urdf",
    ),
    "a joint's recording, and a robot": (
        lambda b: verbs.identify(b.run, b.robot),
        "recordings is a Recording: identify of a robot needs a RobotRecording, or several; jid.load(path, joints=",
    ),
    "a joint's recording, and joints by name": (
        lambda b: verbs.identify(b.run, {"elbow": b.joint}),
        "recordings is a Recording: identify with joints by name needs a RobotRecording; jid.load(path, joints=",
    ),
    "a servo's estimate as the subject": (
        lambda b: verbs.identify(b.runs, b.servo_estimate),
        "subject is a ServoEstimate: identify takes a Joint or a Robot, not a result; give its .joint",
    ),
    "a robot's estimate as the subject": (
        lambda b: verbs.compare(b.arm, b.robot_estimate),
        "subject is a RobotEstimate: compare takes a Joint or a Robot, not a result; give its .robot",
    ),
    "two subjects": (
        lambda b: verbs.identify(b.run, b.joint, joint=b.joint),
        "joint: the subject is already given",
    ),
    "a misspelt option": (
        lambda b: verbs.identify(b.run, b.joint, residul="torque"),
        "residul is 'torque': identify of a joint has no such option; did you mean 'residual'?",
    ),
    "identify: a robot's option of a joint": (
        lambda b: verbs.identify(b.run, b.joint, inertia="free"),
        "inertia is 'free': identify of a joint has no such option; its options are model, ",
    ),
    "identify: a joint's option of a servo": (
        lambda b: verbs.identify(b.runs, b.servo, search="ga"),
        "search is 'ga': identify of a servo has no such option; its options are window, ",
    ),
    "identify: a servo's option of several joints": (
        lambda b: verbs.identify(b.arm, draws=3),
        "draws is 3: identify of several joints has no such option; its options are ",
    ),
    "identify: a servo's option of a robot": (
        lambda b: verbs.identify(b.arm, b.robot, draws=3),
        "draws is 3: identify of a robot has no such option; its options are inertia, ",
    ),
    "compare: several joints": (
        lambda b: verbs.compare(b.arm),
        "recordings is a RobotRecording: compare accepts one joint or a whole robot, but not several joints; "
        "compare recordings.joint(NAME) or give jid.Robot.from_urdf(path)",
    ),
    "compare: a joint's option of a servo": (
        lambda b: verbs.compare(b.runs, b.servo, folds=2),
        "folds is 2: compare of a servo has no such option; its options are models, groups, ",
    ),
    "compare: a servo's option of a robot": (
        lambda b: verbs.compare(b.arm, b.robot, groups=[1]),
        "groups is [1]: compare of a robot has no such option; its options are models, ",
    ),
    "compare: a score of a robot": (
        lambda b: verbs.compare(b.arm, b.robot, score="windows"),
        "score is 'windows': compare of a robot has no such option",
    ),
    "compare: no such score": (
        lambda b: verbs.compare(b.run, b.joint, score="best"),
        "score is 'best': windows or rollout is expected",
    ),
    "compare: the closed loop of a joint": (
        lambda b: verbs.compare(b.run, b.joint, score="rollout"),
        "joint 'thesis joint': voltage: the joint's input is not a voltage",
    ),
    "compare: the torque of a servo without one": (
        lambda b: verbs.compare(b.runs, b.servo, score="windows"),
        "model 'coulomb_viscous': the recording has no signal torque, motor_torque or current; identify the "
        "recordings of this joint separately",
    ),
    "load: an option of one joint": (
        lambda b: verbs.load(b.folder / "arm.csv", joints="all", drop_copies=True),
        "drop_copies is True: load of several joints has no such option; its options are columns, ",
    ),
    "load: an option of one run": (
        lambda b: verbs.load(b.folder / "arm.csv", by="run", where={}),
        "where is {}: load of several runs has no such option; its options are by, ",
    ),
    "load: an estimate": (
        lambda b: verbs.load(b.folder / "estimate.json"),
        "estimate.json: this is a file of a result (estimate), not a recording; jid.Result.load(path) reads it",
    ),
    "load: a joint file": (
        lambda _: verbs.load("examples/hardware/joint.toml"),
        "joint.toml: this is a file of a joint, not a recording; jid.Joint.load(path) reads it",
    ),
    "load: two files": (
        lambda _: verbs.load("a.csv", "b.csv"),
        "subject is 'b.csv': a Joint or a Robot is expected; give several files as a list",
    ),
    "load: no file": (lambda _: verbs.load([]), "path is []: at least one file is expected"),
    "load: several joints of one": (
        lambda b: verbs.load(b.folder / "arm.csv", b.joint, joints="all"),
        "subject is a Joint: load of several joints cannot use a single Joint",
    ),
    "simulate: a robot": (
        lambda b: verbs.simulate(b.robot),
        "subject is a Robot: simulate takes one joint or servo; give a jid.Joint",
    ),
    "simulate: a robot's estimate": (
        lambda b: verbs.simulate(b.robot_estimate),
        "subject is a RobotEstimate: simulate takes one joint or servo; give recordings, so that the logged torques",
    ),
    "simulate: several joints": (
        lambda b: verbs.simulate(b.joint_estimates),
        "subject is a JointEstimates: simulate takes one joint or servo; choose one: `found[NAME]`",
    ),
    "simulate: no motion": (
        lambda b: verbs.simulate(b.joint, b.law),
        "trajectory: simulate of a joint needs a controller and a trajectory; give recordings to simulate a servo",
    ),
    "simulate: a joint along logs": (
        lambda b: verbs.simulate(b.joint, recordings=b.run),
        "recordings: simulate along recordings needs a servo: a joint with a voltage as its input; give a",
    ),
    "simulate: a controller along logs": (
        lambda b: verbs.simulate(b.servo_estimate, b.law, recordings=b.runs),
        "controller is a Pd: simulate of a servo along recordings has no such option; its options are step, threads",
    ),
    "simulate: a joint's option along logs": (
        lambda b: verbs.simulate(b.servo_estimate, recordings=b.runs, seed=3),
        "seed is 3: simulate of a servo along recordings has no such option; its options are step, threads",
    ),
    "simulate: several joints' recording": (
        lambda b: verbs.simulate(b.servo_estimate, recordings=b.arm),
        "recordings is a RobotRecording: a Recording is expected",
    ),
    "design: a servo's estimate": (
        lambda b: verbs.design(b.servo_estimate),
        "subject is a ServoEstimate: design takes a Joint, or an Estimate of one joint; give the servo's joint "
        "`estimate.identified`",
    ),
    "design: a robot's estimate": (
        lambda b: verbs.design(b.robot_estimate),
        "subject is a RobotEstimate: design takes a Joint, or an Estimate of one joint; give a jid.Joint",
    ),
    "design: a robot": (
        lambda b: verbs.design(b.robot),
        "subject is a Robot: design takes a Joint, or an Estimate of one joint; give a jid.Joint",
    ),
    "design: several joints": (
        lambda b: verbs.design(b.joint_estimates),
        "subject is a JointEstimates: design takes a Joint, or an Estimate of one joint; choose one",
    ),
    "design: an option of a joint": (
        lambda b: verbs.design(b.estimate, known=1),
        "known is 1: design of an estimate has no such option; its options are ",
    ),
    "design: a misspelt option": (
        lambda b: verbs.design(b.joint, sensor=1),
        "sensor is 1: design of a joint has no such option; did you mean 'sensors'?",
    ),
    "export: several joints": (
        lambda b: verbs.export(b.joint_estimates, b.folder / "a.h"),
        "source: these are the estimates of several joints (shoulder, elbow); one estimate is expected; choose one",
    ),
}


@pytest.mark.parametrize("case", CASES)
def test_a_refusal_is_one_sentence(bench: Bench, case: str, repo: Path, monkeypatch: Any) -> None:
    monkeypatch.chdir(repo)
    call, expected = CASES[case]
    with pytest.raises(jid.InputError) as refused:
        call(bench)
    sentence = str(refused.value)
    assert expected in sentence
    assert "\n" not in sentence
    assert not re.search(INTERNAL, sentence)
