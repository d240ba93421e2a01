"""An arm of two links in a vertical plane that swings: exact torques by pinocchio, friction of our own."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

import jointid as jid

Array = NDArray[np.float64]

URDF = """<robot name="small">
  <link name="base"/>
  <joint name="shoulder" type="revolute"><parent link="base"/><child link="upper"/>
    <origin xyz="0 0 0.5"/><axis xyz="0 1 0"/>
    <limit effort="100" velocity="5" lower="-3" upper="3"/>
    <dynamics damping="0.1" friction="0"/></joint>
  <link name="upper"><inertial><mass value="5"/><origin xyz="0 0 -0.2"/>
    <inertia ixx="0.06" ixy="0" ixz="0" iyy="0.06" iyz="0" izz="0.01"/></inertial></link>
  <joint name="elbow" type="revolute"><parent link="upper"/><child link="lower"/>
    <origin xyz="0 0 -0.4"/><axis xyz="0 1 0"/>
    <limit effort="100" velocity="5" lower="-3" upper="3"/></joint>
  <link name="lower"><inertial><mass value="3"/><origin xyz="0 0 -0.15"/>
    <inertia ixx="0.03" ixy="0" ixz="0" iyy="0.03" iyz="0" izz="0.005"/></inertial></link>
</robot>
"""
COULOMB, VISCOUS, ROTOR = np.array([4.0, 2.0]), np.array([3.0, 1.5]), np.array([0.5, 0.2])


def urdf(folder: Path, text: str = URDF) -> Path:
    """The file."""
    path = folder / "small.urdf"
    path.write_text(text, encoding="utf-8")
    return path


def recording(
    path: Path,
    *,
    static: float = 0.0,
    duration: float = 12.0,
    seed: int = 0,
    names: tuple[str, ...] = ("shoulder", "elbow"),
    friction: Callable[[Array], Array] | None = None,
    under_load: tuple[float, float] = (0.0, 0.0),
) -> jid.RobotRecording:
    """At 1 kHz, with 0.02 N·m of noise on the torques; `friction` of both speeds instead of ours.

    `under_load`: shares of the links' torque that each joint has as further friction.
    """
    import pinocchio

    model = pinocchio.buildModelFromUrdf(str(path))
    state = model.createData()
    time = np.arange(0.0, duration, 1e-3)
    rates = np.array([[1.1, 2.9, 5.3], [0.7, 3.7, 6.1]])
    sizes = np.array([0.5, 0.3, 0.1])
    phases = rates[:, :, None] * time + np.arange(3)[:, None] + seed
    q = np.einsum("k,jkn->nj", sizes, np.sin(phases))
    v = np.einsum("jk,jkn->nj", sizes * rates, np.cos(phases))
    a = -np.einsum("jk,jkn->nj", sizes * rates**2, np.sin(phases))
    torque = np.array([pinocchio.rnea(model, state, *each) for each in zip(q, v, a, strict=True)])
    torque = torque + under_load * np.abs(torque) * np.sign(v)
    dry = COULOMB * (1.0 + static * np.exp(-100.0 * v**2))
    torque = torque + ROTOR * a
    torque = torque + dry * np.sign(v) + VISCOUS * v if friction is None else torque + friction(v)
    torque += np.random.default_rng(seed).normal(scale=0.02, size=torque.shape)
    return jid.RobotRecording(time=time, position=q, torque=torque, names=names)
