"""Load friction wins where it is, and nowhere else. The joints are those of tests/plants, no code of the package."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from plants import Bench, Law, Log, Plant, simulate, thesis

import jointid as jid
from jointid.comparison.load_evidence import load_refusal

INERTIA = 2.472e-4 * 101.0**2
SENSED = jid.Joint(inertia=INERTIA, sensor=True, torque_hold="zoh")
LINK = jid.Link(mass=4.0, centre_of_mass=1.0, inertia=1.0)
BARE = jid.Joint(inertia=INERTIA, link=LINK, torque_hold="zoh")
HEAVY = Plant(coulomb=12.0, gravity=40.0, link_inertia=2.0, load_friction=0.2)
# What a model may lack, with a sensor.
OTHERS = {
    "nothing": (Plant(), Log()),
    "viscous drift": (Plant(viscous_drift=-0.3), Log()),
    "sin 3q": (Plant(harmonic_torque=1.0), Log()),
    "torque late": (Plant(), Log(torque_delay=2e-3)),
    "torque constant": (Plant(torque_scale=1.1), Log()),
    "pre-sliding": (Plant(bristle_stiffness=1e5, bristle_damping=500.0), Log()),
    "Stribeck exponent": (Plant(exponent=1.0), Log()),
    "crooked sensor": (Plant(), Log(nonlinearity=0.05)),
}


@pytest.fixture(scope="module")
def runs() -> list[jid.Recording]:
    motion = thesis(np.radians([60.0]))
    sensed = Law(inertia=2.5, stiffness=60.0, feedback=1.5)
    weighed = Law(inertia=2.7, gravity=30.0, stiffness=60.0)
    bare = Plant(coulomb=12.0, gravity=40.0, link_inertia=1.0, load_friction=0.2)
    benches = [
        Bench(motion=motion, law=sensed, plant=HEAVY),
        Bench(motion=motion, law=weighed, plant=bare, log=Log(sensor=0.0, torque_noise=0.2)),
        *(Bench(motion=motion, law=sensed, plant=p, log=log) for p, log in OTHERS.values()),
    ]
    # A load friction of 0.05, and a drift that resembles it.
    small = (
        replace(bare, load_friction=0.05),
        replace(bare, load_friction=0.0, viscous_drift=-0.3),
    )
    benches += [replace(benches[1], plant=each) for each in small]
    return simulate(Bench.stack(benches), duration=9.0, seed=7, finer=2)


@pytest.mark.parametrize(
    ("number", "joint", "true"),
    [(-2, BARE, 0.05), (-2, jid.Joint(torque_hold="zoh"), 0.05), (-1, BARE, 0.0)],
    ids=["true, link", "true, no link", "drift"],
)
def test_a_small_load_friction_is_told_from_a_drift(
    runs: list[jid.Recording], number: int, joint: jid.Joint, true: float
) -> None:
    """The drift is taken away before the values are fitted; it would look like a load friction of 0.05."""
    model = "stribeck:gravity=free:load_friction"
    estimate = jid.identify(runs[number], joint, model=jid.Model.parse(model), search="separable")
    assert estimate.parameters["load_friction"].value == pytest.approx(
        true, abs=0.015 if true else 1e-3
    )
    assert (load_refusal(estimate) is not None) == (true == 0.0)


@pytest.mark.parametrize(
    ("number", "joint", "base", "link_known"),
    [
        (0, SENSED, "stribeck", False),
        (1, BARE, "stribeck:gravity=free", True),
        (1, jid.Joint(torque_hold="zoh"), "stribeck:gravity=free", False),
    ],
    ids=["sensor", "gravity, link known", "gravity"],
)
def test_true_load_friction_is_found(
    runs: list[jid.Recording], number: int, joint: jid.Joint, base: str, link_known: bool
) -> None:
    estimate = jid.identify(
        runs[number], joint, model=jid.Model.parse(f"{base}:load_friction"), search="separable"
    )
    assert estimate.parameters["load_friction"].value == pytest.approx(0.2, rel=0.05)
    assert estimate.settings["terms"].count("load_friction_link") == 1
    again = jid.identify(runs[number], estimate.joint, search="separable")
    assert again.parameters["load_friction"].value == estimate.parameters["load_friction"].value
    bare, under_load = estimate.friction([1.0]), estimate.friction([1.0], load=10.0)
    assert under_load.torque[0] - bare.torque[0] == pytest.approx(2.0, rel=0.06)
    assert jid.Estimate.from_json(estimate.to_json()).parameters == estimate.parameters
    if joint.sensor or link_known:
        found = jid.compare_models(runs[number], joint, models=[base, f"{base}:load_friction"])
        assert found.winner.startswith(f"{base}:load_friction")


@pytest.mark.parametrize("number", range(len(OTHERS)), ids=list(OTHERS))
def test_other_errors_are_not_taken_for_load_friction(
    runs: list[jid.Recording], number: int
) -> None:
    models = ["coulomb_viscous", "stribeck", "stribeck:load_friction"]
    found = jid.compare_models(runs[number + 2], SENSED, models=models)
    assert "load_friction" not in found.winner
    assert found.rows[-1].reason


@pytest.mark.parametrize(("joint", "ratio"), [(3, 45.0), (4, -48.0), (5, 45.0), (6, 32.0)])
def test_an_industrial_robot_has_no_known_load(shared_data: Path, joint: int, ratio: float) -> None:
    log = jid.load(
        shared_data / "tx40" / "tx40.csv.gz",
        columns={
            "time": "time_s",
            "position": f"motor_position_{joint}_rad",
            "torque": f"motor_torque_{joint}_Nm",
        },
    )
    assert log.torque is not None
    run = jid.Recording(time=log.time, position=log.position / ratio, torque=log.torque * ratio)
    models = ["coulomb_viscous", "coulomb_viscous:load_friction"]
    found = jid.compare_models(run, models=models)
    assert found.winner == "coulomb_viscous"
    assert "load_friction" in found.rows[1].reason


@pytest.mark.parametrize("sensor", [True, False])
def test_a_load_that_scales_all_values_is_refused(runs: list[jid.Recording], sensor: bool) -> None:
    run = runs[2]
    if not sensor:
        run = jid.Recording(
            time=run.time, position=run.position, velocity=run.velocity, torque=run.torque
        )

    def found(joint: jid.Joint | None, load: str) -> set[str]:
        model = f"stribeck:load_friction={load}"
        estimate = jid.identify(run, joint, model=jid.Model.parse(model), search="separable")
        return {each.code for each in estimate.findings if each.severity == "blocking"}

    assert "load_scale" in found(None, "drive")
    known = jid.Joint(inertia=INERTIA, sensor=sensor, torque_hold="zoh")
    assert "load_scale" not in found(known, "drive")
    # A load behind the gear is known apart from the drive's torque.
    assert ("load_scale" in found(None, "true")) == (not sensor)
    compared = jid.compare_models(run, models=["stribeck", "stribeck:load_friction=drive"])
    assert compared.winner == "stribeck"
    assert "neither inertia nor gravity is known" in compared.rows[1].reason


def test_instruments_and_load_friction_exclude_each_other(runs: list[jid.Recording]) -> None:
    with pytest.raises(jid.InputError, match="instruments"):
        jid.identify(
            runs[0], SENSED, model=jid.Model.parse("stribeck:load_friction"), residual="instruments"
        )
