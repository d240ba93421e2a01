"""An offset beside asymmetric Coulomb friction: what is known is tight, what is not says so."""

from typing import Any

import numpy as np
import pytest

import jointid as jid
from jointid.problem.constant_torque import balanced, undivided

TIME = np.arange(0.0, 8.0, 1e-3)
POSITION = np.sin(2.3 * TIME) + 0.4 * np.sin(5.1 * TIME)
VELOCITY = 2.3 * np.cos(2.3 * TIME) + 2.04 * np.cos(5.1 * TIME)
ACCELERATION = -(2.3**2) * np.sin(2.3 * TIME) - 0.4 * 5.1**2 * np.sin(5.1 * TIME)
DRIVE = 0.8 * ACCELERATION + np.where(VELOCITY > 0.0, 12.0 + 4.0 * VELOCITY, -8.0 + 6.0 * VELOCITY)
THREE = ("coulomb_positive", "coulomb_negative", "torque_offset")


def recording(torque: np.ndarray, seed: int = 0) -> jid.Recording:
    noise = np.random.default_rng(seed).normal(0.0, 0.3, TIME.size)
    return jid.Recording(time=TIME, position=POSITION, velocity=VELOCITY, torque=torque + noise)


@pytest.mark.parametrize("search", ["ga", "separable"])
@pytest.mark.parametrize("offset", [-50.0, 0.0, 30.0])
def test_the_intervals_say_what_no_motion_tells(offset: float, search: Any) -> None:
    run = recording(DRIVE + offset)
    estimate = jid.identify(run, model=jid.Model.parse("coulomb_viscous:asymmetric"), search=search)
    value = {name: p.value for name, p in estimate.parameters.items()}
    assert value["viscous_positive"] == pytest.approx(4.0, rel=0.01)
    assert value["viscous_negative"] == pytest.approx(6.0, rel=0.01)
    assert value["coulomb_positive"] == pytest.approx(value["coulomb_negative"])  # by convention
    for name in THREE:
        assert estimate.parameters[name].stderr == np.inf
    derived = estimate.derived
    expected = {
        "coulomb_sum": 20.0,
        "constant_positive": 12.0 + offset,
        "constant_negative": 8.0 - offset,
    }
    for name, true in expected.items():
        found = derived[name]
        assert found.value == pytest.approx(true, rel=0.01), name
        assert found.stderr is not None
        assert abs(found.value - true) < 4.0 * found.stderr
        assert found.stderr < 0.1
    assert jid.Estimate.from_json(estimate.to_json()).derived == derived
    told = next(found for found in estimate.findings if found.code == "undivided_offset")
    assert set(told.parameters) == set(THREE)
    assert not any(set(found.parameters) & set(THREE) for found in estimate.warnings)
    assert np.isinf(estimate.friction([1.0]).upper[0])
    known = jid.identify(
        run,
        model=jid.Model.parse("coulomb_viscous:asymmetric"),
        parameters={"torque_offset": offset},
    )
    assert known.parameters["coulomb_positive"].value == pytest.approx(12.0, rel=0.01)
    assert known.parameters["coulomb_negative"].value == pytest.approx(8.0, rel=0.01)


def test_gravity_tells() -> None:
    gravity = -50.0 * np.cos(POSITION) + 3.0 * np.sin(POSITION)
    estimate = jid.identify(
        recording(DRIVE + gravity), model=jid.Model.parse("coulomb_viscous:asymmetric:gravity=free")
    )
    assert "torque_offset" not in estimate.parameters
    assert "torque_offset" in estimate.report(verbose=True)
    for name, true in {
        "coulomb_positive": 12.0,
        "coulomb_negative": 8.0,
        "viscous_positive": 4.0,
        "viscous_negative": 6.0,
        "gravity_cos": -50.0,
    }.items():
        assert estimate.parameters[name].value == pytest.approx(true, rel=0.01), name


def test_a_sensor_with_a_known_zero_tells() -> None:
    link = 0.3 * ACCELERATION + 5.0 * np.sin(POSITION)
    run = recording(DRIVE + link)
    run = jid.Recording(
        time=TIME,
        position=POSITION,
        velocity=VELOCITY,
        torque=run.torque,
        sensor=(link - 15.0) / 2.4,
    )
    joint = jid.Joint(inertia=0.8, sensor=True, model=jid.Model("coulomb_viscous", asymmetric=True))
    found = jid.identify(run, joint, parameters={"sensor_offset": 15.0})
    assert found.parameters["coulomb_positive"].value == pytest.approx(12.0, rel=0.01)
    assert found.parameters["coulomb_negative"].value == pytest.approx(8.0, rel=0.01)
    free = jid.identify(run, joint)
    assert free.parameters["sensor_offset"].stderr == np.inf
    assert free.derived["coulomb_sum"].value == pytest.approx(20.0, rel=0.01)
    assert free.parameters["sensor_gain"].value == pytest.approx(2.4, rel=0.01)


def test_which_parameters_change_together() -> None:
    def changes(*names: str) -> list[dict[str, float]]:
        return [dict(each.change) for each in undivided(names)]

    assert changes(*THREE) == [
        {"torque_offset": -1.0, "coulomb_positive": 1.0, "coulomb_negative": -1.0}
    ]
    assert changes(*THREE[:2]) == changes("torque_offset", "coulomb") == changes(*THREE[1:]) == []
    own = changes(*THREE[:2], "torque_offset[0]", "torque_offset[1]")
    assert [list(each) for each in own] == [
        ["torque_offset[0]", "torque_offset[1]", "coulomb_positive", "coulomb_negative"]
    ]
    assert changes(*THREE[:2], "torque_offset[1]") != own
    apart = changes(*(f"{name}[{run}]" for name in THREE for run in (0, 1)))
    assert [each["torque_offset[1]"] for each in apart if "torque_offset[1]" in each] == [-1.0]
    assert len(apart) == 2


def test_bounds_keep_the_convention_out() -> None:
    lower, upper = np.array([11.0, 0.0, -99.0]), np.array([13.0, 99.0, 99.0])
    best = balanced(THREE, lower, upper, np.array([12.0, 2.0, -50.0]))
    np.testing.assert_allclose(best, [11.0, 3.0, -49.0])
