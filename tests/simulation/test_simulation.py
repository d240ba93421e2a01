"""The simulated joint: exact at rest, SciPy's motion, the method's order, no energy from friction."""

import _thread
import itertools
import math
import pickle
import threading
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from closed_loop import (
    INERTIA,
    LINK_INERTIA,
    TRUTH,
    WEIGHT,
    thesis_joint,
    well_excited,
    wrong_controller,
)
from example_recordings import WELL_EXCITED
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.integrate import solve_ivp

import jointid as jid


@pytest.fixture(scope="module")
def joint() -> jid.Joint:
    return thesis_joint().with_parameters(TRUTH)


def test_a_joint_under_less_than_breakaway_torque_stays_bit_for_bit(joint: jid.Joint) -> None:
    push = jid.Trajectory.sine(44.0 - WEIGHT, 3.0, duration=2.0)
    recording = jid.simulate(joint, jid.OpenLoop(), push, position=0.3)
    truth = recording.truth.signals
    assert (truth["position"] == 0.3).all()
    assert (truth["velocity"] == 0.0).all()
    # The set-valued friction carries whatever the drive gives, less gravity.
    held = np.concatenate([[0.0], np.asarray(recording.torque)[:-1]]) - WEIGHT * np.sin(0.3)
    np.testing.assert_allclose(truth["friction"], held, atol=1e-12)
    np.testing.assert_allclose(truth["link_torque"], WEIGHT * np.sin(0.3), rtol=1e-12)


def test_a_little_more_breaks_it_loose(joint: jid.Joint) -> None:
    push = jid.Trajectory.step(45.001, duration=0.1)
    moved = jid.simulate(joint, jid.OpenLoop(), push)
    assert (np.diff(moved.truth.signals["position"]) > 0.0).all()


def scipy_position(joint_torque: float, control: jid.Pd | None, step: float, count: int) -> Any:
    """Positions at the control instants, torque held between them, solved by SciPy."""
    state, positions = np.array([0.0, 0.4]), []
    for k in range(count):
        positions.append(state[0])
        torque = joint_torque
        if control is not None:
            torque += control.stiffness * (1.5 * k * step - state[0]) - control.damping * state[1]

        def slope(_: float, y: Any, held: float = torque) -> list[float]:
            q, v = y
            friction = 25.0 + 20.0 * math.exp(-100.0 * v * v) + 20.0 * v
            return [v, (held - WEIGHT * math.sin(q) - friction) / (INERTIA + LINK_INERTIA)]

        state = solve_ivp(slope, (0.0, step), state, rtol=1e-10, atol=1e-13, method="DOP853").y[
            :, -1
        ]
    return np.array(positions)


def test_agrees_with_scipy_where_motion_does_not_reverse(joint: jid.Joint) -> None:
    free = joint.replace(limits=jid.Limits())
    constant = jid.Trajectory.step(75.0, duration=0.5)
    ours = jid.simulate(
        free, jid.OpenLoop(), constant, velocity=0.4, control_period=0.01, integration_step=1e-5
    )
    theirs = scipy_position(75.0, None, 0.01, len(ours))
    assert np.abs(ours.truth.signals["position"] - theirs).max() < 1e-6
    ramp = jid.Trajectory.from_samples([0.0, 0.5], [0.0, 0.75])
    law = jid.Pd(stiffness=800.0, damping=20.0)
    # The ramp's own speed is not fed back: the same law as in the reference above.
    ours = jid.simulate(
        free,
        jid.CompensatedPid(stiffness=law.stiffness, damping=law.damping, torque_feedback=False),
        ramp,
        payload=0.0,
        velocity=0.4,
        control_period=0.01,
        integration_step=1e-5,
    )
    theirs = scipy_position(law.damping * 1.5, law, 0.01, len(ours))
    assert (ours.truth.signals["velocity"] > 0.0).all()
    assert np.abs(ours.truth.signals["position"] - theirs).max() < 1e-6


def test_halving_the_step_quarters_the_error(joint: jid.Joint) -> None:
    trajectory = well_excited(3.0)

    def end(substeps: int) -> Any:
        run = jid.simulate(joint, wrong_controller(), trajectory, integration_step=1e-3 / substeps)
        return run.truth.signals["position"]

    fine = end(128)
    errors = [float(np.sqrt(np.mean((end(n) - fine) ** 2))) for n in (1, 2, 4, 8)]
    for coarse, finer in itertools.pairwise(errors):
        assert 2.5 < coarse / finer < 6.5, errors


@settings(deadline=None, max_examples=60)
@given(
    coulomb=st.floats(0.0, 60.0),
    static=st.floats(0.0, 60.0),
    stribeck=st.floats(0.0, 2000.0),
    viscous=st.floats(0.0, 50.0),
    inertia=st.floats(0.01, 5.0),
    start=st.floats(-3.0, 3.0),
    push=st.floats(0.0, 100.0),
)
def test_friction_never_adds_energy(
    coulomb: float,
    static: float,
    stribeck: float,
    viscous: float,
    inertia: float,
    start: float,
    push: float,
) -> None:
    free = jid.Joint(
        inertia=inertia,
        parameters={
            "coulomb": coulomb,  # type: ignore[dict-item]
            "static": static,  # type: ignore[dict-item]
            "stribeck": stribeck,  # type: ignore[dict-item]
            "viscous": viscous,  # type: ignore[dict-item]
        },
        model=jid.Model("stribeck"),
    )
    step = 1e-3
    run = jid.simulate(
        free,
        jid.OpenLoop(),
        jid.Trajectory.sine(push, 4.0, duration=0.5),
        velocity=start,
        control_period=step,
        integration_step=step,
    )
    true = run.truth.signals
    kinetic = 0.5 * inertia * true["velocity"] ** 2
    work = np.asarray(run.torque)[:-1] * np.diff(true["position"])
    assert (np.diff(kinetic) - work <= 1e-9 * (1.0 + kinetic.max())).all()
    assert (true["friction"] * true["velocity"] >= 0.0).all()


def test_dahl_and_lugre_hold_like_a_spring_and_slide_like_the_static_model(
    joint: jid.Joint,
) -> None:
    bristle = jid.Bristle(stiffness=5e4, damping=300.0)
    push = jid.Trajectory.sigmoid(20.0, rise=1.0, duration=2.0)
    held = jid.simulate(joint, jid.OpenLoop(), push, bristle=bristle)
    sagging = float(held.truth.signals["position"][-1])
    # z' = v - |v| z / z_max gives a deflection that grows with -log(1 - load / breakaway).
    load = 20.0 - WEIGHT * math.sin(sagging)
    assert sagging == pytest.approx(-45.0 / 5e4 * math.log(1.0 - load / 45.0), rel=1e-3)
    fast = jid.Trajectory.step(100.0, duration=1.0)
    sliding = jid.simulate(joint, jid.OpenLoop(), fast, bristle=bristle).truth.signals
    static = jid.simulate(joint, jid.OpenLoop(), fast).truth.signals
    np.testing.assert_allclose(sliding["friction"][-300:], static["friction"][-300:], rtol=5e-3)


def test_asymmetric_and_general_models_reach_their_friction() -> None:
    joint = jid.Joint(
        inertia=1.0, model=jid.Model("stribeck_general", asymmetric=True)
    ).with_parameters(
        {
            "coulomb_positive": 5.0,
            "coulomb_negative": 8.0,
            "static_positive": 2.0,
            "static_negative": 3.0,
            "viscous_positive": 4.0,
            "viscous_negative": 6.0,
            "stribeck_velocity": 0.2,
            "stribeck_exponent": 1.5,
        }
    )
    run = jid.simulate(joint, jid.OpenLoop(), jid.Trajectory.sine(30.0, 1.0, duration=2.0))
    v, friction = run.truth.signals["velocity"], run.truth.signals["friction"]
    decay = np.exp(-(np.abs(v / 0.2) ** 1.5))
    map_ = np.where(v > 0, 5.0 + 2.0 * decay + 4.0 * v, -8.0 - 3.0 * decay + 6.0 * v)
    moving = v != 0.0
    assert moving.sum() > 1000
    np.testing.assert_allclose(friction[moving], map_[moving], rtol=1e-12)


NARROW = jid.Trajectory.thesis(math.radians(20.0), cycle=3.0, duration=6.0)


@pytest.mark.parametrize(
    ("name", "narrow", "sensors", "period", "options"),
    [
        ("well_excited", False, {"torque_noise": 0.2}, 1e-3, {}),
        ("poorly_excited", True, {"torque_noise": 0.2}, 1e-3, {}),
        ("rippled", False, {"torque_noise": 0.5, "ripple": 2.6}, 1e-3, {"model": ":ripple=2"}),
        (
            "realistic",
            False,
            {"torque_noise": 0.5, "ripple": 2.6, "encoder_counts": 8000, "velocity": "difference"},
            2e-3,
            {"model": ":ripple=2"},
        ),
    ],
)
def test_an_independent_simulator_says_the_same(
    joint: jid.Joint,
    shared_data: Path,
    name: str,
    narrow: bool,
    sensors: dict[str, Any],
    period: float,
    options: dict[str, Any],
) -> None:
    """Its recording and twenty of ours, made by the same recipe: the same parameters within their errors."""
    theirs = jid.load(shared_data / "simulated" / f"{name}.csv.gz")
    # A velocity by backward difference lags: derived anew, centrally.
    theirs = jid.Recording(
        time=theirs.time,
        position=theirs.position,
        velocity=theirs.velocity if period == 1e-3 else None,
        torque=theirs.torque,
        sensor=theirs.sensor,
        torque_hold="zoh",
    )
    other = jid.identify(theirs, thesis_joint(), **options)
    scenario = jid.Scenario(
        jid.thesis_joint().with_parameters(TRUTH) if narrow else joint,
        wrong_controller(),
        NARROW if narrow else well_excited(),
        jid.Sensors(**sensors),
        control_period=period,
    )
    study = jid.sweep(scenario, thesis_joint(), trials=20, standard_errors=True, **options)
    for parameter, true in TRUTH.items():
        values = study.column(parameter)
        their = other.parameters[parameter]
        assert their.stderr is not None
        for value, error in zip(values, study.column(f"{parameter}_stderr"), strict=True):
            assert abs(value - their.value) < 3.0 * math.hypot(error, their.stderr), parameter
        # Of a mean over twenty, three of its own standard errors are chance.
        chance = 0.0 if name == "well_excited" else 3.0 * np.std(values, ddof=1) / math.sqrt(20.0)
        assert abs(np.mean(values) - true) < 3e-3 * true + chance, parameter


@pytest.mark.parametrize("period", [1e-3, 2e-3])
@pytest.mark.parametrize("sticks", [False, True])
def test_commands_that_jump_at_a_reversal_deceive_nobody(
    joint: jid.Joint, period: float, sticks: bool
) -> None:
    """Friction compensated at the reference's velocity: within a sample the joint turns, sticks, breaks loose."""
    law = wrong_controller().replace(friction_velocity="reference")
    if not sticks:  # Table 6-3's initial estimates: strong enough to turn the joint at once
        law = law.replace(coulomb=10.0, static=20.0, stribeck=200.0, sensor_gain=1.0)
    scenario = jid.Scenario(
        joint, law, well_excited(), jid.Sensors(torque_noise=0.5), control_period=period
    )
    study = jid.sweep(scenario, thesis_joint(), trials=20)
    estimates = [
        jid.identify(recording, thesis_joint(), search="separable")
        for recording in scenario.simulate(range(20)).recordings
    ]
    for parameter, true in TRUTH.items():
        values = study.column(parameter)
        intervals = [estimate.parameters[parameter].interval for estimate in estimates]
        inside = sum(pair is not None and pair[0] < true < pair[1] for pair in intervals)
        assert inside >= 16, parameter  # of 20; fewer have a chance of 1 in 400 at 95 %
        if not sticks:
            chance = 3.0 * np.std(values, ddof=1) / math.sqrt(20.0)
            assert abs(np.mean(values) - true) < 1e-3 * true + chance, parameter


def test_moves_as_an_independent_simulator_does(joint: jid.Joint) -> None:
    """The recording beside the examples: same controller, other code, other noise."""
    theirs = jid.load(WELL_EXCITED)
    law = wrong_controller().replace(
        boundary=0.9, adaptation=True, adaptation_dry=0.005, adaptation_viscous=0.005
    )
    sensors = jid.Sensors(torque_noise=0.2)
    ours = jid.simulate(joint, law, well_excited(), sensors=sensors)
    assert np.sqrt(np.mean((ours.position - theirs.position) ** 2)) < 5e-6
    assert np.abs(ours.tracking_error()).max() > 1e-3


def test_the_ring_closes_the_tracking_error_falls_to_that_of_the_truth(joint: jid.Joint) -> None:
    sensors = jid.Sensors(torque_noise=0.5)
    first = jid.AdaptiveRobust(
        inertia=INERTIA, coulomb=10.0, static=20.0, stribeck=200.0, viscous=10.0, sensor_gain=1.0
    )
    before = jid.simulate(joint, first, well_excited(), sensors=sensors)
    found = jid.identify(before, thesis_joint()).joint
    laws = [first] + [first.replace(**jid.control_estimates(each)) for each in (found, joint)]
    error = jid.simulate_batch(joint, laws, well_excited(), sensors=sensors).error
    assert error[0] > 1e-3
    assert error[1] < error[0] / 10.0
    assert error[1] == pytest.approx(error[2], rel=0.05)
    assert error[0] == pytest.approx(
        float(np.sqrt(np.mean(before.tracking_error()[2000:] ** 2))), rel=1e-12
    )


def test_a_batch_is_its_members_bit_for_bit(joint: jid.Joint) -> None:
    trajectory, sensors = well_excited(0.5), jid.Sensors(torque_noise=0.5, encoder_counts=8000)
    joints = [joint.with_parameters({"coulomb": 20.0 + i}) for i in range(11)]
    many = jid.simulate_batch(
        joints,
        wrong_controller(),
        trajectory,
        sensors=sensors,
        seeds=range(11),
        recordings=True,
        threads=2,
    )
    for i in (0, 7, 10):
        alone = jid.simulate(joints[i], wrong_controller(), trajectory, sensors=sensors, seed=i)
        assert alone == many.recordings[i]
        for name, values in alone.truth.signals.items():
            assert values.tobytes() == many.recordings[i].truth.signals[name].tobytes()


def test_a_simulated_recording_keeps_its_truth(joint: jid.Joint, tmp_path: Path) -> None:
    run = jid.simulate(joint, wrong_controller(), well_excited(1.0), sample_period=4e-3, name="run")
    assert len(run) == 250
    assert run.sample_period == pytest.approx(4e-3)
    assert run.torque_hold == "zoh"
    assert dict(run.truth) == {**TRUTH, "inertia": pytest.approx(INERTIA)}
    part = run.crop(0.2, 0.6)
    assert isinstance(part, jid.SimulatedRecording)
    assert part.truth.signals["position"].tobytes() == part.position.tobytes()
    again = pickle.loads(pickle.dumps(run))
    assert again == run
    assert again.truth.signals["friction"].tobytes() == run.truth.signals["friction"].tobytes()
    run.save(tmp_path / "run.npz")
    loaded = jid.load(tmp_path / "run.npz")
    assert loaded.truth == dict(run.truth)
    with pytest.raises(ValueError, match="read-only"):
        run.truth.signals["position"][0] = 1.0


def test_a_thinned_recording_has_the_mean_of_what_was_commanded(joint: jid.Joint) -> None:
    """What was held over a sample's time integrates to the same impulse; one of four commands does not."""
    sensors = jid.Sensors(torque_noise=0.5)
    full = jid.simulate(joint, wrong_controller(), well_excited(), sensors=sensors)
    thin = jid.simulate(
        joint, wrong_controller(), well_excited(), sensors=sensors, sample_period=4e-3
    )
    assert full.torque is not None
    assert thin.torque is not None
    np.testing.assert_array_equal(thin.position, full.position[::4])
    np.testing.assert_allclose(thin.torque, full.torque.reshape(-1, 4).mean(axis=1), rtol=1e-12)
    gains = [
        jid.identify(
            jid.simulate(
                joint,
                wrong_controller(),
                well_excited(),
                sensors=sensors,
                sample_period=4e-3,
                seed=seed,
            ),
            thesis_joint(),
        )
        .parameters["sensor_gain"]
        .value
        for seed in range(8)
    ]
    assert np.mean(gains) == pytest.approx(TRUTH["sensor_gain"], rel=5e-3)


def test_payload_and_position_torque_load_the_joint(joint: jid.Joint) -> None:
    push = jid.Trajectory.step(0.0, duration=0.1)
    rod = jid.Link(mass=2.0, centre_of_mass=0.5, gravity=10.0)
    hung = jid.simulate(joint, jid.OpenLoop(), push, payload=rod, position=0.5)
    assert hung.truth.signals["link_torque"][0] == pytest.approx(
        WEIGHT * math.sin(0.5) + 10.0 * math.cos(0.5), rel=1e-12
    )
    dead = jid.simulate(joint, jid.OpenLoop(), push, payload=7.0)
    assert dead.truth.signals["link_torque"][0] == pytest.approx(7.0)
    rough = joint.replace(model=joint.model.replace(harmonics=(3.0,))).with_parameters(
        {"position_cos_3": 0.0, "position_sin_3": 5.0}
    )
    held = jid.simulate(rough, jid.OpenLoop(), push, position=0.5).truth.signals
    assert held["link_torque"][0] == pytest.approx(WEIGHT * math.sin(0.5), rel=1e-12)
    expected = -WEIGHT * math.sin(0.5) - 5.0 * math.sin(1.5)
    assert held["friction"][0] == pytest.approx(expected, rel=1e-12)


def test_the_torque_limit_cuts_and_counts(joint: jid.Joint) -> None:
    law = jid.Pd(stiffness=1e5, damping=100.0)
    run = jid.simulate(joint, law, jid.Trajectory.step(1.0, duration=0.5), position=0.0)
    # ±8 A through 0.198 N·m/A and the gear is 159.984 N·m, under the stated 160.
    assert np.abs(np.asarray(run.torque)).max() == pytest.approx(8.0 * 0.198 * 101.0)
    assert run.metadata["saturations"] > 0


@pytest.mark.parametrize(
    ("change", "complaint"),
    [
        ({"control_period": 1e-12}, "control_period is 1e-12: 0.1 s would be 1e+11 control"),
        ({"duration": 1e9}, "duration is 1000000000.0: 1e+09 s would be 1e+12 control periods"),
        ({"control_period": 0.0}, "control_period is 0.0: more than 0"),
        ({"integration_step": 3e-4}, "integration_step is 0.0003: must be a whole part"),
        ({"sample_period": 2.5e-3}, "sample_period is 0.0025: a whole number of control periods"),
        ({"duration": math.nan}, "duration is nan: a finite number"),
        ({"payload": "heavy"}, "payload is 'heavy': a number"),
        ({"seed": -1}, "seed is -1: a whole number"),
        ({"seed": 1.5}, "seeds is 1.5: a whole number"),
        ({"sensors": 3}, "sensors is 3: a Sensors value is expected"),
        ({"bristle": 1e5}, "bristle is 100000.0: a Bristle is expected"),
    ],
)
def test_bad_options_are_refused(joint: jid.Joint, change: dict[str, Any], complaint: str) -> None:
    with pytest.raises(jid.InputError, match=r"^[^\n]+$") as refusal:
        jid.simulate(joint, wrong_controller(), well_excited(0.1), **change)
    assert complaint in str(refusal.value)


def test_what_is_missing_is_named(joint: jid.Joint) -> None:
    with pytest.raises(jid.InputError, match="coulomb: a simulation needs a value"):
        jid.simulate(thesis_joint(), wrong_controller(), well_excited(0.1))
    with pytest.raises(jid.InputError, match="controllers is 3: one of"):
        jid.simulate(joint, 3, well_excited(0.1))  # type: ignore[call-overload]
    loose = joint.replace(limits=jid.Limits())
    with pytest.raises(jid.InputError, match="not stable"):
        jid.simulate(
            loose, jid.Pd(stiffness=1e12), jid.Trajectory.step(1.0, duration=1.0), position=0.0
        )
    with pytest.raises(
        jid.InputError, match="controllers: this argument has 2 entries, but others have 3"
    ):
        jid.simulate_batch([joint] * 3, [wrong_controller()] * 2, well_excited(0.1))


def test_ctrl_c_ends_a_long_simulation(joint: jid.Joint) -> None:
    # Days of the joint: minutes of the core, were it not interrupted.
    threading.Timer(0.2, _thread.interrupt_main).start()
    with pytest.raises(KeyboardInterrupt):
        jid.simulate(joint, wrong_controller(), well_excited(), duration=3e5)


def test_a_scenario_names_its_own_argument(joint: jid.Joint) -> None:
    sensors: Any = 1
    with pytest.raises(jid.InputError, match=r"^sensors is 1: a Sensors value is expected$"):
        jid.Scenario(joint, wrong_controller(), well_excited(0.1), sensors)
    trajectory: Any = 2
    with pytest.raises(jid.InputError, match=r"^trajectory is 2: a Trajectory is expected$"):
        jid.Scenario(joint, wrong_controller(), trajectory)
