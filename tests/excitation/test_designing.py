"""The search for a motion: what it promises of errors, limits, seeds and arguments."""

import _thread
import dataclasses
import math
import threading
import time
from typing import Any

import numpy as np
import pytest
from closed_loop import TRUTH, thesis_joint, wrong_controller

import jointid as jid
from jointid.excitation import designing, holding
from jointid.excitation.judging import Situation
from jointid.excitation.motion_limits import MotionLimits
from jointid.excitation.prior import ranges_of
from jointid.excitation.rehearsal import rehearse
from jointid.excitation.request import request_of

LIMITS = {"position": (-1.0, 1.0), "velocity": 3.4, "torque": 160.0}
SENSORS = jid.Sensors(torque_noise=0.5)
SETTINGS: dict[str, int] = {"evaluations": 512, "rehearsals": 40, "joints": 3}
SMALL: dict[str, int] = {"evaluations": 128, "rehearsals": 10, "joints": 2}
QUICK = jid.DesignSearch(**SMALL)


def around(factor: float = 0.2) -> dict[str, tuple[float, float]]:
    return {name: (value * (1.0 - factor), value * (1.0 + factor)) for name, value in TRUTH.items()}


def design(**changes: Any) -> jid.Design:
    given: dict[str, Any] = {
        "controller": wrong_controller(),
        "sensors": SENSORS,
        "prior": around(),
        "search": QUICK,
    }
    return jid.design_excitation(thesis_joint(), LIMITS, 6.0, **(given | changes))


@pytest.fixture(scope="module")
def found() -> jid.Design:
    return design(search=jid.DesignSearch(**SETTINGS))


def errors_of(trajectory: jid.Trajectory, runs: int, first: int = 90_000) -> dict[str, float]:
    """Relative RMS errors of default identifications, by the simulator and the seeds of this test."""
    joint = thesis_joint()
    batch = jid.simulate_batch(
        joint.with_parameters(TRUTH),
        wrong_controller(),
        trajectory,
        seeds=list(range(first, first + runs)),
        sensors=SENSORS,
        recordings=True,
    )
    squares = dict.fromkeys(TRUTH, 0.0)
    for recording in batch.recordings:
        parameters = jid.identify(recording, joint).parameters
        for name, value in TRUTH.items():
            squares[name] += (parameters[name].value / value - 1.0) ** 2 / runs
    return {name: math.sqrt(square) for name, square in squares.items()}


@pytest.mark.parametrize("runs", [24, pytest.param(60, marks=pytest.mark.slow)])
def test_the_errors_are_those_that_were_expected_and_smaller_than_of_the_usual_motion(
    found: jid.Design, runs: int
) -> None:
    counted = errors_of(found.trajectory, runs)
    usual = errors_of(jid.Trajectory.thesis(duration=6.0), runs)
    for name, expected in found.parameters.items():
        assert expected.relative == pytest.approx(counted[name], rel=0.45), name
        assert expected.stderr == pytest.approx(expected.relative * abs(TRUTH[name]))
        assert expected.worst >= expected.relative
    assert max(counted.values()) < max(usual.values())
    assert found.weakest == max(found.parameters, key=lambda n: found.parameters[n].relative)
    assert found.reference["sensor_gain"] > found.parameters["sensor_gain"].relative


def test_joints_of_the_prior_keep_the_limits(found: jid.Design) -> None:
    random = np.random.default_rng(5)
    joint = thesis_joint()
    for seed in range(6):
        values = {name: float(random.uniform(*ends)) for name, ends in around().items()}
        run = jid.simulate(
            joint.with_parameters(values),
            wrong_controller(),
            found.trajectory,
            sensors=SENSORS,
            integration_step=1e-4,
            seed=seed,
        )
        true = run.truth.signals
        assert -1.0 <= true["position"].min() <= true["position"].max() <= 1.0
        assert np.abs(true["velocity"]).max() <= 3.4
        assert run.metadata["saturations"] == 0
    for share in found.shares.values():
        assert share <= 1.0


def test_the_motion_starts_and_ends_at_rest(found: jid.Design) -> None:
    position, velocity, acceleration = found.trajectory.sample([0.0, 6.0])
    assert velocity == pytest.approx([0.0, 0.0], abs=1e-12)
    assert acceleration == pytest.approx([0.0, 0.0], abs=1e-9)
    assert position[0] == position[1]


@pytest.mark.parametrize(
    "settings", [SMALL, pytest.param(SETTINGS, marks=pytest.mark.slow)], ids=["small", "large"]
)
def test_a_seed_gives_the_same_motion_on_any_number_of_threads(settings: dict[str, int]) -> None:
    first, again, other = (
        design(search=jid.DesignSearch(**settings, **more))
        for more in ({}, {"threads": 1}, {"seed": 1})
    )
    assert again.trajectory == first.trajectory
    assert again.to_dict() == first.to_dict()
    assert other.trajectory != first.trajectory


def test_known_information_makes_the_errors_smaller(found: jid.Design) -> None:
    names = ("sensor_gain", "sensor_offset")
    known = jid.Known(names=names, information=np.diag([1.0 / 0.001**2, 1.0 / 0.005**2]))
    with_it = design(known=known)
    assert with_it.parameters["sensor_gain"].stderr <= 0.001
    assert with_it.parameters["sensor_offset"].stderr <= 0.005
    rest = [with_it.parameters[n].relative for n in TRUTH if n not in names]
    assert max(rest) < 2.0 * max(found.parameters[n].relative for n in TRUTH)


def test_what_is_asked_for_decides_the_motion(found: jid.Design) -> None:
    viscous = design(parameters=["viscous"])
    assert set(viscous.parameters) == {"viscous"}
    assert viscous.weakest == "viscous"
    assert viscous.parameters["viscous"].relative < 0.7 * found.parameters["viscous"].relative


def test_the_determinant_is_another_criterion(found: jid.Design) -> None:
    other = design(criterion="determinant")

    assert other.trajectory != found.trajectory
    usual = sum(math.log(other.reference[name]) for name in other.parameters)
    assert sum(math.log(each.relative) for each in other.parameters.values()) < usual - 1.0


def test_progress_is_reported_and_true_ends_the_search() -> None:
    steps: list[jid.DesignProgress] = []
    design(callback=steps.append)
    assert [step.number for step in steps] == sorted(step.number for step in steps)
    assert steps[-1].number == steps[-1].total
    assert all(step.best > 0.0 for step in steps)
    short = design(callback=lambda _: True)
    assert short.evaluations < 0.5 * steps[-1].total


@pytest.mark.parametrize("phase", ["search", "rehearsal", "limits"])
def test_little_is_done_after_ctrl_c(phase: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """Each phase would take minutes. What counts is the work behind the signal: no other load can add to it."""
    settings = {"evaluations": 64, "rehearsals": 10, "joints": 2}
    settings |= {"search": {"evaluations": 5_000_000}, "rehearsal": {"rehearsals": 100_000}}.get(
        phase, {}
    )
    if phase == "limits":
        monkeypatch.setattr(holding, "_JOINTS", 20_000)
    begun = threading.Event()
    asked: list[float] = []
    for name in ("rehearse", "shrunk"):
        original = getattr(designing, name)

        def marked(*given: Any, original: Any = original, name: str = name, **more: Any) -> Any:
            if (name, phase) in (("shrunk", "limits"), ("rehearse", "rehearsal")):
                begun.set()
            return original(*given, **more)

        monkeypatch.setattr(designing, name, marked)

    def interrupt() -> None:
        begun.wait(120.0)
        # A moment later, at any place of the phase.
        threading.Event().wait(0.3)
        asked.append(time.process_time())
        _thread.interrupt_main()

    def observe(_: jid.DesignProgress) -> bool:
        if phase == "search":
            begun.set()
        return False

    threading.Thread(target=interrupt, daemon=True).start()
    with pytest.raises(KeyboardInterrupt):
        jid.design_excitation(
            thesis_joint(),
            LIMITS,
            sensors=SENSORS,
            search=jid.DesignSearch(**settings, threads=2),
            callback=observe,
        )
    # Two threads that go on for a tenth of a second.
    assert time.process_time() - asked[0] < 0.2


def test_information_says_what_simulated_recordings_show() -> None:
    """The judge's errors, from a noise-free run, are those that identifications have."""
    joint = thesis_joint()
    request = request_of(joint, None)
    situation = Situation(
        joint=joint,
        request=request,
        ranges=ranges_of(joint, request.names, around()),
        limits=MotionLimits.of(LIMITS, joint),
        controller=wrong_controller(),
        sensors=SENSORS,
        duration=12.0,
        control_period=1e-3,
        criterion="worst",
        known=np.zeros((6, 6)),
    )
    motion = jid.Trajectory.thesis(0.6, cycle=4.0)
    values = {name: TRUTH[name] for name in request.names}
    judged = situation.judge([values]).judge(motion.core)[0]
    counted = rehearse(situation, motion, values, 80).rms()
    ratios = [
        error * abs(values[name]) / counted[name]
        for name, error in zip(request.names, judged.errors, strict=True)
    ]
    assert 0.7 < min(ratios) <= max(ratios) < 1.35


def test_references_keep_their_bounds_between_samples() -> None:
    """Genes drawn at random, and the corners of their box."""
    joint = thesis_joint()
    request = request_of(joint, None)
    situation = Situation(
        joint=joint,
        request=request,
        ranges=ranges_of(joint, request.names, around()),
        limits=MotionLimits.of({**LIMITS, "acceleration": 25.0}, joint),
        controller=wrong_controller(),
        sensors=SENSORS,
        duration=5.0,
        control_period=1e-3,
        criterion="worst",
        known=np.zeros((6, 6)),
    )
    judge = situation.judge([dict(TRUTH)])
    random = np.random.default_rng(0)
    time = np.linspace(0.0, 5.0, 50_001)
    for number in range(40):
        genes = random.random(judge.genes)
        if number % 4 == 0:
            genes = np.round(genes)
        position, velocity, acceleration = jid.Trajectory.sines(**judge.motion(genes)).sample(time)
        assert -1.0 < position.min() <= position.max() < 1.0
        assert np.abs(velocity).max() < 3.4
        assert np.abs(acceleration).max() < 25.0


def test_the_drawn_joints_fill_their_ranges_evenly() -> None:
    joint = thesis_joint()
    names = request_of(joint, None).names
    drawn = ranges_of(joint, names, around()).joints(11, 0)
    assert drawn[0] == pytest.approx(TRUTH)
    for name, (low, high) in around().items():
        shares = sorted((each[name] - low) / (high - low) for each in drawn[1:])
        assert shares == pytest.approx((np.arange(10) + 0.5) / 10)
    assert ranges_of(joint, names, around()).joints(11, 0) == drawn


def test_a_prior_may_lie_beyond_the_bounds_of_a_search() -> None:
    beyond = design(prior={**around(), "coulomb": (55.0, 70.0)})
    assert beyond.status == "complete"
    assert beyond.parameters["coulomb"].value == pytest.approx(62.5)
    assert beyond.parameters["coulomb"].relative < 0.01


def test_without_sensors_and_controller_both_are_assumed() -> None:
    found = jid.design_excitation(thesis_joint(), LIMITS, 4.0, search=QUICK)
    assert found.sensors.torque_noise == pytest.approx(0.003 * 160.0)
    assert isinstance(found.controller, jid.AdaptiveRobust)
    assert not found.controller.torque_feedback


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"criterion": "best"}, "worst, determinant"),
        ({"parameters": ["inertia"]}, "free"),
        ({"parameters": []}, "at least one"),
        ({"prior": {"coulomp": (1.0, 2.0)}}, "coulomb"),
        ({"prior": {"coulomb": (2.0, 1.0)}}, "below the second"),
        ({"prior": {"coulomb": 3.0}}, "lowest and a highest"),
        ({"prior": [{"coulomb": 3.0}]}, "each free parameter"),
        ({"prior": []}, "at least one joint"),
        ({"search": 5}, "DesignSearch"),
    ],
)
def test_wrong_arguments_are_refused_in_a_sentence(changes: dict[str, Any], words: str) -> None:
    with pytest.raises(jid.InputError, match=words):
        design(**changes)


def test_a_parameter_without_a_range_is_asked_for() -> None:
    joint = thesis_joint()
    unbounded = joint.replace(
        parameters={n: p for n, p in joint.parameters.items() if n != "coulomb"}
    )
    with pytest.raises(jid.InputError, match=r"coulomb.*range of") as refused:
        jid.design_excitation(unbounded, LIMITS, search=QUICK)
    assert "prior" in str(refused.value)


def test_limits_that_leave_no_motion_are_refused() -> None:
    with pytest.raises(jid.InputError, match="alone may need"):
        jid.design_excitation(
            thesis_joint(), {**LIMITS, "torque": 50.0}, prior=around(), search=QUICK
        )


def test_more_torque_than_the_drive_has_is_refused() -> None:
    with pytest.raises(jid.InputError, match=r"torque.*above the drive's own limit of 159.984"):
        jid.design_excitation(
            thesis_joint(), {**LIMITS, "torque": 200.0}, prior=around(), search=QUICK
        )


def test_a_loop_that_rattles_at_its_limits_is_named() -> None:
    found = design(controller=jid.Pd(stiffness=1e12))
    assert found.status == "limits exceeded"
    assert found.reason.startswith("the torque is cut at the limit of 160 N·m, for a joint with ")
    assert found.reason in found.summary()


def test_a_loop_that_is_not_stable_is_refused() -> None:
    loose = thesis_joint(limits=jid.Limits())
    with pytest.raises(jid.InputError, match="stable"):
        jid.design_excitation(
            loose,
            {"position": (-1.0, 1.0), "velocity": 3.4, "torque": 1e100},
            4.0,
            controller=jid.Pd(stiffness=1e12),
            sensors=SENSORS,
            prior=around(),
            search=QUICK,
        )


def test_own_terms_are_refused() -> None:
    joint = thesis_joint()
    own = joint.replace(model=dataclasses.replace(joint.model, terms={"q6": "viscous"}))
    with pytest.raises(jid.InputError, match="own terms"):
        jid.design_excitation(own, LIMITS, search=QUICK)
