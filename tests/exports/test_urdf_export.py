"""Exported URDF: read by urdf_parser_py and by MuJoCo, alone and edited into a robot's own file."""

from __future__ import annotations

import re
import warnings
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from exported_joints import LOADED, SLIDING, shipped_estimate

import jointid as jid


def robot_of(path: Path) -> Any:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # it is old: what it says of itself depends on the Python
        urdf = pytest.importorskip("urdf_parser_py.urdf")
        return urdf.URDF.from_xml_string(path.read_bytes())


def test_a_robot_of_one_joint(tmp_path: Path) -> None:
    path = jid.export(LOADED, tmp_path / "joint.urdf")
    robot = robot_of(path)
    (joint,) = robot.joints
    assert joint.type == "revolute"
    assert (joint.dynamics.damping, joint.dynamics.friction) == (1.7, 3.1)
    assert (joint.limit.lower, joint.limit.upper) == (-2.0, 2.0)
    assert (joint.limit.effort, joint.limit.velocity) == (60.0, 2.5)
    inertial = robot.links[1].inertial
    assert inertial.mass == 2.5
    # About the axis, one body has the inertia of link and drive: URDF has none of a drive.
    distance = np.hypot(*(inertial.origin.xyz[k] for k in (0, 2)))
    about = inertial.inertia.iyy + inertial.mass * distance**2
    assert about == pytest.approx(LOADED.known_inertia)


def test_mujoco_reads_the_robot(tmp_path: Path) -> None:
    mujoco: Any = pytest.importorskip("mujoco")
    for joint in (LOADED, SLIDING):
        model = mujoco.MjModel.from_xml_path(str(jid.export(joint, tmp_path / "joint.urdf")))
        viscous, coulomb = (joint.parameters[name].value or 0.0 for name in ("viscous", "coulomb"))
        assert model.dof_damping[0] == viscous > 0.0
        assert model.dof_frictionloss[0] == coulomb > 0.0
        state = mujoco.MjData(model)
        position, velocity, acceleration = 0.3, 0.5, 2.0
        state.qpos[0], state.qvel[0], state.qacc[0] = position, velocity, acceleration
        mujoco.mj_inverse(model, state)
        friction = 0.5 * viscous + coulomb
        gravity = 0.0
        if joint.link is not None:
            known = joint.gravity_coefficients
            # MuJoCo's own gravity is 9.81, the link's 9.80665.
            gravity = known.cos * np.cos(position) + known.sin * np.sin(position)
        wanted = (joint.known_inertia or 0.0) * acceleration + friction + gravity
        assert state.qfrc_inverse[0] == pytest.approx(wanted, rel=1e-3)


ROBOT = """<?xml version="1.0"?>
<robot name="arm">
  <link name="base"/> <link name="upper"/> <link name="lower"/>
  <joint name="shoulder" type="revolute">
    <parent link="base"/>   <!-- keep -->
    <child link="upper"/>
    <limit effort="99" lower="-1" upper="1" velocity="3"/>
    <dynamics friction='0'  damping="0.1"/>
  </joint>
  <joint name="elbow" type="continuous">
    <parent link="upper"/>
    <child link="lower"/>
  </joint>
  <transmission name="t"><type>simple</type><joint name="shoulder"><hardwareInterface>e</hardwareInterface></joint>
    <actuator name="m"><mechanicalReduction>1</mechanicalReduction></actuator></transmission>
</robot>
"""


def test_the_dynamics_of_a_joint_are_set(tmp_path: Path) -> None:
    path = tmp_path / "arm.urdf"
    path.write_text(ROBOT, encoding="utf-8")
    jid.export(LOADED, path, into=path, joint_name="shoulder")
    after = path.read_text(encoding="utf-8")
    joint = robot_of(path).joint_map["shoulder"]
    assert (joint.dynamics.damping, joint.dynamics.friction) == (1.7, 3.1)
    assert (joint.limit.effort, joint.limit.velocity) == (99.0, 3.0)  # the maker's stay
    plain = re.sub(r" *<!-- jointid:.*?-->\n", "", after, flags=re.DOTALL)
    assert plain == ROBOT.replace(
        """friction='0'  damping="0.1\"""", 'friction="3.1"  damping="1.7"'
    )
    jid.export(LOADED, path, into=path, joint_name="shoulder")
    assert path.read_text(encoding="utf-8") == after


def test_dynamics_and_limits_are_added(tmp_path: Path) -> None:
    path = tmp_path / "arm.urdf"
    path.write_text(ROBOT, encoding="utf-8")
    new = jid.export(LOADED, tmp_path / "new.urdf", into=path, joint_name="elbow")
    joint = robot_of(new).joint_map["elbow"]
    assert (joint.dynamics.damping, joint.dynamics.friction) == (1.7, 3.1)
    assert (joint.limit.effort, joint.limit.velocity) == (60.0, 2.5)
    assert path.read_text(encoding="utf-8") == ROBOT
    lines = new.read_text(encoding="utf-8").splitlines()
    assert '    <dynamics damping="1.7" friction="3.1"/>' in lines


def test_what_urdf_cannot_express(tmp_path: Path) -> None:
    with pytest.raises(jid.InputError, match="urdf has only Coulomb and viscous friction"):
        jid.export(shipped_estimate(), tmp_path / "j.urdf")
    path = jid.export(shipped_estimate(), tmp_path / "j.urdf", approximate=True)
    assert "lost: Stribeck friction" in path.read_text(encoding="utf-8")
    assert robot_of(path).joints[0].type == "continuous"
    bare = SLIDING.replace(limits=jid.Limits())
    with pytest.raises(jid.InputError, match="needs position, velocity and torque"):
        jid.export(bare, tmp_path / "slide.urdf")
