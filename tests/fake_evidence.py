"""Evidence that a check of findings reads, made of plain values, so that a threshold can be met from both sides."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np

import jointid as jid
from jointid.estimate.findings import Finding
from jointid.estimate.statistics import ParameterEstimate
from jointid.identification.inference.purposes import Torques
from jointid.identification.warnings import registry

TIME = np.arange(2000) * 1e-3
RUN = jid.Recording(
    time=TIME, position=np.sin(TIME), velocity=np.cos(TIME), torque=np.sin(3.0 * TIME)
)


def parameter(name: str, value: float, half: float | None = 0.0, **other: Any) -> ParameterEstimate:
    """A free parameter whose 95 % interval reaches `half` to either side."""
    fields: dict[str, Any] = {
        "name": name,
        "meaning": name,
        "unit": "",
        "value": value,
        "stderr": None if half is None else half / 1.96,
        "interval": None if half is None else (value - half, value + half),
        "min": -np.inf,
        "max": np.inf,
        "vary": True,
        "at_bound": None,
        "shift_halved": None,
        "shift_doubled": None,
    }
    return ParameterEstimate(**(fields | other))


def signal(**counts: Any) -> SimpleNamespace:
    """Counts of one signal; it varies, and nothing is wrong with it."""
    edge = SimpleNamespace(there=0, moving=0, near=0)
    usual = {
        "lowest": -1.0,
        "highest": 1.0,
        "fine": True,
        "changes": 1999,
        "lower": edge,
        "upper": edge,
        "moving": 1000,
        "stale": 0,
        "frozen": 0,
    }
    return SimpleNamespace(**(usual | counts))


def inspected(recording: Any = RUN, counts: Any = None, **found: Any) -> SimpleNamespace:
    """A recording and what its signals show; `counts` by the signal's name."""
    known = counts or {}
    usual = {
        "agreement": None,
        "peak_speed": 1.0,
        "swing": 2.0,
        "timing_errors": (0.0, 0.0),
        "jump": -1,
    }
    return SimpleNamespace(
        recording=recording,
        threads=0,
        channels=tuple(known),
        counts=known.__getitem__,
        stale_share=lambda name: known[name].stale / known[name].moving if name in known else 0.0,
        spike=lambda _: SimpleNamespace(count=0),
        found=SimpleNamespace(**(usual | found)),
    )


def evidence(*parameters: ParameterEstimate, **given: Any) -> Any:
    """Evidence of a good fit, but for what is given."""
    recordings = given.pop("recordings", (RUN,))
    residuals = {
        "windows": 1000,
        "window_duration": 0.01,
        "noise_share": 0.0,
        "r_squared": 0.999,
        "relative": 0.01,
        "autocorrelation": 0.0,
        "standing": 0.0,
    } | given.pop("residuals", {})
    choice = SimpleNamespace(
        terms=tuple(each.name for each in parameters),
        residual="torque",
        residual_reason="",
        model=jid.Model("stribeck"),
    )
    problem = SimpleNamespace(
        choice=choice, recordings=recordings, hold=lambda _: "linear", threads=1, peak_speed=1.0
    )
    usual: dict[str, Any] = {
        "problem": problem,
        "recordings": recordings,
        "inspections": tuple(inspected(each) for each in recordings),
        "parameters": {each.name: each for each in parameters},
        "chance": {each.name: 1.0 for each in parameters},
        "residuals": SimpleNamespace(**residuals),
        "penalty": SimpleNamespace(
            names=[each.name for each in parameters],
            coefficients=len(parameters),
            noise_limited=False,
            cumulative=False,
        ),
        "torque_level": 10.0,
        "joint": None,
        "causes": None,
        "cause_of": lambda *_, **__: None,
        "white": False,
        "delays": {},
        "undivided": (),
        "correlations": {},
        "bounds_from_data": (),
        "guessed_sign": False,
        "velocity_effect": None,
        "own_noise": None,
        "torques": Torques(
            single={each.name: 1.0 for each in parameters},
            friction=frozenset(("coulomb", "viscous", "static", "load_friction")),
            of_friction=0.1,
            of_drive=0.1,
        ),
        "model": "stribeck",
        "sensor_parameters": (),
        "cross_check": jid.estimate.cross_check.CrossCheck(reason="none"),
    }
    return SimpleNamespace(**(usual | given))


def found(check: str, given: Any) -> list[Finding]:
    """What one file of checks says."""
    number = registry.FILES.index(check)
    return registry.CHECKS[number].findings(given)
