"""Controllers: their laws written a second time, one step at a time, the same object as in the simulator."""

import math
import pickle
from typing import Any

import numpy as np
import pytest
from closed_loop import INERTIA, TRUTH, thesis_joint, well_excited, wrong_controller

import jointid as jid

CONTROLLERS: list[Any] = [
    jid.OpenLoop(gain=2.0),
    jid.Pd(stiffness=2e4, damping=500.0),
    jid.Pid(stiffness=2e4, integral=1e5, damping=500.0, integral_limit=20.0),
    jid.CompensatedPid(stiffness=2e4, damping=500.0, coulomb=20.0, viscous=15.0, static=9.0),
    wrong_controller().replace(adaptation=True, adaptation_dry=5.0, adaptation_viscous=5e3),
    jid.LugreObserver(coulomb=20.0, inertia=INERTIA, bristle_stiffness=1e5, sensor_gain=2.0),
]


@pytest.mark.parametrize("controller", CONTROLLERS, ids=lambda c: type(c).__name__)
def test_stepping_gives_the_torque_of_the_simulation(controller: Any) -> None:
    joint = thesis_joint().with_parameters(TRUTH)
    trajectory = well_excited(0.3)
    sensors = jid.Sensors(encoder_counts=8000, velocity="counts", torque_noise=0.5)
    run = jid.simulate(joint, controller, trajectory, sensors=sensors)
    assert run.sensor is not None
    assert run.torque is not None
    work = controller.start(1e-3, torque_limit=8.0 * 0.198 * 101.0)
    wanted = np.column_stack(trajectory.sample(run.time))
    torque = [
        work.step(
            time=run.time[k],
            position=run.position[k],
            velocity=run.truth.signals["control_velocity"][k],
            sensor=run.sensor[k],
            reference=wanted[k, 0],
            reference_velocity=wanted[k, 1],
            reference_acceleration=wanted[k, 2],
        )
        for k in range(len(run))
    ]
    assert np.array(torque).tobytes() == run.torque.tobytes()
    assert work.saturations == run.metadata["saturations"]


@pytest.mark.parametrize("controller", CONTROLLERS, ids=lambda c: type(c).__name__)
def test_a_configuration_is_a_frozen_value(controller: Any) -> None:
    kind = type(controller)
    assert kind(**controller.asdict()) == controller
    assert pickle.loads(pickle.dumps(controller)) == controller
    assert eval(repr(controller), {kind.__name__: kind}) == controller
    name, value = next(iter(controller.asdict().items()))
    changed = controller.replace(**{name: value + 1.0})
    assert getattr(changed, name) == value + 1.0
    assert changed != controller
    with pytest.raises(AttributeError):
        setattr(controller, name, 3.0)
    with pytest.raises(ValueError, match=f"{name}"):
        controller.replace(**{name: math.nan})
    with pytest.raises(jid.InputError, match=r"\.gravity: no such field; fields are "):
        kind(gravity=1.0)


def test_the_adaptive_robust_law_is_that_of_the_thesis() -> None:
    rng = np.random.default_rng(1)
    for velocity in ("measured", "reference"):
        law = jid.AdaptiveRobust(
            bandwidth=30.0,
            robust_torque=4.0,
            boundary=0.05,
            adaptation=True,
            adaptation_dry=2.0,
            adaptation_viscous=70.0,
            inertia=2.5,
            coulomb=20.0,
            static=12.0,
            stribeck=60.0,
            viscous=9.0,
            sensor_gain=1.4,
            sensor_offset=-3.0,
            friction_velocity=velocity,
        )
        period = 2e-3
        work, total = law.start(period), np.zeros(4)
        for k in range(50):
            q, qd, v, vd, ad, reading = rng.normal(0.0, 0.3, 6)
            error, rate = q - qd, v - vd
            r = rate + 30.0 * error
            w = v if velocity == "measured" else vd
            decay, sign = math.exp(-60.0 * w * w), math.copysign(1.0, w)
            torque = 2.5 * (ad - 60.0 * rate - 900.0 * error) + 9.0 * w
            torque += (20.0 + 12.0 * decay) * sign + 1.4 * reading - 3.0
            slope = np.array([w, sign, decay * sign, -12.0 * w * w * decay * sign])
            total += slope * r * period
            torque -= float(np.sum(np.array([70.0, 2.0, 2.0, 70.0]) * slope * total))
            torque -= 4.0 * max(-1.0, min(1.0, r / 0.05))
            asked = work.step(
                time=k * period,
                position=q,
                velocity=v,
                sensor=reading,
                reference=qd,
                reference_velocity=vd,
                reference_acceleration=ad,
            )
            assert asked == pytest.approx(torque, rel=1e-12, abs=1e-9)


def test_each_switch_takes_its_term_away() -> None:
    law = wrong_controller().replace(adaptation=True, adaptation_dry=5.0, adaptation_viscous=5.0)
    moment = {"time": 0.0, "position": 0.1, "velocity": 0.2, "sensor": 3.0, "reference": 0.11}

    def asked(**changes: Any) -> float:
        torque: float = law.replace(**changes).start(1e-3).step(**moment)
        return torque

    whole = asked()
    assert whole - asked(torque_feedback=False) == pytest.approx(1.5 * 3.0)
    assert whole - asked(robust_term=False) == pytest.approx(5.05)
    assert whole != asked(adaptation=False)
    # At rest in the reference there is no friction to compensate.
    level = 15.0 + 10.0 * math.exp(-150.0 * 0.04)
    plain = {"adaptation": False}
    difference = asked(**plain) - asked(**plain, friction_velocity="reference")
    assert difference == pytest.approx(10.0 * 0.2 + level)


@pytest.mark.parametrize("controller", CONTROLLERS)
@pytest.mark.parametrize(
    "name",
    [
        *("time", "position", "velocity", "sensor"),
        *("reference", "reference_velocity", "reference_acceleration"),
    ],
)
def test_what_is_no_number_is_refused_and_leaves_no_trace(controller: Any, name: str) -> None:
    moment = {"time": 0.0, "position": 0.1, "velocity": 0.2, "sensor": 3.0, "reference": 0.11}
    work, other = (controller.start(1e-3, torque_limit=50.0) for _ in range(2))
    for wrong in (math.nan, math.inf, -math.inf):
        with pytest.raises(ValueError, match=rf"step\.{name} is (nan|-?inf): must be finite"):
            work.step(**{**moment, name: wrong})
    assert work.saturations == 0
    assert work.step(**moment) == other.step(**moment)


def test_gains_of_the_motor_side_are_reflected() -> None:
    law = jid.AdaptiveRobust.from_motor_side(gear_ratio=-101.0, adaptation_gain=5e-4)
    assert law.bandwidth == 80.0
    assert law.boundary == pytest.approx(0.9 / 101.0)
    assert law.robust_torque == pytest.approx(0.05 * 101.0)
    assert law.adaptation
    assert law.adaptation_dry == pytest.approx(5e-4 * 101.0**2)
    assert law.adaptation_viscous == pytest.approx(5e-4 * 101.0**4)
    assert not jid.AdaptiveRobust.from_motor_side(gear_ratio=101.0).adaptation


def test_the_integral_stays_within_its_limit() -> None:
    work = jid.Pid(stiffness=0.0, integral=10.0, integral_limit=3.0).start(0.1)
    torques = [work.step(time=k * 0.1, position=-1.0, velocity=0.0) for k in range(6)]
    np.testing.assert_allclose(torques, [1.0, 2.0, 3.0, 3.0, 3.0, 3.0])


def test_adaptation_lowers_the_error_of_wrong_estimates() -> None:
    joint = thesis_joint().with_parameters(TRUTH)
    plain = wrong_controller()
    motor = jid.AdaptiveRobust.from_motor_side(gear_ratio=101.0, adaptation_gain=5e-4)
    adapting = plain.replace(
        adaptation=True,
        adaptation_dry=motor.adaptation_dry,
        adaptation_viscous=motor.adaptation_viscous,
    )
    error = jid.simulate_batch(joint, [plain, adapting], well_excited()).error
    assert error[1] < 0.8 * error[0]


def test_a_lugre_observer_beats_no_compensation() -> None:
    joint = thesis_joint().with_parameters(TRUTH)
    bristle = jid.Bristle(stiffness=1e5, damping=300.0)
    observer = jid.LugreObserver(
        **jid.control_estimates(joint),
        bristle_stiffness=1e5,
        bristle_damping=300.0,
        friction_velocity="reference",
    )
    without = observer.replace(coulomb=0.0, static=0.0)
    trajectory = well_excited()
    error = jid.simulate_batch(joint, [without, observer], trajectory, bristle=bristle).error
    assert error[1] < 0.2 * error[0]


def test_control_estimates_are_the_parameters() -> None:
    joint = thesis_joint().with_parameters(TRUTH)
    assert jid.control_estimates(joint) == {**TRUTH, "inertia": pytest.approx(INERTIA)}
    bare = jid.Joint(
        inertia=2.0, link=jid.Link(mass=1.0, centre_of_mass=0.5), model=jid.Model(asymmetric=True)
    ).with_parameters(
        {
            "coulomb_positive": 4.0,
            "coulomb_negative": 6.0,
            "viscous_positive": 1.0,
            "viscous_negative": 3.0,
        }
    )
    assert jid.control_estimates(bare) == {
        "static": 0.0,
        "stribeck": 0.0,
        "inertia": 2.25,
        "coulomb": 5.0,
        "viscous": 2.0,
        "sensor_gain": 0.0,
        "sensor_offset": 0.0,
    }
    with pytest.raises(jid.InputError, match=r"'stribeck_general': .*'static_general_positive'"):
        jid.control_estimates(bare.replace(model=bare.model.replace(name="stribeck_general")))


def test_unknown_words_are_refused() -> None:
    with pytest.raises(ValueError, match="measured, reference"):
        jid.AdaptiveRobust(friction_velocity="desired")
    with pytest.raises(ValueError, match=r"controller\.period is .*: must be finite and above 0"):
        jid.Pd().start(0.0)
