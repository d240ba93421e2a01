"""Inertia that bodies can have: found, written into the URDF, or said not to be."""

from pathlib import Path

import numpy as np
import pytest
from small_arm import COULOMB, ROTOR, URDF, VISCOUS, recording, urdf

import jointid as jid
from jointid.robot.links.bodies import possible
from jointid.robot.links.possible_bodies import nearest_possible

pytest.importorskip("pinocchio")

Array = np.ndarray
BALL = np.array([2.0, 0, 0, 0, 0.1, 0, 0.1, 0, 0, 0.1])
NO_DISCS = np.zeros((10, 0))
# A flange, fixed to the lower link and off its frame.
FLANGE = """  <link name="flange"><inertial><mass value="0.5"/><origin xyz="0 0 -0.02"/>
    <inertia ixx="0.001" ixy="0" ixz="0" iyy="0.001" iyz="0" izz="0.001"/></inertial></link>
  <joint name="flange_joint" type="fixed"><parent link="lower"/><child link="flange"/>
    <origin xyz="0.01 0 -0.3" rpy="0 0.3 0"/></joint>
</robot>"""


@pytest.fixture(name="path", scope="module")
def _path(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return urdf(tmp_path_factory.mktemp("flanged"), URDF.replace("</robot>", FLANGE))


@pytest.fixture(name="free", scope="module")
def _free(path: Path) -> jid.RobotEstimate:
    robot = jid.Robot.from_urdf(path)
    return jid.identify_robot(recording(path), robot, inertia="free", model="coulomb_viscous")


def test_bodies_have_the_base_parameters(path: Path, free: jid.RobotEstimate) -> None:
    """One set of many that explain the motion alike: possible, and near the URDF's."""
    assert free.consistent is True
    assert free.impossible_by == 0.0
    assert possible(free.inertial)
    again = free.predict(recording(path))
    assert again.relative_residual == pytest.approx(free.relative_residual, rel=1e-6)
    np.testing.assert_allclose(free.inertial[:, 0], [5.0, 3.5], rtol=0.1)
    assert "impossible_inertia" not in {each.code for each in free.findings}


def torques(path: Path) -> tuple[Array, Array, Array, Array]:
    import pinocchio

    model = pinocchio.buildModelFromUrdf(str(path))
    state = model.createData()
    rng = np.random.default_rng(3)
    q, v, a = rng.uniform(-1.0, 1.0, (3, 40, 2)) * np.array([[[2.0]], [[2.0]], [[8.0]]])
    found = [pinocchio.rnea(model, state, *each) for each in zip(q, v, a, strict=True)]
    return q, v, a, np.array(found)


def test_the_urdf_gets_inertia_that_pinocchio_moves_alike(
    path: Path, free: jid.RobotEstimate, tmp_path: Path
) -> None:
    """Its torques with friction are the arm's own: Newton's law of the file that was written."""
    target = jid.export(free, tmp_path / "out.urdf", into=path, inertia=True)
    _, v, a, links = torques(target)
    rotors = [
        joint.parameters["rotor_inertia"].value if "rotor_inertia" in joint.parameters else 0.0
        for joint in free.joints.values()
    ]
    offset = [joint.parameters["torque_offset"].value for joint in free.joints.values()]
    told = links + np.array(rotors) * a + free.friction(v) + np.array(offset)
    _, _, _, true = torques(path)
    true = true + ROTOR * a + COULOMB * np.sign(v) + VISCOUS * v
    np.testing.assert_allclose(told, true, atol=0.02 * np.abs(true).max())
    text = target.read_text(encoding="utf-8")
    assert text.count("<inertial>") == 2  # the flange is part of the lower link
    again = jid.export(free, tmp_path / "again.urdf", into=target, inertia=True)
    assert again.read_bytes() == target.read_bytes()


def test_scaled_inertia_is_written(path: Path, tmp_path: Path) -> None:
    robot = jid.Robot.from_urdf(path, rotor_inertias=list(ROTOR))
    found = jid.identify_robot(recording(path), robot, inertia="scaled", model="coulomb_viscous")
    target = jid.export(found, tmp_path / "out.urdf", into=path, inertia=True)
    again = jid.Robot.from_urdf(target)
    np.testing.assert_allclose(again.tree.inertias, found.inertial, atol=1e-9)


def test_inertia_that_cannot_be_written_is_refused(
    path: Path, free: jid.RobotEstimate, tmp_path: Path
) -> None:
    target = tmp_path / "out.urdf"
    known = jid.identify_robot(recording(path), jid.Robot.from_urdf(path), model="coulomb_viscous")
    with pytest.raises(jid.InputError, match="values are those of the URDF"):
        jid.export(known, target, into=path, inertia=True)
    more = urdf(tmp_path, URDF.replace("</robot>", FLANGE.replace('"fixed"', '"continuous"')))
    with pytest.raises(jid.InputError, match="flange_joint"):
        jid.export(free, target, into=more, inertia=True)
    assert not target.exists()


def test_motors_too_heavy_leave_links_that_cannot_be(path: Path, tmp_path: Path) -> None:
    """A given inertia of motors above that of motor and arm together: the rest is below 0."""
    robot = jid.Robot.from_urdf(path, rotor_inertias=[4.0, 2.0])
    run = recording(path, duration=6.0)
    found = jid.identify_robot(run, robot, inertia="free", model="coulomb_viscous")
    assert found.consistent is False
    assert found.impossible_by > 10.0
    told = next(each for each in found.findings if each.code == "impossible_inertia")
    assert "standard errors" in told.cause
    with pytest.raises(jid.InputError, match="impossible for rigid bodies"):
        jid.export(found, tmp_path / "out.urdf", into=path, inertia=True)
    # What explains the torque is kept.
    assert found.predict(run).relative_residual == pytest.approx(found.relative_residual, rel=1e-6)


def test_the_distance_is_in_standard_errors() -> None:
    """Of a ball, only the mass is known, and it is said to be negative: nothing is the nearest."""
    mass = np.eye(10)[:1]
    for error, chance in ((0.1, False), (1.0, True)):
        found = nearest_possible(
            np.array([-1.0]), mass, np.array([[error**-2]]), BALL[None], NO_DISCS
        )
        assert found.distance == pytest.approx(1.0 / error, rel=0.05)
        assert found.by_chance is chance
        assert possible(found.inertial)
        assert found.inertial[0, 0] == pytest.approx(0.0, abs=0.05)


def test_many_bodies_with_exactly_the_base_parameters() -> None:
    """Half of the combinations of random links: bodies have them, and others than the URDF's are found."""
    rng = np.random.default_rng(0)
    for _ in range(20):
        base = rng.normal(size=(5, 10))
        turned = BALL * np.array([rng.uniform(0.5, 2.0)] * 10)
        found = nearest_possible(base @ turned, base, 1e6 * np.eye(5), BALL[None], NO_DISCS)
        assert found.distance == 0.0
        assert possible(found.inertial)
        np.testing.assert_allclose(base @ found.inertial[0], base @ turned, atol=1e-9)


def test_a_link_without_mass_in_the_urdf_gets_some() -> None:
    nothing = np.zeros((1, 10))
    base = np.eye(10)[:4]
    both = np.vstack([BALL[None], nothing])
    wide = np.hstack([np.zeros((4, 10)), base])
    wanted = np.array([0.3, 0.003, 0.0, 0.0])
    found = nearest_possible(wanted, wide, 1e4 * np.eye(4), both, np.zeros((20, 0)))
    assert found.distance < 0.1
    assert possible(found.inertial)
    np.testing.assert_allclose(found.inertial[1, :4], wanted, atol=1e-3)


def test_a_motor_is_a_disc_on_its_joint() -> None:
    """Inertia that a thin link cannot have: the motor has it, and the link's mass stays."""
    thin = np.array([2.0, 0, 0, 0, 0.1, 0, 0.1, 0, 0, 1e-3])
    disc = np.zeros((10, 1))
    disc[[4, 6, 9], 0] = 0.5, 0.5, 1.0
    about = np.eye(10)[9:]
    found = nearest_possible(np.array([2.0]), about, np.array([[1e4]]), thin[None], disc)
    assert found.distance == 0.0
    assert found.inertial[0, 0] == pytest.approx(2.0, rel=0.05)
