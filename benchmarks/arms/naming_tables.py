"""How often a late torque is found on simulated arms, and how often a wrong fact is named by its cause."""

from __future__ import annotations

from collections.abc import Iterator

from simulated_arm import random_motion, run

import jointid as jid
from arms.mismatches import MISMATCHES, late
from arms.seven import URDF, Errors, Sensors, of_estimate, random_arm, recorded, simulated
from arms.tx40_tables import percent
from jointid.robot.links.inertia_modes import Inertia

DELAYS = (0.0, 1e-3, 3e-3, 10e-3)  # [s]
NEAR = 3e-4  # [s]
# What each mismatch is called, with the URDF's inertias and with free ones, which follow errors of the links.
NAMES = {
    "nothing": ("", ""),
    "torque noise 3 %": ("", ""),
    "base tilted by 10°": ("tilted_base", "tilted_base"),
    "torque of joint 4 10 % too high": ("wrong_torque_scale", "wrong_torque_scale"),
    "torque of joint 5 with the wrong sign": ("wrong_torque_sign", "wrong_torque_sign"),
    "motion of joint 5 with the wrong sign": ("wrong_motion_sign", "wrong_motion_sign"),
    "1 kg at the flange": ("payload", ""),
    "zero of joint 2 off by 5°": ("wrong_zero", "wrong_zero"),
    "centre of mass of link 3 off by 2 cm": ("wrong_centre", ""),
    "link 2 heavier by 20 %": ("wrong_inertia", ""),
}


def delays(seeds: range) -> Iterator[str]:
    """A late torque: whether it is named, and what is left of it in the friction."""
    named = f"named within {1e3 * NEAR:g} ms | largest error of the delay"
    yield f"| torque late by | inertia | {named} | worst Coulomb | worst viscous | warnings |"
    yield "|--:|---|--:|--:|--:|--:|---|"
    runs = [(recorded(ran, Sensors(), seed), ran.arm) for seed, ran in simulated(seeds)]
    for delay in DELAYS:
        for inertia in ("urdf", "free"):
            found, lags, codes = [], [], []
            for recording, arm in runs:
                moved = late("torque", delay)(recording) if delay else recording
                estimate = jid.identify_robot(moved, jid.Robot.from_urdf(URDF), inertia=inertia)
                found.append((arm, *of_estimate(estimate)))
                lags.append(_lag(estimate))
                codes += [f"`{each.code}`" for each in estimate.warnings]
            told = [lag for lag in lags if lag is not None]
            near = sum(abs(lag - delay) <= NEAR for lag in told)
            far = max((abs(lag - delay) for lag in told), default=0.0)
            errors = Errors.of(found)
            cells = (
                f"{1e3 * delay:g} ms",
                inertia,
                f"{near} of {len(runs)}" if delay else f"{len(told)} of {len(runs)} falsely",
                f"{1e3 * far:.2f} ms" if told else "–",
                percent(errors.worst("coulomb"), sign=False),
                percent(errors.worst("viscous"), sign=False),
                ", ".join(sorted(set(codes))) or "none",
            )
            yield f"| {' | '.join(cells)} |"


def _lag(estimate: jid.RobotEstimate) -> float | None:
    """The common delay that was found [s]; of several the first."""
    for each in estimate.findings:
        if each.code == "delay_removed":
            return next(iter(each.evidence.values())).value
    return None


def causes(seeds: range) -> Iterator[str]:
    """Which cause is named of each mismatch, and how much it explains."""
    yield "| wrong | inertia | to be named | named | by something else | other warnings | explained |"
    yield "|---|---|---|--:|--:|---|--:|"
    for mismatch in (each for each in MISMATCHES if each.name in NAMES):
        runs = []
        for seed in seeds:
            arm = mismatch.arm(random_arm(seed))
            made = recorded(run(arm, random_motion(seed)), mismatch.sensors, seed)
            runs.append(mismatch.recording(made))
        modes: tuple[Inertia, Inertia] = ("urdf", "free")
        for inertia, code in zip(modes, NAMES[mismatch.name], strict=True):
            yield _row(mismatch.name, inertia, code, runs)


def _row(name: str, inertia: Inertia, code: str, runs: list[jid.RobotRecording]) -> str:
    known = {each for pair in NAMES.values() for each in pair}
    right, wrong, others, shares = 0, 0, set(), []
    for recording in runs:
        estimate = jid.identify_robot(recording, jid.Robot.from_urdf(URDF), inertia=inertia)
        codes = [each.code for each in estimate.warnings]
        right += code in codes if code else not set(codes) & known
        wrong += bool(set(codes) & known - {code})
        others |= set(codes) - known
        shares += [
            each.evidence["share"].value
            for each in estimate.warnings
            if each.code == code and "share" in each.evidence
        ]
    cells = (
        name,
        inertia,
        f"`{code}`" if code else "nothing",
        f"{right} of {len(runs)}",
        str(wrong),
        ", ".join(f"`{each}`" for each in sorted(others)) or "none",
        f"{percent(min(shares), sign=False)} … {percent(max(shares), sign=False)}"
        if shares
        else "–",
    )
    return f"| {' | '.join(cells)} |"
