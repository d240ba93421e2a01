"""Identification of an SO-101 arm of hobby servos from wanted positions, tested by a rollout of another motion.

    python benchmarks/so101_study.py FOLDER

FOLDER has frequency_sweep_*.csv.gz, coupled_joints_*.csv.gz (isaac-sim2real/sage, Apache-2.0), so101_new_calib.urdf
and so101_no_meshes.xml (TheRobotStudio/SO-ARM100, Apache-2.0). The sweep is identified, the other motion is simulated.
All servos have the same gain: the gain that agrees with the weight of three links. MuJoCo simulates the motion.
"""

from __future__ import annotations

import csv
import gzip
import json
import sys
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

import jointid as jid

Array = NDArray[np.float64]

NAMES = ("shoulder_pan", "shoulder_lift", "elbow_flex", "wrist_flex", "wrist_roll", "gripper")
WEIGHED = NAMES[1:4]  # joints with a gravity load
# Published pairs of armature [kg·m²] and dry friction [N·m] of shoulder_lift.
PUBLISHED = ((0.147, 0.0), (0.044, 0.318), (0.028, 0.345), (0.02, 0.0))
_STEP = 5e-4  # [s]
_SETTLED = 2.0  # [s] at the beginning, left out of the errors


def recording(folder: Path, name: str) -> jid.RobotRecording:
    """Return positions and wanted positions of a motion."""

    def rows(kind: str) -> tuple[Array, Array]:
        with gzip.open(folder / f"{name}_{kind}.csv.gz", "rt", encoding="utf-8") as file:
            found = list(csv.DictReader(file))
        time = np.array([float(each["timestamp"]) for each in found]) * 1e-6
        return time, np.array([json.loads(each["positions"]) for each in found])

    time, position = rows("state_motor")
    _, wanted = rows("control")
    return jid.RobotRecording(
        time=time - time[0], position=position, reference=wanted, names=NAMES, name=name
    )


def identified(
    folder: Path, log: jid.RobotRecording
) -> tuple[float, float, list[jid.RobotEstimate]]:
    """Return the common gain, the deviation of single gains, and estimates with this, a lower and a higher gain."""
    urdf = folder / "so101_new_calib.urdf"
    free = jid.Robot.from_urdf(urdf, drive={"kp": "free", "kd": "free"})
    found = jid.identify(log, free)
    gains = [found.joints[name].parameters["position_gain"].value for name in WEIGHED]
    gain = float(np.mean(gains))
    spread = float(np.std(gains, ddof=1))
    every = [
        jid.identify(
            log,
            jid.Robot.from_urdf(urdf, drive={"kp": each, "kd": "free"}),
            model="coulomb_viscous",
        )
        for each in (gain, gain - spread, gain + spread)
    ]
    return gain, spread, every


def rolled_out(
    folder: Path,
    log: jid.RobotRecording,
    gain: float,
    values: dict[str, Array],
) -> Array:
    """Return positions of MuJoCo's arm at the rows; it starts as the real arm and follows the wanted positions."""
    import mujoco  # type: ignore[import-untyped]

    model = mujoco.MjModel.from_xml_path(str(folder / "so101_no_meshes.xml"))
    model.opt.timestep = _STEP
    model.opt.disableflags |= mujoco.mjtDisableBit.mjDSBL_CONTACT
    order = [model.joint(name).dofadr[0] for name in NAMES]
    model.dof_armature[order] = values["rotor_inertia"]
    model.dof_damping[order] = values["viscous"]
    model.dof_frictionloss[order] = values["coulomb"]
    model.dof_solref[:], model.dof_solimp[:] = [2.0 * _STEP, 1.0], [0.999, 0.9999, 1e-4, 0.5, 2.0]
    model.actuator_gainprm[:, 0] = gain
    model.actuator_biasprm[:, 1], model.actuator_biasprm[:, 2] = -gain, 0.0
    model.actuator_ctrllimited[:] = False
    data = mujoco.MjData(model)
    at = [model.joint(name).qposadr[0] for name in NAMES]
    acts = [model.actuator(name).id for name in NAMES]
    assert log.reference is not None
    steps = round(log.duration / _STEP)
    clock = _STEP * np.arange(steps + 1)
    delays = values["delay"]
    row = np.searchsorted(log.time, clock[:, None] - delays[None, :], side="right") - 1
    wanted = log.reference[np.maximum(row, 0), np.arange(len(NAMES))]
    wanted = wanted - values["offset"] / gain
    data.qpos[at] = log.position[0]
    found = np.empty((steps + 1, len(NAMES)))
    for step in range(steps + 1):
        found[step] = data.qpos[at]
        data.ctrl[acts] = wanted[step]
        mujoco.mj_step(model, data)
    return np.array([np.interp(log.time, clock, found[:, k]) for k in range(len(NAMES))]).T


def errors(log: jid.RobotRecording, position: Array) -> Array:
    """Return the RMS position error of each joint [rad]."""
    later = log.time > _SETTLED
    return np.asarray(np.sqrt(np.mean((position - log.position)[later] ** 2, axis=0)))


def values_of(found: jid.RobotEstimate) -> dict[str, Array]:
    """Return the values that a rollout needs, one value per joint."""
    late: Any = found.settings["shift"].get("reference", 0.0)
    each = late if isinstance(late, dict) else dict.fromkeys(NAMES, late)

    def of(name: str) -> Array:
        joints = found.joints.values()
        return np.array([joint.parameters[name].value for joint in joints])

    return {
        **{name: of(name) for name in ("rotor_inertia", "coulomb", "viscous")},
        "offset": of("torque_offset"),
        "delay": np.array([each.get(name, 0.0) for name in NAMES]),
    }


def main() -> None:
    """Print the values with their intervals, and the position errors of all sets of values."""
    folder = Path(sys.argv[1])
    gain, spread, (found, *others) = identified(folder, recording(folder, "frequency_sweep"))
    judged = recording(folder, "coupled_joints")
    print(f"gain {gain:.2f} N·m/rad for all, {spread:.2f} apart; {found.verdict.level}")
    for name, joint in found.joints.items():
        texts = []
        for key in ("rotor_inertia", "coulomb", "viscous"):
            p = joint.parameters[key]
            # The interval also includes the uncertainty of the common gain.
            every = [p, *(each.joints[name].parameters[key] for each in others)]
            ends = [end for each in every for end in each.interval or (each.value,)]
            low, high = max(min(ends), 0.0), max(*ends, p.value)
            texts.append(f"{key} {p.value:.4f} ({low:.4f} to {high:.4f})")
        print(f"{name:14} {', '.join(texts)}; residual {100 * joint.relative_residual:.1f} %")
    ours = values_of(found)
    print("\nrms error of positions in the other motion [mrad]:", ", ".join(NAMES))
    print("identified    ", 1e3 * errors(judged, rolled_out(folder, judged, gain, ours)).round(5))
    lift = NAMES.index("shoulder_lift")
    for armature, dry in PUBLISHED:
        other = {key: value.copy() for key, value in ours.items()}
        other["rotor_inertia"][lift], other["coulomb"][lift] = armature, dry
        left = 1e3 * errors(judged, rolled_out(folder, judged, gain, other)).round(5)
        print(f"{armature:.3f} / {dry:.3f} ", left)


if __name__ == "__main__":
    main()
