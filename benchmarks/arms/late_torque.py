"""Rate at which a late torque is found on simulated arms."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import product

from measured import Part

import jointid as jid
from arms.mismatches import late
from arms.seven import URDF, Errors, Sensors, of_estimate, recorded, simulated
from arms.seven_tables import warned
from arms.tx40_tables import percent
from jointid.robot.links.inertia_modes import Inertia

DELAYS = (0.0, 1e-3, 3e-3, 10e-3)  # [s]
NEAR = 3e-4  # [s]
PART = Part(
    title="Simulated robots: a late torque",
    asked="Does `identify_robot` find a torque that is late by the same time in all joints? {runs} arms, each with "
    '`inertia="urdf"` and with `inertia="free"`.',
    header=(
        "true delay [ms]",
        "calls that report a delay",
        "reported delays within 0.3 ms",
        "largest error of the delay [ms]",
        "largest error of the friction [%]",
        "warnings",
    ),
)


def delays(seeds: range) -> Iterator[list[object]]:
    """Return, for late torques, whether the delay is named, and the remaining error of the friction."""
    runs = [(recorded(ran, Sensors(), seed), ran.arm) for seed, ran in simulated(seeds)]
    modes: tuple[Inertia, Inertia] = ("urdf", "free")
    for delay in DELAYS:
        found, lags, estimates = [], [], []
        for (recording, arm), inertia in product(runs, modes):
            moved = late("torque", delay)(recording) if delay else recording
            estimate = jid.identify_robot(moved, jid.Robot.from_urdf(URDF), inertia=inertia)
            found.append((arm, *of_estimate(estimate)))
            lags.append(_lag(estimate))
            estimates.append(estimate)
        off = [abs(lag - delay) for lag in lags if lag is not None]
        errors = Errors.of(found)
        worst = max(errors.worst("coulomb"), errors.worst("viscous"))
        yield [
            f"{1e3 * delay:g}",
            f"{len(off)}/{len(lags)}",
            f"{sum(each <= NEAR for each in off)}/{len(lags)}" if delay else "–",
            f"{1e3 * max(off):.2f}" if off else "–",
            percent(worst, sign=False),
            warned(estimates),
        ]


def _lag(estimate: jid.RobotEstimate) -> float | None:
    """Return the common delay that was found [s]; the first of several."""
    for each in estimate.findings:
        if each.code == "delay_removed":
            return next(iter(each.evidence.values())).value
    return None
