"""A torque that holds no friction is measured behind it, or the joint has none: neither serves compensation."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from defects import changed
from plain_joint import motion, torque

import jointid as jid
from jointid.estimate.findings import Finding


def behind_the_friction(
    folder: Path,
    header: str,
    *,
    seed: int = 0,
    weight: float = 4.0,
    friction: float = 0.0,
    noise: float = 0.01,
) -> Path:
    """A log of a reading behind the gear: the link's inertia and weight, and a share of the drive's friction."""
    time, position, velocity, acceleration = motion(seed=seed)
    reading = torque(velocity, acceleration, 3.0 * friction, 1.2 * friction)
    reading += noise * np.random.default_rng(seed).normal(size=len(time))
    reading += weight * np.sin(position)
    path = folder / "log.csv"
    columns = np.column_stack([time, position, velocity, reading])
    head = f"time_s,position_rad,velocity_rad_s,{header}"
    np.savetxt(path, columns, delimiter=",", header=head, comments="")
    return path


def found_in(estimate: jid.Estimate) -> Finding | None:
    return next((each for each in estimate.findings if each.code == "no_friction"), None)


@pytest.mark.parametrize("header", ["joint_torque_Nm", "tau_J [Nm]", "joint torque sensor (Nm)"])
def test_a_header_of_the_joint_names_the_cause(tmp_path: Path, header: str) -> None:
    path = behind_the_friction(tmp_path, header, friction=0.004)
    estimate = jid.identify(jid.load(path, columns={"torque": header}))
    finding = found_in(estimate)
    assert finding is not None
    assert finding.severity == "blocking"
    assert "a torque measured at the link contains no friction of the drive" in finding.cause
    assert repr(header) in finding.cause
    assert "load the motor's torque or current" in finding.advice[0].text
    assert finding.advice[1].arguments["columns"]["sensor"] == header
    assert estimate.verdict.uses["compensation"].level == "not usable"
    assert estimate.findings[0] is finding


@pytest.mark.parametrize(("seed", "weight"), [(0, 4.0), (1, 0.0), (2, 10.0)])
def test_a_simulator_without_friction_is_good_for_simulation(
    tmp_path: Path, seed: int, weight: float
) -> None:
    estimate = jid.identify(
        jid.load(behind_the_friction(tmp_path, "torque_Nm", seed=seed, weight=weight))
    )
    finding = found_in(estimate)
    assert finding is not None
    assert finding.severity == "warning"
    assert "measured at the link" in finding.cause
    assert "simulated without friction" in finding.cause
    levels = {purpose: use.level for purpose, use in estimate.verdict.uses.items()}
    assert levels["compensation"] == "not usable"
    assert levels["simulation"] == "usable"
    assert "at_bound" not in {each.code for each in estimate.findings}


@pytest.mark.parametrize("seed", [1, 8])
def test_noise_is_no_viscous_friction(tmp_path: Path, seed: int) -> None:
    path = behind_the_friction(tmp_path, "torque_Nm", seed=seed, weight=0.0, noise=0.2)
    estimate = jid.identify(jid.load(path))
    assert found_in(estimate) is not None
    assert estimate.verdict.uses["compensation"].level == "not usable"


def test_a_damper_is_friction(tmp_path: Path) -> None:
    path = behind_the_friction(tmp_path, "torque_Nm", weight=0.0)
    run = jid.load(path)
    damped = changed(run, torque=np.asarray(run.torque) + 0.05 * run.velocity)
    estimate = jid.identify(damped)
    assert found_in(estimate) is None
    assert estimate.parameters["viscous"].value == pytest.approx(0.05, rel=0.1)


@pytest.mark.parametrize("friction", [0.05, 0.2, 1.0])
def test_small_friction_is_friction(tmp_path: Path, friction: float) -> None:
    estimate = jid.identify(jid.load(behind_the_friction(tmp_path, "torque_Nm", friction=friction)))
    assert found_in(estimate) is None
    assert estimate.parameters["coulomb"].value == pytest.approx(3.0 * friction, rel=0.1)


def test_a_header_of_the_joint_does_no_harm_to_friction(tmp_path: Path) -> None:
    estimate = jid.identify(
        jid.load(behind_the_friction(tmp_path, "joint_torque_Nm", friction=1.0))
    )
    assert estimate.verdict.level == "usable"
