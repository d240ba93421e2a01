"""A servo's model in MuJoCo moves as our rollout of it; friction of the load is refused."""

from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from simulated_servo import Truth, bench_runs, servo_joint

import jointid as jid

mujoco: Any = pytest.importorskip("mujoco")

PLAIN = jid.Model("coulomb_viscous", load_friction=False)
LOGS = Path(__file__).resolve().parents[1] / "data" / "xl330" / "bam_xl330.csv.gz"


def replayed(path: Path, run: jid.Recording, gain: float) -> np.ndarray:
    """Position at the run's time stamps, with the position loop around MuJoCo's actuator."""
    model = mujoco.MjModel.from_xml_path(str(path))
    state = mujoco.MjData(model)
    rolled_start = float(run.position[0])
    state.qpos[0] = rolled_start
    assert run.reference is not None
    driven = run.extra["driven"]
    found = []
    for k, stamp in enumerate(run.time):
        while state.time < stamp - run.time[0] - 0.5 * model.opt.timestep:
            at = max(k - 1, 0)
            state.ctrl[0] = gain * (run.reference[at] - state.qpos[0])
            model.opt.disableactuator = 0 if driven[at] > 0.5 else 1 << 1
            mujoco.mj_step(model, state)
        found.append(float(state.qpos[0]))
    return np.array(found)


def compare(joint: jid.Joint, runs: list[jid.Recording], held: list[int], folder: Path) -> None:
    train = [run for k, run in enumerate(runs) if k not in held]
    estimate = jid.identify_servo(train, joint, model=PLAIN, draws=0)
    path = jid.export(estimate.identified, folder / "servo.xml")
    assert joint.voltage is not None
    assert joint.voltage.position_loop is not None
    ours = jid.rollout(estimate, [runs[k] for k in held])
    theirs = []
    for k in held:
        gain = joint.voltage.position_loop.gain * float(runs[k].extra["gain"][0])
        theirs.append(np.abs(replayed(path, runs[k], gain) - runs[k].position).mean())
    assert np.median(theirs) <= 1.2 * ours.median
    assert np.median(theirs) > 0.5 * ours.median


def test_the_exported_servo_replays(tmp_path: Path) -> None:
    runs = bench_runs(replace(Truth(), load_friction=0.1), seed=11)
    compare(servo_joint(supply=7.25), runs, [4, 5, 6, 7], tmp_path)


def test_the_exported_xl330_replays(tmp_path: Path) -> None:
    joint = servo_joint(supply=7.3)
    extra = {"duty": "duty", "driven": "torque_enabled", "gain": "firmware_kp"}
    runs = list(jid.load_runs(LOGS, by="run_index", extra=extra))
    compare(joint, runs, [8, 9, 10, 11], tmp_path)


def test_friction_of_the_load_is_refused(tmp_path: Path) -> None:
    runs = bench_runs(Truth(), seed=12, runs=8)
    estimate = jid.identify_servo(runs, servo_joint(supply=7.25), draws=0)
    with pytest.raises(jid.InputError, match="load friction"):
        jid.export(estimate.identified, tmp_path / "servo.xml")
    plain = jid.identify_servo(runs, servo_joint(), model=PLAIN, draws=0)
    with pytest.raises(jid.InputError, match="supply"):
        jid.export(plain.identified, tmp_path / "servo.xml")


def test_no_friction_of_the_load_is_no_loss(tmp_path: Path) -> None:
    runs = bench_runs(replace(Truth(), load_friction=0.0), seed=12, runs=8)
    plain = jid.identify_servo(runs, servo_joint(supply=7.25), model=PLAIN, draws=0)
    values = {"load_friction": 0.0, "viscous": plain["viscous"], "coulomb": plain["coulomb"]}
    model = jid.Model("coulomb_viscous", load_friction=True)
    joint = plain.identified.replace(model=model).with_parameters(values)
    path = jid.export(joint, tmp_path / "servo.xml")
    assert "frictionloss" in Path(path).read_text()


def test_the_numbers_are_in_the_simulator(tmp_path: Path) -> None:
    runs = bench_runs(Truth(), seed=13, runs=8)
    found = jid.identify_servo(runs, servo_joint(supply=7.25), model=PLAIN, draws=0)
    model = mujoco.MjModel.from_xml_path(str(jid.export(found.identified, tmp_path / "servo.xml")))
    assert model.actuator_gainprm[0, 0] == pytest.approx(7.25 * found["torque_per_voltage"])
    assert model.actuator_biasprm[0, 2] == pytest.approx(-found["back_emf"])
    assert model.dof_damping[0] == pytest.approx(found["viscous"])
    assert model.dof_frictionloss[0] == pytest.approx(found["coulomb"])
