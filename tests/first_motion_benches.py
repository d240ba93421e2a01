"""Benches of a first motion, right and wrong, and what their joints truly do."""

import math
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

import jointid as jid
from jointid.hardware.bench.bench import Bench
from jointid.hardware.elmo.drive import ElmoDrive
from jointid.hardware.elmo.emulated_bench import ElmoEmulation, elmo_devices
from jointid.hardware.elmo.emulated_drive import EmulatedElmo
from jointid.hardware.emulated.bus import EmulatedBus
from jointid.hardware.emulated.faults import BusFault
from jointid.hardware.proof.result import FirstMotion

EXAMPLE = Path(__file__).resolve().parents[1] / "examples" / "hardware" / "joint.toml"
FARTHEST = math.radians(0.5)
# What the joint has in truth, and what its file states: at most 1.5 times beside it.
WEAK = ({"coulomb": 3.0, "static": 0.0, "viscous": 1.0}, {"coulomb": 3.0, "static": 0.0})
STRONG = ({"coulomb": 25.0, "static": 0.0}, {"coulomb": 25.0, "static": 0.0})
THESIS = ({"coulomb": 25.0, "static": 20.0}, {"coulomb": 10.0, "static": 20.0})
FRICTIONS = {"weak": WEAK, "strong": STRONG, "thesis": THESIS}
BOTH = "torque_constant_or_gear_ratio"
WRONG: list[tuple[dict[str, float], tuple[str, ...]]] = [
    ({"torque_sign": -1}, ("torque_and_encoder_disagree",)),
    ({"encoder_sign": -1}, ("torque_and_encoder_disagree",)),
    ({"torque_scale": 0.0}, ("no_motion_up_to_torque_cap",)),
    ({"torque_scale": 3.0}, ("torque_constant", BOTH)),
    ({"torque_scale": 1.0 / 3.0}, ("torque_constant", BOTH)),
    ({"gear_ratio": 1010.0}, ("gear_ratio", BOTH)),
    ({"sensor_sign": -1}, ("sensor_sign",)),
]


def quick_and_slow(quick: Any, *slow: Any) -> list[Any]:
    """Cases of a parameter and of `quick`: one at half the example's rate, others at the example's, which are slow."""
    return [(quick, True), *(pytest.param(case, False, marks=pytest.mark.slow) for case in slow)]


class Spy:
    """What the emulated joint truly feels and does."""

    def __init__(self, drive: EmulatedElmo) -> None:
        self.torque = self.way = 0.0
        self._drive, self._start, self._advance = drive, drive.joint.position, drive.advance
        drive.advance = self._seen  # type: ignore[method-assign]

    def _seen(self) -> None:
        drive, settings = self._drive, self._drive.settings
        if drive.motor_on:
            torque = drive.current * settings.torque_constant * settings.gear_ratio
            self.torque = max(self.torque, abs(torque))
        self._advance()
        self.way = max(self.way, abs(drive.joint.position - self._start))


def bench_with(
    friction: tuple[dict[str, float], dict[str, float]] = THESIS,
    position: float = 0.0,
    quick: bool = True,
    **wrong: Any,
) -> Bench:
    """The example's bench, wrong in some way; quick: at half its rate."""
    bench = Bench.load(EXAMPLE)
    truth, stated = friction
    assert bench.emulation is not None
    emulation = replace(
        bench.emulation,
        truth={**bench.emulation.truth, **truth},
        drive=ElmoEmulation(**wrong),
        position=position,
    )
    bench = replace(bench, joint=bench.joint.with_parameters(stated), emulation=emulation)
    return replace(bench, options=replace(bench.options, period=4e-3)) if quick else bench


def moved(
    bench: Bench,
    seed: int = 0,
    change: Callable[[EmulatedElmo], object] | None = None,
    faults: tuple[BusFault, ...] = (),
) -> tuple[FirstMotion, Spy]:
    devices = elmo_devices(bench, seed)
    if change is not None:
        change(devices[0])
    spy = Spy(devices[0])
    with EmulatedBus(*devices, faults=faults) as bus:
        result = jid.hardware.first_motion(bench, drive=ElmoDrive(bus, bench.joint, bench.drive))
    assert not devices[0].motor_on
    return result, spy


def breakaway(bench: Bench) -> float:
    assert bench.emulation is not None
    return bench.emulation.truth["coulomb"] + bench.emulation.truth["static"]


def without_sensor(bench: Bench) -> Bench:
    """The bench of a joint that has no torque sensor."""
    kept = {name: p for name, p in bench.joint.parameters.items() if "sensor" not in name}
    model = bench.joint.model.replace(ripple=())
    assert bench.emulation is not None
    truth = {name: v for name, v in bench.emulation.truth.items() if "sensor" not in name}
    return replace(
        bench,
        joint=bench.joint.replace(sensor=False, model=model, parameters=kept),
        drive=replace(bench.drive, torque=None),
        emulation=replace(bench.emulation, truth=truth),
    )
