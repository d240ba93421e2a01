"""Do the standard errors agree with the spread over resampled motion? By hand; prints a Markdown table.

The study identifies real logs of robots, from a folder next to the repository. Then it resamples moving blocks of each
log, with several lengths. For each draw it solves the linearized balance, with other code than
`estimate.bootstrap()`. By the rule of `bootstrap()`, a block lasts an eighth of the motion, but at least 0.25 s and
at most 1 s. The other lengths show the effect of this rule.
"""

import argparse
import gzip
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np

import jointid as jid
from jointid.identification.prepared import prepare

DATA = Path(__file__).resolve().parents[2] / "shared" / "data"
LENGTHS = (0.5, 1.0, 1.5, 2.5)  # of the blocks [s]
DRAWS = 400
RATIOS = {"kr300": (256.86, 267.43, 252.33), "tx40": (32.0, 32.0, 45.0, -48.0)}


def table(path: Path) -> dict[str, np.ndarray]:
    """Return the columns of a file by their headers."""
    opened: Any = gzip.open if path.suffix == ".gz" else open
    with opened(path, "rt") as file:
        names = file.readline().strip().split(",")
        values = np.genfromtxt(file, delimiter=",")
    return dict(zip(names, values.T, strict=True))


def joint(gravity: str, kind: Any = "revolute") -> jid.Joint:
    """Return the facts that are known before the identification."""
    return jid.Joint(
        kind=kind, torque_offset=True, model=jid.Model.parse(f"coulomb_viscous:gravity={gravity}")
    )


def logs(data: Path) -> Iterator[tuple[str, jid.Recording, jid.Joint]]:
    """Yield the recordings with their names and joints."""
    known = table(data / "kr300" / "kr300_A.csv.gz")
    for number, ratio in enumerate(RATIOS["kr300"], 1):
        run = jid.Recording(
            time=known["time_s"],
            position=known[f"motor_encoder_pos_{number}_linkside_rad"],
            velocity=known[f"motor_encoder_vel_{number}_linkside_rad_s"],
            torque=ratio * known[f"motor_torque_{number}_Nm"],
            torque_hold="linear",
        )
        yield f"KR300 {number}", run, joint("none" if number == 1 else "free")
    known = table(data / "emps" / "emps_train.csv.gz")
    run = jid.Recording(
        time=known["time_s"],
        position=known["position_m"],
        torque=known["motor_force_N"],
        torque_hold="linear",
        kind="prismatic",
    )
    yield "EMPS", run, joint("none", "prismatic")
    known = table(data / "tx40" / "tx40.csv.gz")
    for number, ratio in enumerate(RATIOS["tx40"], 1):
        run = jid.Recording(
            time=known["time_s"],
            position=known[f"motor_position_{number}_rad"] / ratio,
            torque=ratio * known[f"motor_torque_{number}_Nm"],
            torque_hold="linear",
        )
        yield f"TX40 {number}", run, joint("free" if number in (2, 3) else "none")
    for name in ("swing_up", "energy_shaping"):
        known = table(data / "ak80" / f"ak80_{name}.csv")
        run = jid.Recording(
            time=known["time_s"],
            position=known["position_rad"],
            velocity=known["velocity_rad_s"],
            torque=known["motor_torque_output_Nm"],
            torque_hold="linear",
        )
        yield f"AK80 {name.replace('_', ' ')}", run, joint("free")


def scatter(jacobian: np.ndarray, residual: np.ndarray, length: int) -> np.ndarray:
    """Return half of the range of the middle 68 % of the draws of moving blocks."""
    rng = np.random.default_rng(0)
    size = np.linalg.norm(jacobian, axis=0)
    found = []
    for _ in range(DRAWS):
        first = rng.integers(0, len(residual) - length + 1, -(-len(residual) // length))
        index = (first[:, None] + np.arange(length)).ravel()
        found.append(np.linalg.lstsq(jacobian[index] / size, -residual[index], rcond=1e-12)[0])
    low, high = np.quantile(found, (0.1587, 0.8413), axis=0)
    return np.asarray(0.5 * (high - low) / size)


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--data", type=Path, default=DATA)
    lines, all_ratios = [], []
    for name, run, known in logs(parser.parse_args().data):
        estimate = jid.identify(run, known, search="separable")
        prepared = prepare((run,), known)
        best = np.array([estimate.parameters[each].value for each in prepared.domain.names])
        _, residual, jacobian = prepared.penalty.linearised(best)
        free = [prepared.domain.names.index(each) for each in estimate.free]
        errors = np.array([estimate.parameters[each].stderr for each in estimate.free])
        period = float(np.sum(estimate.windows.duration)) / len(residual)
        ratios = [
            errors / scatter(jacobian[:, free], residual, max(1, round(length / period)))
            for length in LENGTHS
        ]
        drawn = estimate.bootstrap().parameters
        ours = [1.0 / (drawn[each].ratio or np.nan) for each in estimate.free]
        all_ratios.append(np.array([*ratios, ours]))
        for i, each in enumerate(estimate.free):
            cells = " | ".join(f"{ratio[i]:.2f}" for ratio in (*ratios, ours))
            lines.append(f"| {name} | {each} | {errors[i]:.3g} | {cells} |")
    heads = [*(f"{length:g} s" for length in LENGTHS), "`bootstrap()`"]
    print(f"| log | parameter | standard error | {' | '.join(heads)} |")
    print("|---" * (3 + len(heads)) + "|")
    print("\n".join(lines))
    together = np.concatenate(all_ratios, axis=1)
    for head, row in zip(heads, together, strict=True):
        inside = np.mean((row > 0.6) & (row < 1.6))
        print(
            f"\nBlocks of {head}: median ratio {np.median(row):.2f}, {100 * inside:.0f} % in 0.6 … 1.6"
        )


if __name__ == "__main__":
    main()
