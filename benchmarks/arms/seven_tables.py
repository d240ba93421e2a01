"""The simulated arm: accuracy over runs, noise that hides accelerations, and wrong facts."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterator, Sequence
from typing import Any

import numpy as np
from measured import Part

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
ARMS = Part(
    title="Simulated robots",
    asked="How accurate is the friction of {runs} random arms with seven joints? Time stamps are 50 µs late on "
    "average. Velocities are 5 ms late. Torque noise is 0.5 % of the largest torque.",
    header=(
        "method",
        "arms with all errors within 3 %",
        "largest Coulomb error [%]",
        "largest viscous error [%]",
        "coverage of the 95 % intervals [%]",
        "warnings",
    ),
    reading="The model of filtered least squares has Coulomb and viscous friction. Of 32 settings of this method, the "
    "one with 40 Hz is the best.",
)
NOISY = Part(
    title="Simulated robots: noise that drowns accelerations",
    asked="How large are the errors with noise on every position and without a recorded velocity? Largest error of "
    "Coulomb or viscous friction over {runs} arms [%].",
    header=(
        "position noise",
        'jointid, `inertia="urdf"`',
        'jointid, `inertia="free"`',
        "filtered least squares, 20 Hz",
        "filtered least squares, 40 Hz",
        "second differences, no filter",
    ),
)
HEAVIER = Part(
    title="Simulated robots: a link 20 % heavier",
    asked="Does `identify_robot` find that link 4 is 1.2 times as heavy as in the URDF?",
    header=(
        "seed",
        '`inertia="scaled"`: scale of link 4',
        "largest error of another link's scale [%]",
        'warnings with `inertia="urdf"`',
    ),
)
FACTS = Part(
    title="Simulated robots: wrong facts",
    asked="Do the findings name a wrong order of joints, or a wrong coupling?",
    header=("wrongly stated fact", "relative residual [%]", "warnings"),
)
Values = tuple[dict[str, Any], dict[str, Any]]


def identified(recording: jid.RobotRecording, inertia: Inertia) -> jid.RobotEstimate:
    """Make the call of a user."""
    return jid.identify_robot(recording, jid.Robot.from_urdf(URDF), inertia=inertia)


def accuracy(seeds: range) -> Iterator[list[str]]:
    """Publish the accuracy for random arms with all effects of sensors and hosts."""
    found: dict[str, list[tuple[Arm, Any, Any]]] = {}
    estimates: dict[str, list[jid.RobotEstimate]] = {}
    for seed, ran in simulated(seeds):
        recording = recorded(ran, Sensors(), seed)
        for inertia in ("urdf", "scaled", "free"):
            estimate = identified(recording, inertia)
            name = f"jointid, inertia {inertia}"
            found.setdefault(name, []).append((ran.arm, *of_estimate(estimate)))
            estimates.setdefault(name, []).append(estimate)
        for cutoff in (20.0, 40.0):
            name = f"filtered least squares, {cutoff:g} Hz"
            found.setdefault(name, []).append((ran.arm, *by_filtering(recording, cutoff)))
    for name, runs in found.items():
        errors = Errors.of(runs)
        yield [
            name,
            f"{errors.within(NEAR)}/{len(runs)}",
            percent(errors.worst("coulomb"), sign=False),
            percent(errors.worst("viscous"), sign=False),
            percent(errors.coverage, sign=False),
            warned(estimates[name]) if name in estimates else "–",
        ]


def warned(estimates: Sequence[jid.RobotEstimate]) -> str:
    """Return how often each warning is raised."""
    counts = Counter(code for found in estimates for code in {e.code for e in found.warnings})
    return ", ".join(f"`{code}` {count}" for code, count in sorted(counts.items())) or "none"


def noise(seeds: range) -> Iterator[list[str]]:
    """Publish errors for positions with noise and without a recorded velocity."""
    ways: tuple[Callable[[jid.RobotRecording], Values], ...] = (
        lambda each: of_estimate(identified(each, "urdf")),
        lambda each: of_estimate(identified(each, "free")),
        lambda each: by_filtering(each, 20.0),
        lambda each: by_filtering(each, 40.0),
        lambda each: by_filtering(each, None),
    )
    runs = list(simulated(seeds))
    for size in NOISES:
        sensors = Sensors(position_noise=size, velocity_delay=None)
        recordings = [(ran.arm, recorded(ran, sensors, seed)) for seed, ran in runs]
        worst = []
        for way in ways:
            errors = Errors.of([(arm, *way(recording)) for arm, recording in recordings])
            worst.append(percent(max(errors.worst("coulomb"), errors.worst("viscous")), sign=False))
        yield [f"{size:g} rad", *worst]


def wrong_facts(seed: int) -> Iterator[list[str]]:
    """Publish errors where the stated facts differ from the recorded arm."""
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
        ("nothing, arm with a coupled wrist", right),
        ("coupling of the wrist left out", np.eye(JOINTS)),
        ("sign of the coupling", np.where(np.eye(JOINTS) > 0, right, -right)),
    ):
        robot = jid.Robot.from_urdf(URDF, gear_ratios=ratios.tolist(), couplings=couplings)
        cases.append((name, motors, robot))
    for name, each, robot in cases:
        estimate = jid.identify_robot(each, robot)
        yield [name, percent(estimate.relative_residual, sign=False), warned([estimate])]


def heavier(seeds: range) -> Iterator[list[str]]:
    """Identify with link 4 20 % heavier than in the URDF."""
    for seed, ran in simulated(seeds, heavier=1.2):
        recording = recorded(ran, Sensors(), seed)
        joints = identified(recording, "scaled").joints
        scales = {n: p for n in NAMES if (p := joints[n].parameters.get("inertia_scale"))}
        heavy = scales.pop("joint_4")
        other = max(abs(p.value - 1.0) for p in scales.values())
        cells = [f"{heavy.value:.3f} ± {heavy.stderr or 0.0:.3f}", percent(other, sign=False)]
        yield [str(seed), *cells, warned([identified(recording, "urdf")])]
