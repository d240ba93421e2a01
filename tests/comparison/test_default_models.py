"""Models that nobody names are compared with the gravity that `identify` would choose."""

from dataclasses import replace

import numpy as np
import pytest

import jointid as jid
from jointid.estimate.answers import COLUMNS

TIME = np.arange(0.0, 12.0, 0.004)


def recording(weight: float) -> jid.Recording:
    position = 0.5 * np.sin(1.3 * TIME) + 0.2 * np.sin(3.1 * TIME)
    velocity = 0.65 * np.cos(1.3 * TIME) + 0.62 * np.cos(3.1 * TIME)
    acceleration = -0.845 * np.sin(1.3 * TIME) - 1.922 * np.sin(3.1 * TIME)
    torque = 1.5 * acceleration + 8.0 * np.sign(velocity) + 6.0 * velocity
    torque += weight * np.sin(position) + np.random.default_rng(1).normal(0.0, 0.3, TIME.size)
    return jid.Recording(time=TIME, position=position, velocity=velocity, torque=torque)


@pytest.mark.parametrize(("weight", "gravity"), [(4.0, "free"), (0.0, "none")])
def test_the_winner_is_the_one_that_identify_chooses(weight: float, gravity: str) -> None:
    loaded = recording(weight)
    found = jid.compare_models(loaded)
    assert {row.spec.resolved.gravity for row in found.rows} == {gravity}
    assert found.winner == jid.identify(loaded).settings["model"]


def test_a_stated_gravity_and_named_models_stay() -> None:
    loaded = recording(4.0)
    stated = jid.Joint(model=jid.Model(gravity="none"))
    for found in (
        jid.compare_models(loaded, stated, folds=3),
        jid.compare_models(loaded, models=["coulomb_viscous", "stribeck"], folds=3),
    ):
        assert {row.spec.resolved.gravity for row in found.rows} == {"none"}


def test_the_reason_of_each_model_is_whole_in_the_report() -> None:
    found = jid.compare_models(recording(4.0), models=["coulomb_viscous", "stribeck"], folds=3)
    long = "not eligible: " + "a bound of a parameter, " * 8 + "at last"
    rows = (replace(found.rows[0], reason=long), *found.rows[1:])
    lines = replace(found, rows=rows).report().splitlines()
    assert max(map(len, lines)) <= COLUMNS
    assert long in " ".join(" ".join(lines).split())
