"""Gains of a bench file follow from inertia and period; stated ones that are too high are named with those that fit."""

from pathlib import Path

import pytest

import jointid as jid
from jointid.hardware.session.gains import doubt_of_gains
from jointid.hardware.session.moving_joint import MovingJoint
from jointid.hardware.session.stop import SessionStoppedError

EXAMPLE = Path(__file__).resolve().parents[2] / "examples" / "hardware" / "joint.toml"
SMALL = """\
schema = 1
name = "small joint"
drive = { rotor_inertia = 2.716e-4, gear_ratio = 9, torque_constant = 0.15, torque_hold = "zoh" }
model = { friction = "coulomb_viscous", gravity = "none" }
link = { mass = 0.05, centre_of_mass = 0.1, inertia = 0.002, angle = -1.5707963267948966, gravity = 9.81 }
parameters = { coulomb = 0.8, viscous = 0.05 }
limits = { position = [-1.4, 1.4], velocity = 10.0, torque = 40.0 }
[session]
period = PERIOD
drive = { counts_per_turn = 90000, heartbeat = 0.065 }
torque = { source = "none" }
trajectory = { form = "thesis", amplitude = "60deg", cycle = 3.0, duration = 3.0 }
controller = { law = "LAW" }
emulated = { truth = { coulomb = 0.7, viscous = 0.06 } }
"""


def small(folder: Path, period: float, law: str = "adaptive_robust") -> jid.hardware.Bench:
    """A joint of 0.024 kg·m² and 40 N·m, of whose gains nothing is stated."""
    path = folder / "small.toml"
    path.write_text(SMALL.replace("PERIOD", str(period)).replace("LAW", law), encoding="utf-8")
    return jid.hardware.Bench.load(path)


def example(folder: Path, period: float, gains: str = "") -> jid.hardware.Bench:
    text = EXAMPLE.read_text(encoding="utf-8").replace("duration = 12.0", "duration = 3.0", 1)
    text = text.replace("period = 0.002 ", f"period = {period} ", 1)
    text = text.replace("heartbeat = 0.05 ", "heartbeat = 0.065 ", 1)
    path = folder / "joint.toml"
    path.write_text(text.replace("[session.limits]", f"{gains}\n[session.limits]", 1))
    return jid.hardware.Bench.load(path)


def run(bench: jid.hardware.Bench) -> jid.Recording | None:
    with jid.hardware.open_drive(bench, emulate=True) as drive:
        return jid.hardware.Session(
            drive, bench.controller, bench.trajectory, bench.limits, options=bench.options
        ).run()


@pytest.mark.parametrize("period", [0.002, 0.01, 0.02])
def test_a_small_joint_is_moved_with_the_gains_that_fit(tmp_path: Path, period: float) -> None:
    assert run(small(tmp_path, period)) is not None


@pytest.mark.parametrize("law", ["pd", "pid", "compensated_pid", "lugre_observer"])
def test_each_law_has_gains_that_fit(tmp_path: Path, law: str) -> None:
    assert run(small(tmp_path, 0.01, law)) is not None


@pytest.mark.parametrize("period", [0.01, 0.02])
def test_the_example_is_moved_at_a_slow_period(tmp_path: Path, period: float) -> None:
    assert run(example(tmp_path, period)) is not None


def test_the_example_keeps_the_gains_of_the_thesis(tmp_path: Path) -> None:
    law, table = example(tmp_path, 0.002).controller.asdict(), jid.AdaptiveRobust().asdict()
    for name in ("bandwidth", "boundary", "robust_torque"):
        assert law[name] == table[name]


def test_gains_that_are_too_high_are_named_with_those_that_fit(tmp_path: Path) -> None:
    bench = example(tmp_path, 0.01, "bandwidth = 80.0")
    assert bench.controller.asdict()["boundary"] == jid.AdaptiveRobust().boundary
    with pytest.raises(SessionStoppedError) as stopped:
        run(bench)
    assert stopped.value.stop.limit == "saturated_samples"
    proposed = "bandwidth = 25, boundary = 0.04"
    assert "gains times period" in str(stopped.value)
    assert proposed in str(stopped.value)
    (remark,) = (
        each
        for each in jid.hardware.check_bench(bench, emulate=True).remarks
        if each.startswith("the gains")
    )
    assert proposed in remark
    pasted = remark.rpartition(": ")[2].replace(", ", "\n")
    assert run(example(tmp_path, 0.01, pasted)) is not None


def test_without_an_inertia_nothing_is_said_of_gains() -> None:
    assert doubt_of_gains(jid.Pd(stiffness=1e9, damping=1e9), None, 0.02) == ""
    assert doubt_of_gains(jid.OpenLoop(), MovingJoint(inertia=1.0), 0.02) == ""
    assert "stiffness" in doubt_of_gains(jid.Pd(damping=1e3), MovingJoint(inertia=1.0), 0.02)
