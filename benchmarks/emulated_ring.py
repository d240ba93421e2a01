"""The ring through an emulated bus, over many seeds: tracking errors, and errors of the estimate. Markdown."""

import argparse
import os
from collections.abc import Callable
from concurrent.futures import ProcessPoolExecutor
from dataclasses import replace
from functools import partial
from multiprocessing import get_context
from pathlib import Path

import numpy as np

from jointid import AdaptiveRobust
from jointid.base.files import write_whole
from jointid.commissioning import commission
from jointid.hardware.bench.bench import Bench
from jointid.hardware.elmo.torque_source import AnalogInput

FILE = Path(__file__).parent.parent / "examples" / "hardware" / "joint.toml"
NAMES = ("coulomb", "static", "stribeck", "viscous", "sensor_gain", "sensor_offset")


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
    """Errors before, after, with the truth; relative errors [%] of the last estimate, with ripple and without."""
    ring = commission(KINDS[kind](Bench.load(FILE)), cycles=2, emulate=True, seed=seed, threads=1)
    assert ring.true_run is not None
    assert ring.without_ripple is not None
    errors = [r.tracking_error for r in (ring.runs[0], ring.runs[-1], ring.true_run)]
    off = [
        [100.0 * (e.parameters[name].value / ring.truth[name] - 1.0) for name in NAMES]
        for e in (ring.estimates[-1], ring.without_ripple)
    ]
    return [errors, *off]


def main(seeds: int, output: Path | None) -> None:
    """Print both tables."""
    bench = Bench.load(FILE)
    lines = [
        "# The ring through an emulated bus\n",
        "Written by `benchmarks/emulated_ring.py` (`make study`); do not edit. `examples/hardware/joint.toml`: an",
        "**emulated drive** on a bus of 500 kbit/s, commands every "
        f"{1e3 * bench.options.period:g} ms, encoder of 808,000 counts a turn of the joint,",
        "converter of 12 bits × 128, sensor noise 0.5 N·m, ripple 2.6 N·m; two cycles from Table 6-3's initial",
        f"estimates; {seeds} seeds.\n",
    ]
    tracking = [
        "| bench | before [mrad] | after | true parameters | after / true, worst | before / after, smallest |",
        "|---|---|---|---|---|---|",
    ]
    off = [
        f"| bench | {' | '.join(NAMES)} |",
        "|---|" + "---|" * len(NAMES),
    ]
    with ProcessPoolExecutor(os.cpu_count(), mp_context=get_context("spawn")) as pool:
        for kind in KINDS:
            found = [*pool.map(partial(closed, kind), range(seeds))]
            before, after, true = 1e3 * np.array([each[0] for each in found]).T
            tracking.append(
                f"| {kind} | {np.median(before):.3f} | {np.median(after):.4f} | {np.median(true):.4f} "
                f"| {(after / true).max():.3f} | {(before / after).min():.1f} |"
            )
            for what, place in ((kind, 1), (f"{kind}; ripple not modelled", 2)):
                shares = np.array([each[place] for each in found])
                cells = [
                    f"{mean:+.2f} ± {spread:.2f} ({worst:.2f})"
                    for mean, spread, worst in zip(
                        shares.mean(0), shares.std(0, ddof=1), abs(shares).max(0), strict=True
                    )
                ]
                off.append(f"| {what} | {' | '.join(cells)} |")
    lines += ["RMS tracking error after the first sixth, medians.\n", *tracking, ""]
    lines += ["Relative error of the last estimate [%]: mean ± standard deviation (worst).\n", *off]
    page = "\n".join(lines) + "\n"
    print(page)
    if output is not None:
        write_whole(output, page.encode())


if __name__ == "__main__":
    arguments = argparse.ArgumentParser(description=__doc__)
    arguments.add_argument("--seeds", type=int, default=20)
    arguments.add_argument("--output", type=Path, help="write the page here, too")
    options = arguments.parse_args()
    main(options.seeds, options.output)
