"""Each friction model of the core's table is simulated, identified, shown, and motions are designed for it."""

import math
from pathlib import Path

import numpy as np
import pytest
from every_model import MODELS, friction_values, joint_of

import jointid as jid
from jointid import _core
from jointid.joint.model import ModelName

CONTROLLER = jid.Pd(stiffness=3000.0, damping=200.0)
each_model = pytest.mark.parametrize("model", MODELS)
each_side = pytest.mark.parametrize("asymmetric", [False, True], ids=["", "asymmetric"])


def moved(joint: jid.Joint) -> jid.SimulatedRecording:
    return jid.simulate(
        joint,
        CONTROLLER,
        jid.Trajectory.thesis(math.radians(60.0), cycle=3.0, duration=6.0),
        control_period=2.5e-4,
    )


def summed(model: ModelName, velocity: np.ndarray, *, asymmetric: bool) -> np.ndarray:
    """Friction of the true values, as the sum of the rows."""
    values = friction_values(model, asymmetric=asymmetric)
    total = np.zeros_like(velocity)
    for key in _core.model_terms(model, asymmetric=asymmetric):
        term = _core.term(key)
        shapes = np.array([values[name] for name in term.shapes])
        total += values[term.name] * _core.friction_basis(key, velocity, shapes)
    return total


@each_side
@each_model
def test_the_simulated_friction_is_the_sum_of_the_rows(model: ModelName, asymmetric: bool) -> None:
    joint = joint_of(model, asymmetric=asymmetric)
    recording = moved(joint)
    velocity = recording.truth.signals["velocity"]
    wanted = summed(model, velocity, asymmetric=asymmetric)
    moving = velocity != 0.0
    np.testing.assert_allclose(
        recording.truth.signals["friction"][moving], wanted[moving], atol=1e-9
    )


@each_side
@each_model
def test_what_is_simulated_is_identified_and_shown(
    model: ModelName, asymmetric: bool, tmp_path: Path
) -> None:
    joint = joint_of(model, asymmetric=asymmetric)
    values = friction_values(model, asymmetric=asymmetric)
    # A free offset would take up the difference of dry friction.
    free = joint.replace(parameters={})
    estimate = jid.identify(moved(joint), free, parameters={"torque_offset": 0.0})
    for name, value in values.items():
        assert estimate.parameters[name].value == pytest.approx(value, rel=3e-3), name
    speeds = np.array([-2.0, -0.05, 0.05, 2.0])
    wanted = summed(model, speeds, asymmetric=asymmetric)
    np.testing.assert_allclose(estimate.friction(speeds).torque, wanted, rtol=3e-3)
    assert "cross_check" not in {found.code for found in estimate.findings}
    page = tmp_path / "report.html"
    jid.save_report(estimate, page)
    for key in _core.model_terms(model, asymmetric=asymmetric):
        assert _core.term(key).name in page.read_text(encoding="utf-8")


@each_model
def test_motions_are_designed_for_it(model: ModelName) -> None:
    values = friction_values(model)
    design = jid.design_excitation(
        joint_of(model).replace(parameters={}),
        {"position": (-1.0, 1.0), "velocity": 3.0, "torque": 300.0},
        4.0,
        controller=CONTROLLER,
        sensors=jid.Sensors(encoder_counts=1e5, velocity="difference"),
        prior={"torque_offset": (-1.0, 1.0)}
        | {name: (0.8 * value, 1.2 * value) for name, value in values.items()},
        search=jid.DesignSearch(evaluations=64, rehearsals=10, joints=2),
    )
    assert set(values) <= set(design.parameters)
    assert all(0.0 < design.parameters[name].relative < 20.0 for name in values)
