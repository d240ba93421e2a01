"""The simulated arm: accuracy over runs, noise that drowns accelerations, and facts that are wrong."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any

import numpy as np

import jointid as jid
from arms.seven import (
    JOINTS,
    NAMES,
    URDF,
    Arm,
    Errors,
    Sensors,
    by_filtering,
    of_estimate,
    recorded,
    simulated,
)
from arms.tx40_tables import percent
from jointid.robot.links.inertia_modes import Inertia

NEAR = 0.03
NOISES = (1e-5, 3e-5, 1e-4, 3e-4)  # [rad]
Values = tuple[dict[str, Any], dict[str, Any]]


def identified(recording: jid.RobotRecording, inertia: Inertia) -> jid.RobotEstimate:
    """The call that a user makes."""
    return jid.identify_robot(recording, jid.Robot.from_urdf(URDF), inertia=inertia)


def accuracy(seeds: range) -> Iterator[str]:
    """Of random arms with all that sensors and hosts bring."""
    found: dict[str, list[tuple[Arm, Any, Any]]] = {}
    codes: dict[str, list[str]] = {}
    for seed, ran in simulated(seeds):
        recording = recorded(ran, Sensors(), seed)
        for inertia in ("urdf", "scaled", "free"):
            estimate = identified(recording, inertia)
            name = f"jointid, inertia {inertia}"
            found.setdefault(name, []).append((ran.arm, *of_estimate(estimate)))
            codes.setdefault(name, []).extend(each.code for each in estimate.warnings)
        for cutoff in (20.0, 40.0):
            name = f"filtered least squares, {cutoff:g} Hz"
            found.setdefault(name, []).append((ran.arm, *by_filtering(recording, cutoff)))
    said = "worst Coulomb | worst viscous | coverage | error, of half an interval | warnings"
    yield f"| | all within {100 * NEAR:g} % | {said} |"
    yield "|---|--:|--:|--:|--:|--:|---|"
    for name, runs in found.items():
        errors = Errors.of(runs)
        counted = {code: codes[name].count(code) for code in sorted(set(codes.get(name, [])))}
        shown = ", ".join(f"`{code}` {count}" for code, count in counted.items())
        cells = (
            name,
            f"{errors.within(NEAR)} of {len(runs)}",
            percent(errors.worst("coulomb"), sign=False),
            percent(errors.worst("viscous"), sign=False),
            percent(errors.coverage, sign=False),
            f"{errors.of_half_width:.2f}",
            shown or ("none" if name in codes else ""),
        )
        yield f"| {' | '.join(cells)} |"


def noise(seeds: range) -> Iterator[str]:
    """Positions with noise, and no velocity recorded."""
    ways: dict[str, Callable[[jid.RobotRecording], Values]] = {
        "jointid, inertia urdf": lambda each: of_estimate(identified(each, "urdf")),
        "jointid, inertia free": lambda each: of_estimate(identified(each, "free")),
        "filtered least squares, 20 Hz": lambda each: by_filtering(each, 20.0),
        "filtered least squares, 40 Hz": lambda each: by_filtering(each, 40.0),
        "second differences": lambda each: by_filtering(each, None),
    }
    runs = list(simulated(seeds))
    yield "| noise | signal to noise of a second difference | " + " | ".join(ways) + " |"
    yield f"|--:|--:|{'--:|' * len(ways)}"
    for size in NOISES:
        ratios: list[float] = []
        found: dict[str, list[Any]] = {name: [] for name in ways}
        for seed, ran in runs:
            recording = recorded(ran, Sensors(position_noise=size, velocity_delay=None), seed)
            true = np.diff(ran.position, 2, axis=0)
            wrong = np.diff(recording.position, 2, axis=0) - true
            ratios.append(float((true.std(axis=0) / wrong.std(axis=0)).max()))
            for name, way in ways.items():
                found[name].append((ran.arm, *way(recording)))
        worst = []
        for each in found.values():
            errors = Errors.of(each)
            worst.append(percent(max(errors.worst("coulomb"), errors.worst("viscous")), sign=False))
        yield f"| {size:g} rad | {max(ratios):.3f} | {' | '.join(worst)} |"


def named(estimate: jid.RobotEstimate) -> str:
    """What the findings say, without those that are for information."""
    return "; ".join(str(each) for each in estimate.warnings) or "nothing"


def wrong_facts(seed: int) -> Iterator[str]:
    """What is stated is not what was recorded."""
    yield "| stated wrongly | relative residual | what is said |"
    yield "|---|--:|---|"
    ((_, ran),) = simulated([seed])
    recording = recorded(ran, Sensors(), seed)
    order = [0, 1, 3, 2, *range(4, JOINTS)]
    fields = recording.fields()
    swapped = {name: fields[name][:, order] for name in ("position", "velocity", "torque")}
    cases: list[tuple[str, jid.RobotRecording, jid.Robot]] = [
        ("nothing", recording, jid.Robot.from_urdf(URDF)),
        (
            "torques of joints 3 and 4 exchanged",
            jid.RobotRecording(**{**fields, "torque": swapped["torque"]}),
            jid.Robot.from_urdf(URDF),
        ),
        (
            "joints 3 and 4 exchanged",
            jid.RobotRecording(**{**fields, **swapped}),
            jid.Robot.from_urdf(URDF),
        ),
    ]
    ((_, ran),) = simulated([seed], coupled=True)
    motors = recorded(ran, Sensors(), seed, motors=True)
    turns = ran.arm.couplings
    ratios = np.diag(turns)
    right = turns / ratios[:, None]
    for name, couplings in (
        ("nothing, of the coupled wrist", right),
        ("that motor 7 turns with joint 7 alone", np.eye(JOINTS)),
        ("the coupling's sign", np.where(np.eye(JOINTS) > 0, right, -right)),
    ):
        robot = jid.Robot.from_urdf(URDF, gear_ratios=ratios.tolist(), couplings=couplings)
        cases.append((name, motors, robot))
    for name, each, robot in cases:
        estimate = jid.identify_robot(each, robot)
        yield f"| {name} | {percent(estimate.relative_residual, sign=False)} | {named(estimate)} |"


def heavier(seeds: range) -> Iterator[str]:
    """Link 4 with 20 % more mass than the URDF says."""
    yield f"| seed | {' | '.join(f'link {number}' for number in range(1, JOINTS + 1))} | with inertia urdf |"
    yield f"|--:|{'---|' * JOINTS}---|"
    for seed, ran in simulated(seeds, heavier=1.2):
        recording = recorded(ran, Sensors(), seed)
        scaled = identified(recording, "scaled")
        cells = []
        for joint in NAMES:
            scale = scaled.joints[joint].parameters.get("inertia_scale")
            cells.append("" if scale is None else f"{scale.value:.3f} ± {scale.stderr or 0.0:.3f}")
        yield f"| {seed} | {' | '.join(cells)} | {named(identified(recording, 'urdf'))} |"
