"""The ring on an emulated bus, over many seeds: tracking errors, and errors of the estimate."""

import argparse
import os
from collections.abc import Callable
from concurrent.futures import ProcessPoolExecutor
from dataclasses import replace
from functools import partial
from multiprocessing import get_context
from pathlib import Path

import numpy as np
from measured import Part, publish

from jointid import AdaptiveRobust
from jointid.commissioning import commission
from jointid.hardware.bench.bench import Bench
from jointid.hardware.elmo.torque_source import AnalogInput

FILE = Path(__file__).parent.parent / "examples" / "hardware" / "joint.toml"
TRACKING = Part(
    title="Session on the emulated drive",
    asked="By how much does a session on the **emulated drive** reduce the tracking error? "
    "`examples/hardware/joint.toml`, {seeds} seeds. A session has two cycles of run and identification, and starts "
    "with Table 6-3's initial estimates. The errors are medians of the RMS tracking error.",
    header=(
        "bench",
        "initial parameters: error [mrad]",
        "identified parameters: error [mrad]",
        "true parameters: error [mrad]",
        "error ratio: identified / true parameters, largest",
        "error ratio: initial / identified parameters, smallest",
    ),
)
NAMES = ("coulomb", "static", "stribeck", "viscous", "sensor_gain", "sensor_offset")
ERRORS = Part(
    title="Estimates on the emulated drive",
    asked="How accurate is the last estimate of these {seeds} sessions? Relative error of each parameter [%]: mean "
    "(largest).",
    header=("bench", *NAMES),
)


def _as_it_is(bench: Bench) -> Bench:
    return bench


def _analog(bench: Bench) -> Bench:
    assert not isinstance(bench.drive.torque, AnalogInput)
    assert bench.drive.torque is not None
    source = AnalogInput(number=1, every=4, scaling=bench.drive.torque.scaling)
    return replace(bench, drive=replace(bench.drive, torque=source))


def _coarse(bench: Bench) -> Bench:
    assert bench.emulation is not None
    drive = replace(bench.drive, mantissa_bits=4)
    emulated = replace(bench.emulation.drive, mantissa_bits=4)
    return replace(bench, drive=drive, emulation=replace(bench.emulation, drive=emulated))


def _measured(bench: Bench) -> Bench:
    assert isinstance(bench.controller, AdaptiveRobust)
    return replace(bench, controller=bench.controller.replace(friction_velocity="measured"))


KINDS: dict[str, Callable[[Bench], Bench]] = {
    "as in the example": _as_it_is,
    "drive's analog input, every fourth cycle": _analog,
    "currents with a mantissa of 4 bits": _coarse,
    "friction compensated at the measured velocity": _measured,
}


def closed(kind: str, seed: int) -> list[list[float]]:
    """Return errors before, after, with the truth; errors [%] of the last estimate, with and without ripple."""
    ring = commission(KINDS[kind](Bench.load(FILE)), cycles=2, emulate=True, seed=seed, threads=1)
    assert ring.true_run is not None
    assert ring.without_ripple is not None
    errors = [r.tracking_error for r in (ring.runs[0], ring.runs[-1], ring.true_run)]
    off = [
        [100.0 * (e.parameters[name].value / ring.truth[name] - 1.0) for name in NAMES]
        for e in (ring.estimates[-1], ring.without_ripple)
    ]
    return [errors, *off]


def main(seeds: int, *, write: bool) -> None:
    """Publish both tables."""
    tracking, off = [], []
    with ProcessPoolExecutor(os.cpu_count(), mp_context=get_context("spawn")) as pool:
        for kind in KINDS:
            found = [*pool.map(partial(closed, kind), range(seeds))]
            before, after, true = 1e3 * np.array([each[0] for each in found]).T
            medians = (f"{np.median(each):.4f}" for each in (before, after, true))
            ratios = f"{(after / true).max():.3f}", f"{(before / after).min():.1f}"
            tracking.append([kind, *medians, *ratios])
            for what, place in ((kind, 1), (f"{kind}; ripple not modeled", 2)):
                shares = np.array([each[place] for each in found])
                pairs = zip(shares.mean(0), abs(shares).max(0), strict=True)
                off.append([what, *(f"{mean:+.2f} ({worst:.2f})" for mean, worst in pairs)])
    publish(TRACKING, tracking, write=write, seeds=seeds)
    publish(ERRORS, off, write=write, seeds=seeds)


if __name__ == "__main__":
    arguments = argparse.ArgumentParser(description=__doc__)
    arguments.add_argument("--seeds", type=int, default=20)
    arguments.add_argument("--write", action="store_true", help="write it into the page, too")
    options = arguments.parse_args()
    main(options.seeds, write=options.write)
