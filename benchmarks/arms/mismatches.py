"""The simulated arm with one error that the call does not know: in signals, in the URDF, in the mounting."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, field, replace

import numpy as np
from measured import Part
from simulated_arm import random_motion, run

import jointid as jid
from arms.seven import URDF, Arm, Errors, Sensors, of_estimate, random_arm, recorded
from arms.seven_tables import warned
from arms.tx40_tables import percent
from jointid.robot.links.inertia_modes import Inertia


@dataclass(frozen=True, kw_only=True)
class Mismatch:
    """Difference of the arm, its sensors, or the recording from the call's arguments."""

    name: str
    arm: Callable[[Arm], Arm] = lambda arm: arm
    sensors: Sensors = field(default_factory=Sensors)
    recording: Callable[[jid.RobotRecording], jid.RobotRecording] = lambda recording: recording


def of_body(link: int, mass: float, place: tuple[float, float, float]) -> Callable[[Arm], Arm]:
    """Fix a body to a link, which the URDF does not know."""

    def changed(arm: Arm) -> Arm:
        import pinocchio

        model = pinocchio.Model(arm.model)
        body = pinocchio.Inertia(mass, np.array(place), 0.002 * mass * np.eye(3))
        model.inertias[link] = model.inertias[link] + body
        return replace(arm, model=model)

    return changed


def moved_centre(link: int, way: tuple[float, float, float]) -> Callable[[Arm], Arm]:
    """Move a link's centre of mass from the URDF's place [m]."""

    def changed(arm: Arm) -> Arm:
        import pinocchio

        model = pinocchio.Model(arm.model)
        was = model.inertias[link]
        model.inertias[link] = pinocchio.Inertia(was.mass, was.lever + np.array(way), was.inertia)
        return replace(arm, model=model)

    return changed


def tilted(degrees: float) -> Callable[[Arm], Arm]:
    """Tilt the base."""

    def changed(arm: Arm) -> Arm:
        import pinocchio

        model = pinocchio.Model(arm.model)
        angle = np.radians(degrees)
        model.gravity.linear = 9.81 * np.array([np.sin(angle), 0.0, -np.cos(angle)])
        return replace(arm, model=model)

    return changed


def late(signal: str, delay: float) -> Callable[[jid.RobotRecording], jid.RobotRecording]:
    """Delay a signal by this time [s]."""

    def changed(recording: jid.RobotRecording) -> jid.RobotRecording:
        fields = recording.fields()
        moved = recording.time - delay
        columns = [np.interp(moved, recording.time, column) for column in fields[signal].T]
        return jid.RobotRecording(**{**fields, signal: np.column_stack(columns)})

    return changed


def scaled(
    signals: tuple[str, ...], joint: int, factor: float = 1.0, shift: float = 0.0
) -> Callable[[jid.RobotRecording], jid.RobotRecording]:
    """Multiply signals of one joint by a factor, and shift them."""

    def changed(recording: jid.RobotRecording) -> jid.RobotRecording:
        fields = recording.fields()
        for signal in signals:
            values = np.array(fields[signal])
            values[:, joint - 1] = values[:, joint - 1] * factor + shift
            fields[signal] = values
        return jid.RobotRecording(**fields)

    return changed


def thinned(every: int) -> Callable[[jid.RobotRecording], jid.RobotRecording]:
    """Keep only every n-th sample."""

    def changed(recording: jid.RobotRecording) -> jid.RobotRecording:
        fields = recording.fields()
        kept = {signal: fields[signal][::every] for signal in recording.signals}
        # A command that was held for one of these samples is no longer held until the next.
        return jid.RobotRecording(**{**fields, **kept, "torque_hold": "linear"})

    return changed


MISMATCHES = (
    Mismatch(name="nothing"),
    Mismatch(name="time stamps 0.2 ms late in the mean", sensors=Sensors(stamp_lateness=2e-4)),
    Mismatch(name="time stamps 0.5 ms late in the mean", sensors=Sensors(stamp_lateness=5e-4)),
    Mismatch(name="encoder with 16,384 counts/rev", sensors=Sensors(counts=2.0**14)),
    Mismatch(name="torque noise 3 %", sensors=Sensors(torque_noise=0.03)),
    Mismatch(name="torque 3 ms late", recording=late("torque", 3e-3)),
    Mismatch(name="torque 10 ms late", recording=late("torque", 10e-3)),
    Mismatch(name="sampled at 200 Hz", recording=thinned(5)),
    Mismatch(
        name="zero position of joint 2 wrong by 5°",
        recording=scaled(("position",), 2, shift=np.radians(5.0)),
    ),
    Mismatch(name="torque of joint 5 with the wrong sign", recording=scaled(("torque",), 5, -1.0)),
    Mismatch(
        name="motion of joint 5 with the wrong sign",
        recording=scaled(("position", "velocity"), 5, -1.0),
    ),
    Mismatch(name="torque of joint 4 10 % too high", recording=scaled(("torque",), 4, 1.1)),
    Mismatch(name="1 kg at the flange", arm=of_body(7, 1.0, (0.02, 0.0, 0.15))),
    Mismatch(name="center of mass of link 3 wrong by 2 cm", arm=moved_centre(3, (0.0, 0.02, 0.0))),
    Mismatch(name="base tilted by 10°", arm=tilted(10.0)),
    Mismatch(name="link 2 heavier by 20 %", arm=lambda arm: arm.with_link_scaled(2, 1.2)),
)


PART = Part(
    title="Simulated robots: mismatches",
    asked="How large are the errors from a mismatch that the call does not know, and do findings name this mismatch? "
    "Largest error of Coulomb or viscous friction (arms: {runs}), and how often each warning is raised.",
    header=(
        "mismatch",
        '`inertia="urdf"`: largest error [%]',
        "warnings",
        '`inertia="free"`: largest error [%]',
        "warnings",
    ),
    reading='With `inertia="free"` the identified inertias include an error of the links. Then no finding needs to '
    "name this mismatch.",
)


def table(seeds: range) -> Iterator[list[str]]:
    """Return the worst errors over the seeds, and the findings of the calls."""
    for mismatch in MISMATCHES:
        runs = []
        for seed in seeds:
            arm = mismatch.arm(random_arm(seed))
            recording = recorded(run(arm, random_motion(seed)), mismatch.sensors, seed)
            runs.append((arm, mismatch.recording(recording)))
        yield [mismatch.name, *_cells(runs, "urdf"), *_cells(runs, "free")]


def _cells(runs: list[tuple[Arm, jid.RobotRecording]], inertia: Inertia) -> list[str]:
    robot = jid.Robot.from_urdf(URDF)
    found: list[jid.RobotEstimate] = []
    worst, refused = 0.0, 0
    for arm, recording in runs:
        try:
            estimate = jid.identify_robot(recording, robot, inertia=inertia)
        except jid.InputError:
            refused += 1
            continue
        errors = Errors.of([(arm, *of_estimate(estimate))])
        worst = max(worst, errors.worst("coulomb"), errors.worst("viscous"))
        found.append(estimate)
    said = warned(found) + (f", refused {refused}" if refused else "")
    return [percent(worst, sign=False) if found else "–", said]
