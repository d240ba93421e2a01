"""A servo can have every friction model without shape parameters, by its terms in the core's table alone."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from simulated_servo import Bench, Truth, bench_runs, servo_joint

import jointid as jid
from jointid import _core
from jointid.report.saving import report_page

TRUTH = replace(Truth(), coulomb=0.0, viscous=0.0)  # friction of the speed is the bench's
MODELS = {model.name: [_core.term(key) for key in model.terms] for model in _core.models()}
PLAIN = [name for name, terms in MODELS.items() if not any(term.shapes for term in terms)]
SPEED, SIZE = 2.0, 0.02  # each term has this torque [N·m] at this speed [rad/s]


def friction_of(model: str) -> dict[str, tuple[str, float]]:
    """Basis and coefficient of each term, by the parameter's name."""
    at, none = np.array([SPEED]), np.empty(0)
    return {
        term.name: (term.basis, SIZE / float(_core.friction_basis(term.key, at, none)[0]))
        for term in MODELS[model]
    }


@pytest.mark.parametrize("model", PLAIN)
def test_each_is_identified_saved_shown_rolled_out_and_exported(model: str, tmp_path: Path) -> None:
    friction = friction_of(model)
    bench = Bench(friction=tuple((basis, v, v, ()) for basis, v in friction.values()))
    runs = bench_runs(TRUTH, seed=8, runs=8, bench=bench)
    found = jid.identify_servo(runs, servo_joint(), model=jid.Model.parse(model), draws=50)
    for name, (_, value) in friction.items():
        assert found[name] == pytest.approx(value, rel=0.25), name
        low, high = found.parameters[name].interval or (np.nan, np.nan)
        assert low <= found[name] <= high
    page, table = report_page(found), found.report(verbose=True)
    for term in MODELS[model]:
        assert found.parameters[term.name].unit == term.unit
        assert term.meaning in page
        assert term.meaning in table
    again = jid.ServoEstimate.load(found.save(tmp_path / "servo.json"))
    assert again.to_json() == found.to_json()
    assert np.array_equal(again.values, found.values)
    rolled = jid.rollout(again, runs)
    assert np.degrees(rolled.median) < 0.5
    for name in friction:
        less = found.identified.with_parameters({name: 0.0})
        assert jid.rollout(less, runs).median > 1.5 * rolled.median, name
    text = jid.export(found.identified, tmp_path / "servo.h").read_text(encoding="utf-8")
    assert all(name in text for name in friction)


def test_a_model_with_shape_parameters_is_refused_with_the_models_that_a_servo_can_have() -> None:
    runs = bench_runs(TRUTH, seed=8, runs=1)
    for model in MODELS.keys() - set(PLAIN):
        with pytest.raises(jid.InputError, match=" or ".join(PLAIN)):
            jid.identify_servo(runs, servo_joint(), model=jid.Model.parse(model))
