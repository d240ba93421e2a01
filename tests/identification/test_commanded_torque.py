"""A torque that is held between samples, of which nobody says so: read as held where that predicts better."""

from __future__ import annotations

import pytest
from commanded_torque import TRUTH, log

import jointid as jid


@pytest.mark.parametrize("seed", [2, 3, 5])
def test_it_is_read_so_and_said(seed: int) -> None:
    estimate = jid.identify(log(seed))
    for name, true in TRUTH.items():
        assert estimate.parameters[name].value == pytest.approx(true, rel=0.01), name
    (said,) = (each for each in estimate.findings if each.code == "held_torque")
    assert dict(said.advice[0].arguments) == {"torque_hold": "zoh"}
    assert estimate.settings["torque_hold"] == "zoh"
    assert not estimate.delays["torque"].applied


@pytest.mark.parametrize("seed", [2, 3, 5])
def test_a_measured_torque_is_not(seed: int) -> None:
    estimate = jid.identify(log(seed, measured=True))
    assert "held_torque" not in {each.code for each in estimate.findings}
    assert estimate.settings["torque_hold"] is None


def test_what_is_stated_stands() -> None:
    by_file = jid.identify(log(2, torque_hold="linear"))
    by_call = jid.identify(log(2), torque_hold="linear")
    by_joint = jid.identify(
        log(2), jid.Joint(torque_hold="linear", model=jid.Model("coulomb_viscous"))
    )
    for estimate in (by_file, by_call, by_joint):
        assert "held_torque" not in {each.code for each in estimate.findings}
