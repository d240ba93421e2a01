"""Momentum and force as columns of the inertial parameters, against pinocchio."""

from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray

from jointid.robot.links.link_tree import LinkTree
from jointid.robot.links.momentum import columns_of
from jointid.robot.links.reading_urdf import tree_of_urdf

Array = NDArray[np.float64]
GRAVITY = (0.3, -1.2, -9.6)

# A branch, a slide, a fixed joint with a tool, oblique axes and turned frames: nothing is special.
URDF = """<robot name="odd">
<link name="base"/>
<joint name="turn" type="revolute"><parent link="base"/><child link="a"/><axis xyz="0 0 1"/>
  <origin xyz="0 0.1 0.3" rpy="0.2 -0.4 0.7"/><limit effort="1" velocity="1" lower="-3" upper="3"/></joint>
<link name="a"><inertial><mass value="4"/><origin xyz="0.1 0.02 0.2" rpy="0.1 0.2 0.3"/>
  <inertia ixx="0.03" ixy="0.002" ixz="0.001" iyy="0.04" iyz="0.003" izz="0.02"/></inertial></link>
<joint name="slide" type="prismatic"><parent link="a"/><child link="b"/><axis xyz="0.6 0 0.8"/>
  <origin xyz="0.2 0 0.1" rpy="-0.3 0.1 0"/><limit effort="1" velocity="1" lower="-3" upper="3"/></joint>
<link name="b"><inertial><mass value="2"/><origin xyz="0.05 -0.1 0"/>
  <inertia ixx="0.01" ixy="0" ixz="0.001" iyy="0.02" iyz="0" izz="0.015"/></inertial></link>
<joint name="spin" type="continuous"><parent link="b"/><child link="c"/><axis xyz="0 -0.28 0.96"/>
  <origin xyz="0 0.3 0" rpy="0 0.5 0"/></joint>
<link name="c"><inertial><mass value="1"/><origin xyz="0 0.1 0.1"/>
  <inertia ixx="0.004" ixy="0" ixz="0" iyy="0.003" iyz="0" izz="0.005"/></inertial></link>
<joint name="flange" type="fixed"><parent link="c"/><child link="tool"/><origin xyz="0 0 0.2"/></joint>
<link name="tool"><inertial><mass value="0.7"/><origin xyz="0.02 0 0"/>
  <inertia ixx="0.001" ixy="0" ixz="0" iyy="0.001" iyz="0" izz="0.001"/></inertial></link>
<joint name="side" type="revolute"><parent link="a"/><child link="d"/><axis xyz="1 0 0"/>
  <origin xyz="-0.2 0 0.1"/><limit effort="1" velocity="1" lower="-3" upper="3"/></joint>
<link name="d"><inertial><mass value="3"/><origin xyz="0 0.2 0"/>
  <inertia ixx="0.02" ixy="0" ixz="0" iyy="0.02" iyz="0" izz="0.03"/></inertial></link>
</robot>"""


@pytest.fixture(name="urdf")
def _urdf(tmp_path: Path) -> Path:
    path = tmp_path / "odd.urdf"
    path.write_text(URDF, encoding="utf-8")
    return path


def _spread(tree: LinkTree, columns: Array) -> Array:
    """Columns by all links: joints, inertial parameters, samples."""
    n = len(tree.names)
    found = np.zeros((n, 10 * n, columns.shape[2]))
    for number, (joint, link) in enumerate(tree.pairs):
        found[joint, 10 * link : 10 * link + 10] = columns[number]
    return found


def test_momentum_and_force_are_pinocchio_s(urdf: Path) -> None:
    pinocchio = pytest.importorskip("pinocchio")
    tree = tree_of_urdf(urdf, None, GRAVITY)
    model = pinocchio.buildModelFromUrdf(str(urdf))
    model.gravity.linear = np.array(GRAVITY)
    state = model.createData()
    n = model.nv
    assert tree.names == tuple(list(model.names)[1:])
    generator = np.random.default_rng(5)
    position, velocity = generator.normal(size=(2, n, 20))
    momentum, force = columns_of(tree, position, velocity)
    by_momentum, by_force = _spread(tree, momentum), _spread(tree, force)
    inertias = tree.inertias.ravel()

    def whole(angles: Array) -> Array:
        """pinocchio's configuration: of a continuous joint cosine and sine."""
        found = pinocchio.neutral(model)
        for name, angle in zip(tree.names, angles, strict=True):
            joint = model.joints[model.getJointId(name)]
            values = [angle] if joint.nq == 1 else [np.cos(angle), np.sin(angle)]
            found[joint.idx_q : joint.idx_q + joint.nq] = values
        return np.asarray(found)

    for sample in range(position.shape[1]):
        q, v = whole(position[:, sample]), velocity[:, sample].copy()
        still = np.zeros(n)
        weight = pinocchio.computeJointTorqueRegressor(model, state, q, still, still)
        moved = pinocchio.computeJointTorqueRegressor(model, state, q, still, v) - weight
        np.testing.assert_allclose(by_momentum[:, :, sample], moved, atol=1e-12)
        # The same with the inertias: (C^T v - g) by pinocchio's own matrices.
        coriolis = pinocchio.computeCoriolisMatrix(model, state, q, v)
        gravity = pinocchio.computeGeneralizedGravity(model, state, q)
        expected = coriolis.T @ v - gravity
        np.testing.assert_allclose(by_force[:, :, sample] @ inertias, expected, atol=1e-11)
        mass = pinocchio.crba(model, state, q)
        mass = np.triu(mass) + np.triu(mass, 1).T
        np.testing.assert_allclose(by_momentum[:, :, sample] @ inertias, mass @ v, atol=1e-12)


def test_a_chosen_chain_keeps_the_other_joints_at_zero(urdf: Path) -> None:
    pytest.importorskip("pinocchio")
    whole = tree_of_urdf(urdf, None, GRAVITY)
    part = tree_of_urdf(urdf, ["turn", "spin"], GRAVITY)
    assert part.names == ("turn", "spin")
    q, v = np.random.default_rng(1).normal(size=(2, 2, 5))
    places = [whole.names.index(name) for name in part.names]
    every_q, every_v = np.zeros((2, len(whole.names), 5))
    every_q[places], every_v[places] = q, v
    momentum, _ = columns_of(part, q, v)
    all_momentum, _ = columns_of(whole, every_q, every_v)
    found = np.einsum("jps,p->js", _spread(part, momentum), part.inertias.ravel())
    expected = np.einsum("jps,p->js", _spread(whole, all_momentum), whole.inertias.ravel())
    np.testing.assert_allclose(found, expected[places], atol=1e-12)
