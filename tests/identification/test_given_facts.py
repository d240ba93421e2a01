"""What the tolerances of given facts mean for each parameter: the same as facts that are off."""

import dataclasses
from pathlib import Path

import pytest
from example_recordings import WELL_EXCITED

import jointid as jid
from jointid.cli.demonstration import data_folder


@pytest.fixture(scope="module")
def run() -> jid.Recording:
    return jid.load(WELL_EXCITED)


def other(run: jid.Recording, joint: jid.Joint, scale: float = 1.0) -> dict[str, float]:
    assert run.torque is not None
    signals = {name: getattr(run, name) for name in run.signals} | {"torque": scale * run.torque}
    scaled = jid.Recording(**signals, torque_hold=run.torque_hold)
    found = jid.identify(scaled, joint, search="separable").parameters
    return {name: p.value for name, p in found.items()}


@pytest.mark.parametrize("fact", ["torque_constant", "rotor_inertia"])
def test_a_part_is_what_a_fact_at_its_limits_does(run: jid.Recording, fact: str) -> None:
    joint = jid.thesis_joint()
    limits = []
    for side in (0.95, 1.05):
        if fact == "torque_constant":
            limits.append(other(run, joint, side))
        else:
            assert joint.rotor_inertia is not None
            limits.append(other(run, joint.replace(rotor_inertia=side * joint.rotor_inertia)))
    found = jid.identify(run, joint.replace(tolerances={fact: "5 %"}), search="separable")
    before = other(run, joint)
    for name, p in found.parameters.items():
        moved = max(abs(each[name] - before[name]) for each in limits)
        assert p.systematic["given"] == pytest.approx(moved, rel=0.02, abs=1e-4 * abs(p.value))
        assert p.value == pytest.approx(before[name])
    p = found.parameters["sensor_gain"]
    assert p.largest_part == "given"
    assert p.interval is not None
    assert p.interval[1] - p.value < 0.1 * p.systematic["given"]  # it holds if the facts are right
    assert "(given)" in found.report(verbose=True)
    assert f"{fact} ± 5 %" in found.report(verbose=True)


def test_several_facts_add_as_squares(run: jid.Recording) -> None:
    def given(**tolerances: str | float) -> float:
        joint = jid.thesis_joint().replace(tolerances=tolerances)
        found = jid.identify(run, joint, search="separable").parameters["sensor_gain"]
        return found.systematic["given"]

    inertia = 0.03 * 2.472e-4  # absolute, motor side
    both = given(torque_constant="2 %", rotor_inertia=inertia)
    alone = given(torque_constant="2 %"), given(rotor_inertia="3 %")
    assert both == pytest.approx((alone[0] ** 2 + alone[1] ** 2) ** 0.5)
    assert given(gear_ratio="0 %") == 0.0


def test_known_gravity_passes_its_tolerance_on() -> None:
    run = jid.load(data_folder() / "kr300_joint1.csv.gz")
    link = jid.Link(mass=100.0, centre_of_mass=0.5)
    joint = jid.Joint(
        gear_ratio=256.86, link=link, model=jid.Model("coulomb_viscous", gravity="known")
    )
    found = jid.identify(run, joint.replace(tolerances={"mass": "10 %"}), search="separable")
    cosine = found.parameters["gravity_cos"]
    assert cosine.systematic["given"] == pytest.approx(0.1 * cosine.value)
    heavier = joint.replace(link=dataclasses.replace(link, mass=110.0))
    moved = jid.identify(run, heavier, search="separable").parameters["inertia"].value
    inertia = found.parameters["inertia"]
    assert inertia.systematic["given"] == pytest.approx(abs(moved - inertia.value), rel=0.01)


def test_without_tolerances_there_is_no_such_part(run: jid.Recording) -> None:
    found = jid.identify(run, jid.thesis_joint(), search="separable")
    assert all("given" not in p.systematic for p in found.parameters.values())
    assert {"windows", "sampling"} <= found.parameters["coulomb"].systematic.keys()


def test_an_estimate_keeps_them(run: jid.Recording, tmp_path: Path) -> None:
    joint = jid.thesis_joint().replace(tolerances={"torque_constant": "5 %"})
    found = jid.identify(run, joint, search="separable")
    found.save(tmp_path / "estimate.json")
    read = jid.Estimate.load(tmp_path / "estimate.json")
    assert read.report(verbose=True) == found.report(verbose=True)
    assert read.parameters["coulomb"].systematic == found.parameters["coulomb"].systematic
    assert read.joint == found.joint
