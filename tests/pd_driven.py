"""Robots that MuJoCo drives by wanted positions: its friction, contacts with it, integrator and actuators, not ours."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

import jointid as jid

Array = NDArray[np.float64]

LEG = """<robot name="leg"><link name="trunk"/>
 <joint name="hip" type="revolute"><parent link="trunk"/><child link="l1"/><axis xyz="1 0 0"/>
  <limit lower="-1" upper="1" effort="24" velocity="30"/></joint>
 <link name="l1"><inertial><mass value="0.7"/><origin xyz="-0.005 0.002 0"/>
  <inertia ixx="0.0005" iyy="0.0009" izz="0.0006" ixy="0" ixz="0" iyz="0"/></inertial></link>
 <joint name="thigh" type="revolute"><parent link="l1"/><child link="l2"/><origin xyz="0 0.095 0"/>
  <axis xyz="0 1 0"/><limit lower="-2" upper="3" effort="24" velocity="30"/></joint>
 <link name="l2"><inertial><mass value="1.15"/><origin xyz="-0.004 -0.022 -0.033"/>
  <inertia ixx="0.006" iyy="0.0058" izz="0.001" ixy="0" ixz="0" iyz="0"/></inertial></link>
 <joint name="calf" type="revolute"><parent link="l2"/><child link="l3"/><origin xyz="0 0 -0.21"/>
  <axis xyz="0 1 0"/><limit lower="-2.7" upper="-0.8" effort="45" velocity="16"/></joint>
 <link name="l3"><inertial><mass value="0.26"/><origin xyz="0.006 0 -0.14"/>
  <inertia ixx="0.0015" iyy="0.0015" izz="0.00005" ixy="0" ixz="0" iyz="0"/></inertial></link></robot>
"""
ARM = """<robot name="arm"><link name="base"/>
 <joint name="turn" type="revolute"><parent link="base"/><child link="a"/><axis xyz="0 0 1"/>
  <limit lower="-3" upper="3" effort="60" velocity="5"/></joint>
 <link name="a"><inertial><mass value="3"/><origin xyz="0 0.02 0.1"/>
  <inertia ixx="0.02" iyy="0.02" izz="0.01" ixy="0" ixz="0" iyz="0"/></inertial></link>
 <joint name="lift" type="revolute"><parent link="a"/><child link="b"/><origin xyz="0 0 0.2"/><axis xyz="0 1 0"/>
  <limit lower="-3" upper="3" effort="60" velocity="5"/></joint>
 <link name="b"><inertial><mass value="2.5"/><origin xyz="0 0 0.18"/>
  <inertia ixx="0.03" iyy="0.03" izz="0.004" ixy="0" ixz="0" iyz="0"/></inertial></link>
 <joint name="bend" type="revolute"><parent link="b"/><child link="c"/><origin xyz="0 0 0.35"/><axis xyz="0 1 0"/>
  <limit lower="-3" upper="3" effort="60" velocity="5"/></joint>
 <link name="c"><inertial><mass value="1.2"/><origin xyz="0 0 0.15"/>
  <inertia ixx="0.01" iyy="0.01" izz="0.001" ixy="0" ixz="0" iyz="0"/></inertial></link>
 <joint name="roll" type="revolute"><parent link="c"/><child link="d"/><origin xyz="0 0 0.3"/><axis xyz="0 0 1"/>
  <limit lower="-3" upper="3" effort="60" velocity="5"/></joint>
 <link name="d"><inertial><mass value="0.6"/><origin xyz="0.05 0 0.05"/>
  <inertia ixx="0.002" iyy="0.002" izz="0.003" ixy="0" ixz="0" iyz="0"/></inertial></link></robot>
"""
_STEP = 1e-4  # [s] of the simulation: an integrator's own error looks like armature, (kd - damping) x half a step
_ROW = 5e-3  # [s]


@dataclass(frozen=True, kw_only=True)
class Truth:
    """What a robot is made of; one value a joint."""

    urdf: str
    middle: Array  # [rad], of the wanted motion
    swing: Array
    kp: Array
    kd: Array
    armature: Array
    coulomb: Array
    viscous: Array
    fastest: float  # [Hz]


LEG_TRUTH = Truth(
    urdf=LEG,
    middle=np.array([0.0, 0.8, -1.7]),
    swing=np.array([0.35, 0.6, 0.6]),
    kp=np.full(3, 20.0),
    kd=np.full(3, 1.5),
    armature=np.array([0.008, 0.016, 0.035]),
    coulomb=np.array([0.2, 0.2, 0.6]),
    viscous=np.array([0.15, 0.2, 0.2]),
    fastest=4.0,
)
ARM_TRUTH = Truth(
    urdf=ARM,
    middle=np.array([0.0, 0.3, 0.8, 0.0]),
    swing=np.array([0.8, 0.5, 0.7, 0.9]),
    kp=np.array([150.0, 200.0, 120.0, 30.0]),
    kd=np.array([8.0, 10.0, 5.0, 1.0]),
    armature=np.array([0.25, 0.3, 0.12, 0.02]),
    coulomb=np.array([2.0, 2.5, 1.2, 0.3]),
    viscous=np.array([1.5, 2.0, 0.8, 0.15]),
    fastest=3.0,
)


def driven(
    truth: Truth,
    folder: Path,
    seed: int,
    *,
    delay: float = 0.0,
    duration: float = 24.0,
    limit: float | None = None,
    gravity: tuple[float, float, float] = (0.0, 0.0, -9.81),
    resolution: float = 2e-5,
) -> tuple[Path, jid.RobotRecording]:
    """The URDF, and a recording at 200 Hz; each wanted position acts `delay` [s] after its row and is held."""
    import mujoco  # type: ignore[import-untyped]

    path = folder / "driven.urdf"
    path.write_text(truth.urdf, encoding="utf-8")
    spec = mujoco.MjSpec.from_file(str(path))
    spec.option.timestep = _STEP
    spec.option.gravity = gravity
    spec.option.disableflags |= mujoco.mjtDisableBit.mjDSBL_CONTACT
    names = [joint.name for joint in spec.joints]
    for joint in spec.joints:
        joint.limited = mujoco.mjtLimited.mjLIMITED_FALSE
        joint.actfrclimited = mujoco.mjtLimited.mjLIMITED_FALSE
        spec.add_actuator(name=joint.name, target=joint.name, trntype=mujoco.mjtTrn.mjTRN_JOINT)
    model = spec.compile()
    model.dof_armature[:], model.dof_damping[:] = truth.armature, truth.viscous
    model.dof_frictionloss[:] = truth.coulomb
    # The usual friction of MuJoCo creeps: here it is almost dry.
    model.dof_solref[:] = [2.0 * _STEP, 1.0]
    model.dof_solimp[:] = [0.999, 0.9999, 1e-4, 0.5, 2.0]
    model.actuator_biastype[:] = mujoco.mjtBias.mjBIAS_AFFINE
    model.actuator_gainprm[:, 0] = truth.kp
    model.actuator_biasprm[:, 1], model.actuator_biasprm[:, 2] = -truth.kp, -truth.kd
    if limit is not None:
        model.actuator_forcelimited[:] = True
        model.actuator_forcerange[:] = [-limit, limit]
    data = mujoco.MjData(model)
    rows = round(duration / _ROW)
    time = _ROW * np.arange(rows)
    wanted = _motion(truth, time, np.random.default_rng(seed))
    data.qpos[:] = wanted[0]
    data.ctrl[:] = wanted[0]
    each = round(_ROW / _STEP)
    late = round(delay / _STEP)
    whole, part = divmod(late, each)
    position = np.empty_like(wanted)
    for row in range(rows):
        position[row] = data.qpos
        if part:
            mujoco.mj_step(model, data, nstep=part)
        data.ctrl[:] = wanted[max(row - whole, 0)]
        mujoco.mj_step(model, data, nstep=each - part)
    if resolution:
        position = resolution * np.round(position / resolution)
    return path, jid.RobotRecording(time=time, position=position, reference=wanted, names=names)


def _motion(truth: Truth, time: NDArray[Any], random: np.random.Generator) -> Array:
    """Chirps between a slow and a fast swing, with other phases and a slow drift for each joint."""
    found = np.empty((time.size, truth.middle.size))
    for joint in range(truth.middle.size):
        low, high = random.uniform(0.1, 0.2), truth.fastest * random.uniform(0.7, 1.0)
        rate = low * (high / low) ** (time / time[-1])
        angle = 2.0 * np.pi * np.cumsum(rate) * (time[1] - time[0]) + random.uniform(0.0, 6.3)
        size = truth.swing[joint] / (1.0 + (rate / 1.5))
        slow = 0.3 * truth.swing[joint] * np.sin(random.uniform(0.3, 0.9) * time + joint)
        found[:, joint] = truth.middle[joint] + size * np.sin(angle) + slow
    return found
