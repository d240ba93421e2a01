"""Richer terms: directions apart, ripple, harmonics, load, exponent; several recordings; collinear terms refused."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from example_recordings import WELL_EXCITED

import jointid as jid

TRUTH = {
    "coulomb": 25.0,
    "static": 20.0,
    "stribeck": 100.0,
    "viscous": 20.0,
    "sensor_gain": 2.4,
    "sensor_offset": 15.0,
}
THESIS_INERTIA = 2.472e-4 * 101**2


@pytest.fixture(scope="module")
def well_excited() -> jid.Recording:
    return jid.load(WELL_EXCITED)


def smooth(torque: dict[str, float], gear_ratio: float = 1.0, seed: int = 1) -> jid.Recording:
    """A recording whose torque is the sum of terms with these coefficients, plus little noise."""
    rng = np.random.default_rng(seed)
    time = np.arange(0.0, 12.0, 1e-3)
    rate, size = np.array([1.1, 2.7, 4.3]), np.array([0.7, 0.4, 0.2])
    phase = np.outer(time, rate) + rng.uniform(0, 6, 3)
    q = np.sin(phase) @ size
    v = np.cos(phase) @ (size * rate)
    a = -np.sin(phase) @ (size * rate**2)
    basis = {
        "inertia": a,
        "coulomb": np.sign(v),
        "coulomb_positive": (v > 0) * 1.0,
        "coulomb_negative": (v < 0) * -1.0,
        "viscous": v,
        "viscous_positive": np.maximum(v, 0.0),
        "viscous_negative": np.minimum(v, 0.0),
        "torque_offset": np.ones_like(v),
        "position_cos_3": np.cos(3 * q),
        "position_sin_3": np.sin(3 * q),
        "ripple_cos_2": np.cos(2 * gear_ratio * q),
        "ripple_sin_2": np.sin(2 * gear_ratio * q),
    }
    tau = np.sum([value * basis[name] for name, value in torque.items()], axis=0)
    return jid.Recording(
        time=time, position=q, velocity=v, torque=tau + rng.normal(0, 0.02, time.size)
    )


def check(estimate: jid.Estimate, truth: dict[str, float], tolerance: float = 0.01) -> None:
    size = max(abs(value) for value in truth.values())
    for name, value in truth.items():
        assert estimate.parameters[name].value == pytest.approx(value, abs=tolerance * size), name


def test_directions_apart() -> None:
    truth = {
        "inertia": 0.8,
        "coulomb_positive": 2.0,
        "coulomb_negative": 3.0,
        "viscous_positive": 4.0,
        "viscous_negative": 5.0,
    }
    joint = jid.Joint(torque_offset=False)
    estimate = jid.identify(smooth(truth), joint, model=jid.Model(asymmetric=True))
    check(estimate, truth)
    assert "torque_offset" not in estimate.parameters
    curve = estimate.friction([-1.0, 1.0])
    np.testing.assert_allclose(curve.torque, [-8.0, 6.0], rtol=0.01)
    again = jid.identify(smooth(truth), estimate.joint, search="separable")
    check(again, truth)


def test_published_asymmetric_fit(emps: Path) -> None:
    published = {
        "inertia": 95.1540,
        "viscous_positive": 166.7061,
        "coulomb_positive": 20.1440,
        "viscous_negative": 240.4236,
        "coulomb_negative": 20.6277,
    }
    recording = jid.load(emps / "emps_train.csv.gz")
    joint = jid.Joint(kind="prismatic", torque_offset=False)  # as published
    estimate = jid.identify(recording, joint, model=jid.Model(asymmetric=True))
    for name, value in published.items():
        assert estimate.parameters[name].value == pytest.approx(value, rel=0.02), name


def test_published_asymmetric_fit_from_matlab(emps: Path) -> None:
    recording = jid.load(
        emps / "DATA_EMPS.mat",
        columns={"time": "t", "position": "qm", "torque": "vir"},
        scale={"torque": 35.150652},
        kind="prismatic",
    )
    matlab = jid.identify(recording, model=jid.Model(asymmetric=True), search="separable")
    csv = jid.identify(
        jid.load(emps / "emps_train.csv.gz"), model=jid.Model(asymmetric=True), search="separable"
    )
    for name in ("inertia", "viscous_positive", "coulomb_negative"):
        assert matlab.parameters[name].value == pytest.approx(csv.parameters[name].value, rel=1e-4)
    assert matlab.parameters["viscous_positive"].value == pytest.approx(166.7061, rel=0.02)
    assert matlab.parameters["viscous_negative"].value == pytest.approx(240.4236, rel=0.02)


def test_harmonics_and_ripple() -> None:
    truth = {
        "inertia": 0.8,
        "coulomb": 2.0,
        "viscous": 4.0,
        "position_cos_3": 0.5,
        "position_sin_3": -0.7,
        "ripple_cos_2": 0.3,
        "ripple_sin_2": 0.4,
    }
    joint = jid.Joint(gear_ratio=7.0)
    estimate = jid.identify(smooth(truth, 7.0), joint, model=jid.Model(ripple=(2,), harmonics=(3,)))
    check(estimate, truth)
    assert estimate.joint.model.ripple == (2.0,)
    assert estimate.joint.model.harmonics == (3.0,)


def test_ripple_of_a_strain_wave_sensor(shared_data: Path) -> None:
    recording = jid.load(shared_data / "simulated" / "rippled.csv.gz")
    estimate = jid.identify(recording, jid.thesis_joint(), model=jid.Model(ripple=(2,)))
    value = {name: p.value for name, p in estimate.parameters.items()}
    assert value["sensor_gain"] == pytest.approx(2.4, rel=0.003)
    assert value["static"] == pytest.approx(20.0, rel=0.01)
    assert value["stribeck"] == pytest.approx(100.0, rel=0.02)
    amplitude = np.hypot(value["ripple_cos_2"], value["ripple_sin_2"])
    assert amplitude == pytest.approx(2.6, rel=0.01)
    assert estimate.warnings == ()


def test_cost_of_ignoring_the_ripple(shared_data: Path) -> None:
    recording = jid.load(shared_data / "simulated" / "rippled.csv.gz")
    estimate = jid.identify(recording, jid.thesis_joint(), search="separable")
    assert 0.01 < 1 - estimate.parameters["sensor_gain"].value / 2.4 < 0.04
    assert 0.03 < estimate.parameters["static"].value / 20.0 - 1 < 0.09


def test_realistic_sensing(shared_data: Path) -> None:
    raw = jid.load(shared_data / "simulated" / "realistic.csv.gz", columns={"velocity": None})
    estimate = jid.identify(raw, jid.thesis_joint(), model=jid.Model(ripple=(2,)))
    for name, truth in TRUTH.items():
        tolerance = 0.05 if name == "stribeck" else 0.02
        assert estimate.parameters[name].value == pytest.approx(truth, rel=tolerance), name


@pytest.mark.parametrize("method", ["ga", "separable"])
def test_general_exponent_finds_the_gaussian(well_excited: jid.Recording, method: Any) -> None:
    estimate = jid.identify(
        well_excited,
        jid.thesis_joint(),
        model="stribeck_general",
        search=jid.Search(method, ga=jid.GaOptions(population=40, generations=60)),
    )
    check(
        estimate,
        {"stribeck_velocity": 0.1, "stribeck_exponent": 2.0, "static": 20.0, "coulomb": 25.0},
        0.005,
    )


def test_load_friction_is_found_where_it_is() -> None:
    base = smooth({"inertia": 0.8, "coulomb": 2.0, "viscous": 4.0})
    assert base.torque is not None
    # tau = tau_0 + f |tau| sgn v, solved for tau where |tau| takes its sign from tau_0.
    factor = 0.1 * np.sign(base.velocity) * np.sign(base.torque)
    loaded = jid.Recording(
        time=base.time,
        position=base.position,
        velocity=base.velocity,
        torque=base.torque / (1 - factor),
    )
    estimate = jid.identify(loaded, model=jid.Model(load_friction=True), search="separable")
    assert estimate.parameters["load_friction"].value == pytest.approx(0.1, rel=0.06)
    assert estimate.parameters["coulomb"].value == pytest.approx(2.0, rel=0.03)
    # The friction map is that of the velocity and the load; without load it is what the windows show.
    value = {name: p.value for name, p in estimate.parameters.items()}
    bare, under_load = estimate.friction([-1.0, 1.0]), estimate.friction([-1.0, 1.0], load=-20.0)
    expected = np.array([-1.0, 1.0]) * (value["coulomb"] + value["viscous"])
    np.testing.assert_allclose(bare.torque, expected)
    np.testing.assert_allclose(
        under_load.torque - bare.torque,
        [-20.0 * value["load_friction"], 20.0 * value["load_friction"]],
    )
    assert np.all(under_load.upper - under_load.lower > bare.upper - bare.lower)
    moving = np.abs(estimate.windows.velocity) > 0.3
    predicted = estimate.friction(estimate.windows.velocity[moving]).torque
    np.testing.assert_allclose(estimate.windows.friction[moving], predicted, atol=0.1)


def test_offset_of_each_recording() -> None:
    base = {"inertia": 0.8, "coulomb": 2.0, "viscous": 4.0}
    runs = [
        smooth({**base, "torque_offset": offset}, seed=seed)
        for seed, offset in enumerate((0.5, -0.9))
    ]
    estimate = jid.identify(runs, model=jid.Model(per_recording=("torque_offset",)))
    check(estimate, {**base, "torque_offset[0]": 0.5, "torque_offset[1]": -0.9})
    shared = jid.identify(runs)
    assert shared.penalty > 10 * estimate.penalty
    assert jid.Estimate.from_json(estimate.to_json()).parameters == estimate.parameters


def two_runs() -> list[jid.Recording]:
    base = {"inertia": 0.8, "coulomb": 2.0, "viscous": 4.0}
    return [
        smooth({**base, "torque_offset": offset}, seed=seed)
        for seed, offset in enumerate((0.5, -0.9))
    ]


def test_what_a_call_has_apart_is_not_a_property_of_the_joint() -> None:
    runs = two_runs()
    apart = jid.Model(per_recording=("torque_offset",))
    for base in (None, jid.Joint(name="axis")):
        joint = jid.identify(runs, base, model=apart, search="separable").joint
        assert joint.model.per_recording is None
        jid.OnlineIdentifier(joint).close()
        alone = jid.identify(runs[0], joint, search="separable")
        assert "torque_offset" in alone.parameters
        assert jid.compare_models(runs[0], joint, folds=2).winner == "coulomb_viscous"


def test_what_the_joint_has_apart_stays_and_may_not_apply() -> None:
    runs = two_runs()
    joint = jid.Joint(model=jid.Model(per_recording=("torque_offset", "static")))
    both = jid.identify(runs, joint, search="separable")
    assert {"torque_offset[0]", "torque_offset[1]"} <= both.parameters.keys()
    assert both.joint.model.per_recording == joint.model.per_recording
    alone = jid.identify(runs[0], joint, search="separable")
    assert "torque_offset" in alone.parameters
    assert alone.joint.model.per_recording == joint.model.per_recording
    jid.OnlineIdentifier(joint).close()


@pytest.mark.parametrize("count", [1, 2])
@pytest.mark.parametrize("joint", [None, jid.Joint(model=jid.Model(per_recording=("static",)))])
def test_what_a_call_has_apart_is_among_the_terms(count: int, joint: jid.Joint | None) -> None:
    with pytest.raises(jid.InputError, match="the model has no term static; choose one of inertia"):
        jid.identify(two_runs()[:count], joint, model=jid.Model(per_recording=("static",)))


def test_a_joint_without_a_name_is_called_joint() -> None:
    with pytest.raises(jid.InputError, match=r"^recording 0: sensor: joint has a torque sensor"):
        jid.identify(two_runs()[0], jid.Joint(sensor=True))
    with pytest.raises(jid.InputError, match="joint is prismatic"):
        jid.identify(two_runs()[0], jid.Joint(kind="prismatic"))


def test_cumulative_windows_are_the_running_integral(well_excited: jid.Recording) -> None:
    estimate = jid.identify(
        well_excited, jid.thesis_joint(), windows="cumulative", search="separable"
    )
    assert estimate.residuals.windows > 11000
    assert not {"noisy_velocity", "structured_residual"} & {w.code for w in estimate.warnings}
    for name, truth in TRUTH.items():
        assert estimate.parameters[name].value == pytest.approx(truth, rel=0.05), name


@pytest.mark.parametrize("zero", [-2048.0, 0.0, 2048.0])
@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_the_sensors_zero_and_polarity_are_arbitrary(
    well_excited: jid.Recording, zero: float, sign: float
) -> None:
    assert well_excited.sensor is not None
    recording = jid.Recording(
        time=well_excited.time,
        position=well_excited.position,
        velocity=well_excited.velocity,
        torque=well_excited.torque,
        sensor=sign * well_excited.sensor + zero,
        torque_hold="zoh",
    )
    estimate = jid.identify(
        recording, model="stribeck", parameters={"inertia": THESIS_INERTIA}, search="separable"
    )
    assert estimate.parameters["sensor_gain"].value == pytest.approx(sign * 2.4, rel=0.01)
    assert estimate.parameters["coulomb"].value == pytest.approx(25.0, rel=0.01)
    assert estimate.warnings == ()


REFUSED = {
    "ripple without a gear": ({"ripple": (2,)}, None, "gear_ratio"),
    "ripple twice": ({"ripple": (2, 2)}, jid.Joint(gear_ratio=9.0), "different orders"),
    "ripple that is none": ({"ripple": 0}, jid.Joint(gear_ratio=9.0), "orders"),
    "first harmonic is gravity": (
        {"harmonics": (1,)},
        jid.Joint(model=jid.Model(gravity="free")),
        "gravity",
    ),
    "shape per recording": ({"per_recording": ("viscosity",)}, None, "coefficients"),
}


@pytest.mark.parametrize(("options", "joint", "wording"), REFUSED.values(), ids=REFUSED.keys())
def test_indistinguishable_terms_are_refused(
    options: dict[str, Any], joint: jid.Joint | None, wording: str
) -> None:
    recording = smooth({"inertia": 0.8, "coulomb": 2.0, "viscous": 4.0})
    with pytest.raises(jid.InputError, match=wording):
        jid.identify([recording, recording[0.5:]], joint, model=options)
