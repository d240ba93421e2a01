"""Wrong facts of arms of other shapes: a slide, random geometry, motors without friction of their own, one plane."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray

import jointid as jid

pinocchio = pytest.importorskip("pinocchio")

Array = NDArray[np.float64]


def urdf(kinds: str, seed: int) -> str:
    """A chain of hinges (r) and slides (p) of random geometry."""
    rng = np.random.default_rng(seed)
    parts = ['<robot name="chain"><link name="link_0"/>']
    for number, kind in enumerate(kinds, start=1):
        axis = np.eye(3)[(number + int(seed)) % 3]
        origin = rng.uniform(-0.3, 0.3, 3) * (number > 1)
        turn = rng.choice([0.0, np.pi / 2, 0.3], 3)
        mass = 12.0 * 0.72**number
        centre, half = rng.uniform(-0.12, 0.12, 3), rng.normal(size=(3, 3)) * 0.05 * np.sqrt(mass)
        spread = half @ half.T + np.eye(3) * mass * 0.004
        inertia = np.trace(spread) * np.eye(3) - spread
        moments = " ".join(
            f'i{"xyz"[i]}{"xyz"[j]}="{inertia[i, j]}"' for i in range(3) for j in range(i, 3)
        )
        of = "revolute" if kind == "r" else "prismatic"
        parts.append(
            f'<joint name="j{number}" type="{of}"><parent link="link_{number - 1}"/>'
            f'<child link="link_{number}"/><axis xyz="{_text(axis)}"/>'
            f'<origin xyz="{_text(origin)}" rpy="{_text(turn)}"/>'
            '<limit effort="900" velocity="9" lower="-4" upper="4"/></joint>'
            f'<link name="link_{number}"><inertial><mass value="{mass}"/>'
            f'<origin xyz="{_text(centre)}"/><inertia {moments}/></inertial></link>'
        )
    return "\n".join([*parts, "</robot>"])


def _text(values: Array) -> str:
    return " ".join(str(float(each)) for each in values)


def moved(path: Path, seed: int, gravity: Array | None = None) -> tuple[Array, Array, Array]:
    """Time, positions and torques of an arm with friction at its joints alone, 10 s at 400 Hz."""
    rng = np.random.default_rng(seed)
    model = pinocchio.buildModelFromUrdf(str(path))
    if gravity is not None:
        model.gravity.linear = gravity
    data, n = model.createData(), model.nv
    time = np.arange(0.0, 10.0, 0.0025)
    rates = 2.0 * np.pi * rng.uniform([0.1, 0.3, 0.6], [0.25, 0.55, 1.0], (n, 3))
    slides = np.array([joint.shortname().startswith("JointModelP") for joint in model.joints])[1:]
    sizes = np.array([0.8, 0.4, 0.2]) * np.where(slides, 0.25, 1.0)[:, None]
    phases = rates[:, :, None] * time + rng.uniform(0.0, 7.0, (n, 3))[:, :, None]
    q = np.einsum("jk,jkn->nj", sizes, np.sin(phases))
    v = np.einsum("jk,jkn->nj", sizes * rates, np.cos(phases))
    a = -np.einsum("jk,jkn->nj", sizes * rates**2, np.sin(phases))
    links = np.array([pinocchio.rnea(model, data, *each) for each in zip(q, v, a, strict=True)])
    usual = np.maximum(links.std(axis=0), 1.0)
    torque = links + usual * (0.02 * a + 0.3 * np.sign(v) + 0.2 * v / np.where(slides, 0.25, 1.0))
    torque += rng.normal(size=torque.shape) * 0.01 * torque.std(axis=0)
    return time, q + 2e-5 * rng.normal(size=q.shape), torque


def recorded(time: Array, q: Array, torque: Array, side: str = "joint") -> jid.RobotRecording:
    names = [f"j{k + 1}" for k in range(q.shape[1])]
    return jid.RobotRecording(time=time, position=q, torque=torque, names=names, side=side)


def warned(estimate: jid.RobotEstimate) -> list[str]:
    """Codes of the warnings that name a fact."""
    quality = ("undetermined", "at_bound", "poor_fit")
    return [each.code for each in estimate.warnings if each.code not in quality]


@pytest.mark.parametrize(("seed", "joint"), [(0, 1), pytest.param(1, 2, marks=pytest.mark.slow)])
@pytest.mark.parametrize(
    ("code", "of_position", "of_torque"),
    [("wrong_motion_sign", -1.0, 1.0), ("wrong_torque_sign", 1.0, -1.0)],
)
def test_a_sign_of_an_arm_with_a_slide_is_named_as_that(
    tmp_path: Path, seed: int, joint: int, code: str, of_position: float, of_torque: float
) -> None:
    path = tmp_path / "arm.urdf"
    path.write_text(urdf("rrpr", seed))
    time, q, torque = moved(path, seed)
    q[:, joint] *= of_position
    torque[:, joint] *= of_torque
    found = jid.identify_robot(recorded(time, q, torque), jid.Robot.from_urdf(path))
    assert warned(found) == [code]
    assert f"j{joint + 1}" in found.findings[0].cause


@pytest.mark.parametrize("joints", [3, pytest.param(6, marks=pytest.mark.slow)])
def test_a_coupling_is_named_though_its_motor_has_no_friction_of_its_own(
    tmp_path: Path, joints: int
) -> None:
    path = tmp_path / "arm.urdf"
    path.write_text(urdf("r" * joints, 0))
    time, q, torque = moved(path, 0)
    coupling, ratio = np.eye(joints), 40.0
    coupling[-1, -2] = 1.0
    pushed: Array = np.asarray(np.linalg.solve(coupling.T, torque.T).T / ratio, dtype=np.float64)
    run = recorded(time, ratio * q @ coupling.T, pushed, side="motor")
    found = jid.identify_robot(run, jid.Robot.from_urdf(path, gear_ratios=[ratio] * joints))
    assert warned(found)[:1] == ["wrong_coupling"]
    assert found.findings[0].advice[0].arguments == {
        "couplings": {f"j{joints}": {f"j{joints - 1}": 1.0}}
    }


def test_a_mirrored_plane_names_both_joints_that_may_turn_the_other_way(tmp_path: Path) -> None:
    path = tmp_path / "arm.urdf"
    path.write_text(
        """<robot name="arm"><link name="base"/>
  <joint name="j1" type="revolute"><parent link="base"/><child link="upper"/><axis xyz="0 1 0"/>
    <limit effort="100" velocity="5" lower="-3" upper="3"/></joint>
  <link name="upper"><inertial><mass value="5"/><origin xyz="0 0 -0.2"/>
    <inertia ixx="0.06" ixy="0" ixz="0" iyy="0.06" iyz="0" izz="0.01"/></inertial></link>
  <joint name="j2" type="revolute"><parent link="upper"/><child link="lower"/><axis xyz="0 1 0"/>
    <origin xyz="0 0 -0.4"/><limit effort="100" velocity="5" lower="-3" upper="3"/></joint>
  <link name="lower"><inertial><mass value="3"/><origin xyz="0 0 -0.15"/>
    <inertia ixx="0.03" ixy="0" ixz="0" iyy="0.03" iyz="0" izz="0.005"/></inertial></link></robot>"""
    )
    time, q, torque = moved(path, 0)
    turned = np.array([-1.0, 1.0])
    found = jid.identify_robot(
        recorded(time, q * turned, torque * turned), jid.Robot.from_urdf(path)
    )
    assert warned(found) == ["wrong_sign"]
    assert "j1" in found.findings[0].cause
    assert re.search(r"or the signs of j[12]", found.findings[0].cause)


@pytest.mark.parametrize(
    "seed", [0, *(pytest.param(seed, marks=pytest.mark.slow) for seed in (1, 2))]
)
def test_a_tilt_is_not_told_as_a_zero_and_a_smaller_tilt(tmp_path: Path, seed: int) -> None:
    path = tmp_path / "arm.urdf"
    path.write_text(urdf("rrpr", seed))
    lean = np.array([9.81 * np.sin(0.08), 0.3, -9.81 * np.cos(0.08)])
    run = recorded(*moved(path, seed, gravity=lean))
    assert warned(jid.identify_robot(run, jid.Robot.from_urdf(path))) == ["tilted_base"]
