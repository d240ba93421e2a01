"""Every friction model of the core's table with at most one shape is a robot's, without a word of its terms here."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray
from small_arm import recording, urdf

import jointid as jid
from jointid import _core
from jointid.identification.search.computed_bounds import shape_bounds
from jointid.report.saving import report_page

pytest.importorskip("pinocchio")

PEAK, SHARE = 2.5, np.array([2.0, 1.0])  # [rad/s]; of the two joints
SPEEDS = np.linspace(-PEAK, PEAK, 200)
Array = NDArray[np.float64]


def terms(model: str) -> list[_core.Term]:
    return [_core.term(key) for key in _core.model_terms(model)]


MODELS = [m.name for m in _core.models() if sum(len(t.shapes) for t in terms(m.name)) <= 1]
OTHERS = [model.name for model in _core.models() if model.name not in MODELS]


def truth(model: str) -> dict[str, float]:
    """Of the second joint: each term makes 1.5 N·m at the speed at which it is largest."""
    found: dict[str, float] = {}
    for term in terms(model):
        shapes = [float(np.sqrt(np.prod(shape_bounds(name, PEAK)))) for name in term.shapes]
        largest = np.abs(_core.friction_basis(term.key, SPEEDS, shapes)).max()
        found |= {term.name: 1.5 / float(largest), **dict(zip(term.shapes, shapes, strict=True))}
    return found


def friction(model: str, velocity: Array) -> Array:
    """Of both joints, at speeds of shape (samples, 2)."""
    values, total = truth(model), np.zeros_like(velocity)
    for term in terms(model):
        shapes = [values[name] for name in term.shapes]
        for joint, share in enumerate(SHARE):
            basis = _core.friction_basis(term.key, velocity[:, joint], shapes)
            total[:, joint] += share * values[term.name] * basis
    return total


@pytest.mark.parametrize("model", MODELS)
def test_a_model_of_the_table_is_a_robots(model: str, tmp_path: Path) -> None:
    path = urdf(tmp_path)
    run, other = (
        recording(path, duration=6.0, seed=seed, friction=lambda v: friction(model, v))
        for seed in (0, 3)
    )
    found = jid.identify_robot(run, jid.Robot.from_urdf(path), model=model)
    shapes = {name for term in terms(model) for name in term.shapes}
    for share, joint in zip(SHARE, found.joints.values(), strict=True):
        assert joint.model == model
        for name, value in truth(model).items():
            factor = 1.0 if name in shapes else share
            assert joint.parameters[name].value == pytest.approx(factor * value, rel=0.1), name
    both = np.column_stack([SPEEDS, -SPEEDS])
    size = np.abs(friction(model, both)).max(axis=0)
    assert np.all(np.abs(found.friction(both) - friction(model, both)) < 0.03 * size)
    assert found.warnings == ()
    assert found.cross_check is not None
    assert found.predict(other).relative_residual < 0.02

    again = jid.RobotEstimate.load(found.save(tmp_path / "arm.json"))
    assert again.to_json() == found.to_json()
    assert again.friction(both).tobytes() == found.friction(both).tobytes()
    assert again.predict(other) == found.predict(other)
    for text in (report_page(again), again.report(verbose=True)):
        assert all(name in text for name in truth(model))
    written = jid.export(again, tmp_path / "new.urdf", into=path, approximate=True)
    assert all(f"{name}: " in written.read_text(encoding="utf-8") for name in truth(model))


def test_models_are_held_out_side_by_side(tmp_path: Path) -> None:
    path = urdf(tmp_path)
    run = recording(path, duration=6.0, friction=lambda v: friction(MODELS[-1], v))
    robot = jid.Robot.from_urdf(path)
    found = jid.compare_robot_models(run, robot, models=MODELS, inertia="urdf", folds=3)
    assert {row.model for row in found.rows} == set(MODELS)
    scores = {row.model: row.score for row in found.rows}
    assert scores[MODELS[-1]] == pytest.approx(min(scores.values()), rel=0.05)
    assert found.winner.score < 0.02


@pytest.mark.parametrize("model", OTHERS)
def test_a_model_with_more_shapes_is_refused(model: str, tmp_path: Path) -> None:
    path = urdf(tmp_path)
    with pytest.raises(jid.InputError, match=f"friction model is one of {MODELS[0]}, "):
        jid.identify_robot(recording(path, duration=1.0), jid.Robot.from_urdf(path), model=model)
