"""A late torque beside own terms: found as without them."""

from typing import Any

import numpy as np
import pytest

import jointid as jid
from jointid.identification.search.search import Search

LATE = 0.004
TIME = np.arange(10_000) * 0.002


def wave(frequencies: tuple[float, ...], sizes: tuple[float, ...]) -> tuple[Any, Any, Any]:
    """Position, velocity and acceleration of a sum of sines."""
    rates = 2.0 * np.pi * np.array(frequencies)
    phase = rates[:, None] * TIME + np.arange(len(rates))[:, None]
    amplitude = np.array(sizes)[:, None]
    return (
        (amplitude * np.sin(phase)).sum(0),
        (amplitude * rates[:, None] * np.cos(phase)).sum(0),
        (-amplitude * rates[:, None] ** 2 * np.sin(phase)).sum(0),
    )


Q, V, A = wave((0.17, 0.43, 0.9), (0.9, 0.3, 0.12))
Q6, V6, _ = wave((0.23, 0.61, 1.3), (0.7, 0.3, 0.1))


@pytest.mark.parametrize(
    ("more", "signal", "terms"),
    [
        (2.0 * V6 + 3.0 * np.sign(V6), Q6, "viscous@rate+coulomb@rate"),
        (40.0 * np.sin(Q6), Q6, "torque_over"),
        (40.0 * np.sin(Q6), 44.0 * np.sin(Q6), "scaled"),
        (
            1.2 * np.cos(Q6) * A - 1.2 * np.sin(Q6) * V6 * V,
            3.0 + 1.2 * np.cos(Q6),
            "inertia_others",
        ),
    ],
)
def test_a_late_torque_is_found_beside_own_terms(more: Any, signal: Any, terms: str) -> None:
    random = np.random.default_rng(5)
    needed = 4.5 * A + 8.0 * np.sign(V) + 5.0 * V + 0.7 + more
    recording = jid.Recording(
        time=TIME,
        position=Q + random.normal(scale=2e-5, size=len(TIME)),
        torque=np.interp(TIME - LATE, TIME, needed) + random.normal(scale=0.5, size=len(TIME)),
        extra={"other": signal},
    )
    estimate = jid.identify(
        recording, model="coulomb_viscous", terms={"other": terms}, search=Search("separable")
    )
    assert estimate.settings["shift"]["torque"] == pytest.approx(LATE, abs=1.5e-4)
    (delay,) = (each for each in estimate.delays.values() if each.signal == "torque")
    assert delay.stderr < 3e-4
    assert estimate.parameters["viscous"].value == pytest.approx(5.0, abs=0.03)
