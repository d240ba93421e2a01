"""Do the 95 % intervals contain the truth in 95 of 100 runs? By hand; prints a Markdown table.

The runs come from the simulator of the tests, which shares no code with the package.
"""

import argparse
import sys
import time
from pathlib import Path

import numpy as np

import jointid as jid

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "tests"))
from simulated_joint import TRUTH, simulate


def coverage(recordings: list[jid.Recording]) -> tuple[list[str], dict[str, int]]:
    """Return one line per parameter, and the number of recordings with each warning."""
    found = [jid.identify(run, jid.thesis_joint(), search="separable") for run in recordings]
    lines = [
        "| parameter | truth | bias | spread | mean standard error | 95 % interval contains the truth |",
        "|---|---|---|---|---|---|",
    ]
    for name, truth in TRUTH.items():
        parameters = [estimate.parameters[name] for estimate in found]
        values = np.array([p.value for p in parameters])
        errors = np.array([p.stderr or np.nan for p in parameters])
        intervals = [p.interval for p in parameters]
        inside = sum(i is not None and i[0] <= truth <= i[1] for i in intervals)
        bias, spread = values.mean() / truth - 1.0, values.std(ddof=1) / truth
        lines.append(
            f"| {name} | {truth:g} | {100 * bias:+.4f} % | {100 * spread:.4f} % | "
            f"{100 * errors.mean() / truth:.4f} % | {100 * inside / len(found):.1f} % |"
        )
    codes: dict[str, int] = {}
    for estimate in found:
        for warning in estimate.warnings:
            codes[warning.code] = codes.get(warning.code, 0) + 1
    return lines, codes


if __name__ == "__main__":
    arguments = argparse.ArgumentParser(description=__doc__)
    arguments.add_argument("--runs", type=int, default=200)
    arguments.add_argument("--duration", type=float, default=12.0)
    arguments.add_argument("--seed", type=int, default=0)
    given = arguments.parse_args()
    started = time.perf_counter()
    recordings = simulate(given.runs, duration=given.duration, seed=given.seed)
    simulated = time.perf_counter() - started
    lines, codes = coverage(recordings)
    print(f"{given.runs} runs of {given.duration:g} s, simulated in {simulated:.1f} s\n")
    print("\n".join(lines))
    print(f"\nWarnings: {codes or 'none'}")
