"""Exported MuJoCo models: the numbers are in the simulator, and the joint moves in it as in ours."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import numpy as np
import pytest
from exported_joints import EVERYTHING, LOADED, SLIDING, THESIS, shipped_estimate

import jointid as jid
from jointid.exports.subject import subject_of

mujoco: Any = pytest.importorskip("mujoco")

BEHIND_SENSOR = THESIS.replace(
    name="behind a sensor",
    model="coulomb_viscous",
    parameters={
        name: each for name, each in THESIS.parameters.items() if name not in ("static", "stribeck")
    },
)
PENDULUM = jid.Joint(
    name="pendulum",
    gear_ratio=50.0,
    inertia=1.3,
    model=jid.Model("coulomb_viscous", gravity="free"),
).with_parameters(
    {"coulomb": 5.0, "viscous": 3.0, "gravity_cos": 6.0, "gravity_sin": -2.0, "torque_offset": 1.0}
)
CARRIAGE = SLIDING.replace(name="carriage", link=jid.Link(mass=0.1, centre_of_mass=0.0))
REPLAYED = {
    "loaded": (LOADED, 400.0, 40.0),
    "behind a sensor": (BEHIND_SENSOR, 8000.0, 400.0),
    "pendulum": (PENDULUM, 800.0, 80.0),
    "sliding": (SLIDING, 8000.0, 800.0),
    "carriage": (CARRIAGE, 8000.0, 800.0),
}


def model_of(path: Path) -> Any:
    return mujoco.MjModel.from_xml_path(str(path))


def inverse(model: Any, state: Any, position: float, velocity: float, acceleration: float) -> float:
    """The force that MuJoCo says the joint needs."""
    state.qpos[0], state.qvel[0], state.qacc[0] = position, velocity, acceleration
    mujoco.mj_inverse(model, state)
    return float(state.qfrc_inverse[0])


@pytest.mark.parametrize("name", REPLAYED)
def test_a_motion_replays(tmp_path: Path, name: str) -> None:
    joint, stiffness, damping = REPLAYED[name]
    trajectory = jid.Trajectory.sine(amplitude=0.3, frequency=0.5, duration=4.0)
    ours = jid.simulate(joint, jid.Pd(stiffness=stiffness, damping=damping), trajectory)
    torque = ours.torque
    assert torque is not None
    signals = ours.truth.signals
    position, velocity = signals["position"], signals["velocity"]
    model = model_of(jid.export(joint, tmp_path / "joint.xml"))

    # The torque that our motion needs there; the acceleration is that of the torque held until then.
    offset = joint.parameters.get("torque_offset")
    constant = 0.0 if offset is None or offset.value is None else offset.value
    state = mujoco.MjData(model)
    moves = np.flatnonzero(np.abs(velocity[1:]) > 0.01) + 1
    needed = np.array(
        [inverse(model, state, position[k], velocity[k], signals["acceleration"][k]) for k in moves]
    )
    missed = needed + constant - torque[moves - 1]
    assert np.sqrt(np.mean(missed**2)) < 1e-4 * np.sqrt(np.mean(torque**2))

    # The motion that our torque makes there.
    mujoco.mj_resetData(model, state)
    state.qpos[0], state.qvel[0] = position[0], velocity[0]
    steps = round(1e-3 / model.opt.timestep)
    there = np.empty((len(torque), 2))
    for k, command in enumerate(torque):
        there[k] = state.qpos[0], state.qvel[0]
        state.ctrl[0] = command / joint.gear_ratio
        for _ in range(steps):
            mujoco.mj_step(model, state)
    assert np.sqrt(np.mean((there[:, 1] - velocity) ** 2)) < 0.01 * np.sqrt(np.mean(velocity**2))
    assert np.max(np.abs(there[:, 0] - position)) < 0.02 * np.ptp(position)


def test_the_numbers_are_in_the_simulator(tmp_path: Path) -> None:
    """Not in the file alone."""
    model = model_of(jid.export(LOADED, tmp_path / "joint.xml"))
    assert model.dof_damping[0] == 1.7
    assert model.dof_frictionloss[0] == 3.1
    # Without a sensor, the inertia is the drive's and the link's together.
    assert model.dof_armature[0] == pytest.approx(0.2, rel=1e-12)
    assert model.actuator_gear[0, 0] == -100.0
    assert model.actuator_ctrlrange[0] == pytest.approx([-0.6, 0.6])
    assert model.jnt_range[0] == pytest.approx([-2.0, 2.0])
    assert model.jnt_limited[0]
    state = mujoco.MjData(model)
    mujoco.mj_forward(model, state)
    full = np.empty((1, 1))
    try:
        mujoco.mj_fullM(model, state, full)
    except TypeError:  # before MuJoCo 4
        mujoco.mj_fullM(model, full, state.qM)
    assert full[0, 0] == pytest.approx(LOADED.known_inertia)


def test_what_mujoco_cannot_express_is_refused_by_name(tmp_path: Path) -> None:
    path = tmp_path / "joint.xml"
    with pytest.raises(jid.InputError, match="only Coulomb and viscous friction") as refused:
        jid.export(EVERYTHING, path, speed=1.0)
    for lost in ("Stribeck", "two directions", "load friction", "motor's angle", "joint's angle"):
        assert lost in refused.value.reason
    assert not path.exists()
    with pytest.raises(jid.InputError, match="Stribeck"):
        jid.export(shipped_estimate(), path)


@pytest.mark.parametrize("joint", [THESIS, EVERYTHING], ids=["thesis", "everything"])
def test_an_approximation_says_how_far_it_is_off(tmp_path: Path, joint: jid.Joint) -> None:
    path = jid.export(joint, tmp_path / "joint.xml", approximate=True, speed=0.8)
    text = path.read_text(encoding="utf-8")
    model = model_of(path)
    assert "lost: Stribeck friction" in text
    stated = re.search(r"largest difference of the torque over this range: ([\d.]+) N·m", text)
    assert stated is not None
    law = subject_of(joint).law
    half = (np.arange(4000) + 0.5) / 4000 * 0.8
    speed = np.concatenate([half, -half])
    columns = np.column_stack([np.sign(speed), speed])
    constant, slope = np.linalg.lstsq(columns, law.friction_torque(speed), rcond=None)[0]
    assert model.dof_frictionloss[0] == pytest.approx(constant, rel=1e-3)
    assert model.dof_damping[0] == pytest.approx(slope, rel=1e-3)
    tried = np.concatenate([speed, [1e-9, -1e-9]])
    there = model.dof_frictionloss[0] * np.sign(tried) + model.dof_damping[0] * tried
    off = np.max(np.abs(law.friction_torque(tried) - there))
    periodic = sum(each.amplitude for each in law.harmonics if each.over != "gravity")
    assert off + periodic == pytest.approx(float(stated[1]), rel=1e-3)
    # And that friction is what the simulator has.
    state = mujoco.MjData(model)
    for sign in (1.0, -1.0):
        needed = inverse(model, state, 0.0, 0.4 * sign, 0.0) - inverse(model, state, 0.0, 0.0, 0.0)
        wanted = sign * (model.dof_frictionloss[0] + 0.4 * model.dof_damping[0])
        assert needed == pytest.approx(wanted, rel=1e-6)


HEAVY = jid.Joint(
    name="hip", gear_ratio=100.0, rotor_inertia=2e-4, model=jid.Model("coulomb_viscous")
).with_parameters({"coulomb": 300.0, "viscous": 20.0, "inertia": 4.0})
LEG = """<mujoco><option timestep="0.0005" gravity="0 0 0"/><worldbody><body name="leg">
  <inertial pos="0 0 0" mass="1" diaginertia="2 2 2"/><joint name="hip" axis="0 -1 0"/>
</body></worldbody></mujoco>
"""


@pytest.mark.parametrize("edited", [False, True], ids=["alone", "into"])
def test_a_joint_replays_its_torque_and_holds(tmp_path: Path, edited: bool) -> None:
    """MuJoCo's own softness makes 300 N·m of dry friction creep at 0.08 rad/s, which nobody asked for."""
    source = tmp_path / "leg.xml"
    source.write_text(LEG, encoding="utf-8")
    path = jid.export(HEAVY, tmp_path / "new.xml", into=source if edited else None)
    model = model_of(path)
    state = mujoco.MjData(model)
    state.qfrc_applied[0] = 290.0  # just below what moves it
    for _ in range(2000):
        mujoco.mj_step(model, state)
    assert 0.0 < state.qvel[0] < 1e-3
    # Both files say at which speed friction fades, and it does there.
    stated = re.search(r"below about ([-\d.e]+) rad/s", path.read_text(encoding="utf-8"))
    assert stated is not None
    assert float(stated[1]) == pytest.approx(300.0 / 290.0 * state.qvel[0], rel=0.1)
    # The law's torque, and what it takes to follow the motion that belongs to it.
    mujoco.mj_resetData(model, state)
    state.qvel[0] = 0.3
    missed, law = [], []
    for k in range(10_000):
        at = k * model.opt.timestep
        q, v, a = 0.3 * np.sin(at), 0.3 * np.cos(at), -0.3 * np.sin(at)
        law.append(4.0 * a + 300.0 * np.sign(v) + 20.0 * v)
        missed.append(5e4 * (q - state.qpos[0]) + 2e3 * (v - state.qvel[0]))
        state.qfrc_applied[0] = law[-1] + missed[-1]
        mujoco.mj_step(model, state)
    assert np.sqrt(np.mean(np.square(missed))) < 0.01 * np.sqrt(np.mean(np.square(law)))


@pytest.mark.parametrize("name", REPLAYED)
def test_friction_is_whole_above_the_speed_that_the_file_states(tmp_path: Path, name: str) -> None:
    """MuJoCo softens dry friction, of a joint that slides by its body's mass alone."""
    joint = REPLAYED[name][0]
    path = jid.export(joint, tmp_path / "joint.xml")
    stated = re.search(r"below about ([-\d.e]+)", path.read_text(encoding="utf-8"))
    assert stated is not None
    model = model_of(path)
    state = mujoco.MjData(model)
    for share, whole in ((1.1, True), (0.3, False)):
        inverse(model, state, 0.0, share * float(stated[1]), 0.0)
        friction = -state.qfrc_constraint[0] / model.dof_frictionloss[0]
        assert (friction == pytest.approx(1.0, rel=1e-6)) == whole
        assert friction > 0.2


@pytest.mark.parametrize("ending", [".xml", ".urdf"])
def test_the_file_is_sound_xml_whatever_the_joint_is_called(tmp_path: Path, ending: str) -> None:
    """MuJoCo's reader forgives two dashes in a comment, others do not."""
    path = jid.export(EVERYTHING, tmp_path / f"j{ending}", approximate=True, speed=1.0)
    root = ElementTree.parse(path).getroot()
    # Names that other tools take; the joint's own stands in the comment.
    names = [each.get("name") for each in root.iter()] + [root.get("model")]
    known = [name for name in names if name is not None]
    assert "joint_1_a_joint_link" in known
    assert all(re.fullmatch("[A-Za-z][A-Za-z0-9_]*", name) for name in known)
    assert "1: \u00e4 */ joint" in path.read_text(encoding="utf-8")


ARM = """<?xml version="1.0" encoding="utf-8"?>
<!-- an arm of ours -->
<mujoco model="arm">
  <default><joint damping="0.5" frictionloss="9"/></default>
  <worldbody>
    <body name="upper">
      <!-- keep   this -->
      <joint
          name='shoulder'   type="hinge" axis="0 1 0"
          damping = '1' />
      <geom type="capsule" size=".05 .2" mass="2"/>
      <body name="lower" pos="0 0 .4">
        <joint name="elbow" axis="0 1 0"/>
        <geom type="capsule" size=".05 .2" mass="1"/>
      </body>
    </body>
  </worldbody>
  <equality><joint name="shoulder" joint1="elbow" active="false"/></equality>
</mujoco>
"""


@pytest.mark.parametrize("newline", ["\n", "\r\n"])
def test_a_joint_of_a_model_is_edited_in_place(tmp_path: Path, newline: str) -> None:
    path = tmp_path / "arm.xml"
    before = ARM.replace("\n", newline).encode()
    path.write_bytes(before)
    jid.export(LOADED, path, into=path, joint_name="shoulder")
    after = path.read_bytes()
    model = model_of(path)
    assert model.dof_damping.tolist() == [1.7, 0.5]
    assert model.dof_frictionloss.tolist() == [3.1, 9.0]
    assert model.dof_armature[0] == pytest.approx(0.2)
    # All but our comment and five values has its bytes.
    plain = re.sub(rb" *<!-- jointid:.*?-->\r?\n", b"", after, flags=re.DOTALL)
    values = rb" (frictionloss|armature|sol(ref|imp)friction)=\"[\d. ]+\""
    assert re.sub(values, b"", plain) == re.sub(values, b"", before).replace(b"'1'", b'"1.7"')
    assert (newline == "\r\n") == (b"\r\n" in after)
    assert after.count(b"\n") == after.count(newline.encode())
    # Once more changes nothing: the old comment is replaced.
    jid.export(LOADED, path, into=path, joint_name="shoulder")
    assert path.read_bytes() == after


def test_the_armature_is_kept_where_the_links_inertia_is_in_it(tmp_path: Path) -> None:
    source = tmp_path / "arm.xml"
    source.write_text(ARM.replace("damping = '1'", "armature='0.07'"), encoding="utf-8")
    joint = jid.Joint(name="elbow", model=jid.Model("coulomb_viscous")).with_parameters(
        {"inertia": 3.0, "coulomb": 1.0, "viscous": 2.0}
    )
    text = jid.export(joint, tmp_path / "new.xml", into=source, joint_name="shoulder").read_text(
        "utf-8"
    )
    assert model_of(tmp_path / "new.xml").dof_armature[0] == 0.07
    assert "armature is unchanged" in text
    assert "new.xml" not in source.read_text(encoding="utf-8")
    # Without a name, the joint's own is meant.
    jid.export(joint, tmp_path / "own.xml", into=source)
    assert model_of(tmp_path / "own.xml").dof_damping.tolist() == [0.5, 2.0]
