"""The simulated arm with one thing wrong that the call is not told: in signals, in the URDF, in the mounting."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, field, replace

import numpy as np
from simulated_arm import random_motion, run

import jointid as jid
from arms.seven import URDF, Arm, Errors, Sensors, of_estimate, random_arm, recorded
from arms.tx40_tables import percent
from jointid.robot.links.inertia_modes import Inertia

FAR = 0.05


@dataclass(frozen=True, kw_only=True)
class Mismatch:
    """How the arm, its sensors, or the recording differ from what the call is told."""

    name: str
    arm: Callable[[Arm], Arm] = lambda arm: arm
    sensors: Sensors = field(default_factory=Sensors)
    recording: Callable[[jid.RobotRecording], jid.RobotRecording] = lambda recording: recording


def of_body(link: int, mass: float, place: tuple[float, float, float]) -> Callable[[Arm], Arm]:
    """A body fixed to a link, that the URDF does not know."""

    def changed(arm: Arm) -> Arm:
        import pinocchio

        model = pinocchio.Model(arm.model)
        body = pinocchio.Inertia(mass, np.array(place), 0.002 * mass * np.eye(3))
        model.inertias[link] = model.inertias[link] + body
        return replace(arm, model=model)

    return changed


def moved_centre(link: int, way: tuple[float, float, float]) -> Callable[[Arm], Arm]:
    """A link's centre of mass elsewhere than the URDF says [m]."""

    def changed(arm: Arm) -> Arm:
        import pinocchio

        model = pinocchio.Model(arm.model)
        was = model.inertias[link]
        model.inertias[link] = pinocchio.Inertia(was.mass, was.lever + np.array(way), was.inertia)
        return replace(arm, model=model)

    return changed


def tilted(degrees: float) -> Callable[[Arm], Arm]:
    """The base not upright."""

    def changed(arm: Arm) -> Arm:
        import pinocchio

        model = pinocchio.Model(arm.model)
        angle = np.radians(degrees)
        model.gravity.linear = 9.81 * np.array([np.sin(angle), 0.0, -np.cos(angle)])
        return replace(arm, model=model)

    return changed


def late(signal: str, delay: float) -> Callable[[jid.RobotRecording], jid.RobotRecording]:
    """A signal that shows what was true so much before [s]."""

    def changed(recording: jid.RobotRecording) -> jid.RobotRecording:
        fields = recording.fields()
        moved = recording.time - delay
        columns = [np.interp(moved, recording.time, column) for column in fields[signal].T]
        return jid.RobotRecording(**{**fields, signal: np.column_stack(columns)})

    return changed


def scaled(
    signals: tuple[str, ...], joint: int, factor: float = 1.0, shift: float = 0.0
) -> Callable[[jid.RobotRecording], jid.RobotRecording]:
    """Signals of one joint times a factor, and moved."""

    def changed(recording: jid.RobotRecording) -> jid.RobotRecording:
        fields = recording.fields()
        for signal in signals:
            values = np.array(fields[signal])
            values[:, joint - 1] = values[:, joint - 1] * factor + shift
            fields[signal] = values
        return jid.RobotRecording(**fields)

    return changed


def thinned(every: int) -> Callable[[jid.RobotRecording], jid.RobotRecording]:
    """Each so many samples."""

    def changed(recording: jid.RobotRecording) -> jid.RobotRecording:
        fields = recording.fields()
        kept = {signal: fields[signal][::every] for signal in recording.signals}
        # A command that was held for one of these samples is no longer held until the next.
        return jid.RobotRecording(**{**fields, **kept, "torque_hold": "linear"})

    return changed


MISMATCHES = (
    Mismatch(name="nothing"),
    Mismatch(name="stamps 0.2 ms late in the mean", sensors=Sensors(stamp_lateness=2e-4)),
    Mismatch(name="stamps 0.5 ms late in the mean", sensors=Sensors(stamp_lateness=5e-4)),
    Mismatch(name="16,384 counts a turn", sensors=Sensors(counts=2.0**14)),
    Mismatch(name="torque noise 3 %", sensors=Sensors(torque_noise=0.03)),
    Mismatch(name="torque 3 ms late", recording=late("torque", 3e-3)),
    Mismatch(name="torque 10 ms late", recording=late("torque", 10e-3)),
    Mismatch(name="200 Hz", recording=thinned(5)),
    Mismatch(
        name="zero of joint 2 off by 5°", recording=scaled(("position",), 2, shift=np.radians(5.0))
    ),
    Mismatch(name="torque of joint 5 with the wrong sign", recording=scaled(("torque",), 5, -1.0)),
    Mismatch(
        name="motion of joint 5 with the wrong sign",
        recording=scaled(("position", "velocity"), 5, -1.0),
    ),
    Mismatch(name="torque of joint 4 10 % too high", recording=scaled(("torque",), 4, 1.1)),
    Mismatch(name="1 kg at the flange", arm=of_body(7, 1.0, (0.02, 0.0, 0.15))),
    Mismatch(name="centre of mass of link 3 off by 2 cm", arm=moved_centre(3, (0.0, 0.02, 0.0))),
    Mismatch(name="base tilted by 10°", arm=tilted(10.0)),
    Mismatch(name="link 2 heavier by 20 %", arm=lambda arm: arm.with_link_scaled(2, 1.2)),
)


def table(seeds: range) -> Iterator[str]:
    """Worst errors over the seeds, and what the calls say."""
    said = "residual | warnings | off by more than 5 %, **nothing said**"
    yield f"| wrong | inertia | worst Coulomb | worst viscous | {said} |"
    yield "|---|---|--:|--:|--:|---|--:|"
    for mismatch in MISMATCHES:
        runs = []
        for seed in seeds:
            arm = mismatch.arm(random_arm(seed))
            recording = recorded(run(arm, random_motion(seed)), mismatch.sensors, seed)
            runs.append((arm, mismatch.recording(recording)))
        for inertia in ("urdf", "free"):
            yield _row(mismatch.name, inertia, runs)


def _row(name: str, inertia: Inertia, runs: list[tuple[Arm, jid.RobotRecording]]) -> str:
    worst = {"coulomb": 0.0, "viscous": 0.0}
    residual, silent, refused, codes = 0.0, 0, 0, []
    for arm, recording in runs:
        try:
            found = jid.identify_robot(recording, jid.Robot.from_urdf(URDF), inertia=inertia)
        except jid.InputError as error:
            codes.append(f"refused: {error}")
            refused += 1
            continue
        errors = Errors.of([(arm, *of_estimate(found))])
        for kind in worst:
            worst[kind] = max(worst[kind], errors.worst(kind))
        residual = max(residual, found.relative_residual)
        codes += [f"`{code}`" for code in {each.code for each in found.warnings}]
        silent += not found.warnings and errors.within(FAR) == 0
    counted = ", ".join(f"{code} {codes.count(code)}" for code in sorted(set(codes)))
    shown = [percent(each, sign=False) for each in (*worst.values(), residual)]
    cells = (
        name,
        inertia,
        *(shown if refused < len(runs) else ["–"] * len(shown)),
        counted or "none",
        f"**{silent}** of {len(runs)}" if silent else "0",
    )
    return f"| {' | '.join(cells)} |"
