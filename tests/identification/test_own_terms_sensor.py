"""Own terms beside a torque sensor, a drift, and several recordings."""

from typing import Any

import numpy as np
import pytest

import jointid as jid
from jointid.identification.search.search import Search

TIME = np.arange(6000) * 0.002
Q = 0.8 * np.sin(2.1 * TIME) + 0.3 * np.sin(5.3 * TIME + 1.0)
V = 0.8 * 2.1 * np.cos(2.1 * TIME) + 0.3 * 5.3 * np.cos(5.3 * TIME + 1.0)
A = -0.8 * 2.1**2 * np.sin(2.1 * TIME) - 0.3 * 5.3**2 * np.sin(5.3 * TIME + 1.0)
Q6 = 0.5 * np.sin(3.3 * TIME + 0.4) + 0.2 * np.cos(1.1 * TIME)
V6 = 0.5 * 3.3 * np.cos(3.3 * TIME + 0.4) - 0.22 * np.sin(1.1 * TIME)
MODEL = 20.0 * np.sin(0.9 * TIME + 0.2)


def noise(seed: int) -> Any:
    return np.random.default_rng(seed).normal(scale=0.3, size=len(TIME))


def identify(recording: Any, terms: Any, **changes: Any) -> jid.Estimate:
    found: jid.Estimate = jid.identify(
        recording,
        **({"model": "coulomb_viscous"} | changes),
        terms=terms,
        search=Search("separable"),
    )
    return found


@pytest.mark.parametrize("residual", ["sensor", "torque", "instruments"])
def test_other_friction_is_found_beside_a_sensor(residual: str) -> None:
    link = 2.0 * A + MODEL
    torque = link + 0.5 * A + 12.0 * np.sign(V) + 6.0 * V + 3.0 * V6 + noise(0)
    recording = jid.Recording(
        time=TIME,
        position=Q,
        velocity=V,
        torque=torque,
        sensor=link + noise(1),
        extra={"q6": Q6},
    )
    estimate = identify(recording, {"q6": "viscous@rate"}, residual=residual)
    assert estimate.settings["residual"] == residual
    for name, true in {"viscous": 6.0, "viscous_of_q6_rate": 3.0, "sensor_gain": 1.0}.items():
        assert estimate.parameters[name].value == pytest.approx(true, rel=0.02), name


def test_a_drift_is_removed_beside_own_terms() -> None:
    fading = 12.0 * np.sign(V) * (1.0 - 0.3 * TIME / TIME[-1])
    torque = 2.5 * A + fading + 6.0 * V + 1.0 + 3.0 * V6 + MODEL + noise(0)
    recording = jid.Recording(
        time=TIME, position=Q, velocity=V, torque=torque, extra={"q6": Q6, "tau": MODEL}
    )
    estimate = identify(recording, {"q6": "viscous@rate", "tau": "known"})
    assert estimate.settings["drift_removed"] == "coulomb"
    assert estimate.parameters["viscous_of_q6_rate"].value == pytest.approx(3.0, rel=0.01)
    assert estimate.parameters["viscous"].value == pytest.approx(6.0, rel=0.01)


def test_gains_of_each_recording() -> None:
    plain = 2.5 * A + 12.0 * np.sign(V) + 6.0 * V + 1.0 + 3.0 * V6
    runs = [
        jid.Recording(
            time=TIME,
            position=Q,
            velocity=V,
            torque=plain + gain * MODEL + noise(seed),
            extra={"q6": Q6, "tau": MODEL},
        )
        for seed, gain in enumerate((0.9, 0.7))
    ]
    model = jid.Model("coulomb_viscous", per_recording=("scale_of_tau",))
    terms = {"q6": "viscous@rate", "tau": "scaled"}
    estimate = identify(runs, terms, model=model)
    found = [estimate.parameters[f"scale_of_tau[{k}]"].value for k in (0, 1)]
    assert found == pytest.approx([0.9, 0.7], rel=0.01)
    assert estimate.parameters["viscous_of_q6_rate"].value == pytest.approx(3.0, rel=0.01)
