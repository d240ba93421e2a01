"""Columns in another order, and one gear ratio taken for all joints, are the one finding, with the order or factors."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray
from simulated_arm import JOINTS, URDF

import jointid as jid
from jointid.robot import examining
from jointid.robot.links.inertia_modes import Inertia

pinocchio = pytest.importorskip("pinocchio")

Array = NDArray[np.float64]
NAMES = tuple(f"joint_{number}" for number in range(1, JOINTS + 1))

DRIVE: dict[str, Any] = {
    "kp": np.geomspace(300.0, 100.0, JOINTS),
    "kd": np.geomspace(9.0, 3.0, JOINTS),
    "hold": "linear",
    "delay": 0.0,
}


@pytest.fixture(name="run", scope="module")
def _run() -> jid.RobotRecording:
    return sines(12.0)


def sines(duration: float) -> jid.RobotRecording:
    """Exact torques along sines, with friction, rotors and noise."""
    rng = np.random.default_rng(5)
    model = pinocchio.buildModelFromUrdf(str(URDF))
    state, time = model.createData(), np.arange(0.0, duration, 4e-3)
    rates = rng.uniform(0.6, 5.0, (JOINTS, 4))
    sizes = rng.uniform(0.3, 0.8, (JOINTS, 4)) / rates
    angle = rates[:, :, None] * time + rng.uniform(0.0, 6.0, (JOINTS, 4, 1))
    q, v, a = (
        np.einsum("jk,jkn->nj", sizes * rates**order, wave)
        for order, wave in enumerate((np.sin(angle), np.cos(angle), -np.sin(angle)))
    )
    links = np.array([pinocchio.rnea(model, state, *each) for each in zip(q, v, a, strict=True)])
    coulomb, viscous, rotor = (size * np.geomspace(8.0, 2.0, JOINTS) for size in (1.0, 1.2, 0.1))
    torque = links + rotor * a + coulomb * np.sign(v) + viscous * v
    torque += rng.normal(0.0, 0.02, torque.shape)
    return jid.RobotRecording(time=time, position=q, torque=torque, names=NAMES)


def changed(run: jid.RobotRecording, **signals: Any) -> jid.RobotRecording:
    return jid.RobotRecording(**{**run.fields(), **signals})


def in_order(run: jid.RobotRecording, order: list[int], *signals: str) -> jid.RobotRecording:
    fields = run.fields()
    return changed(run, **{name: np.array(fields[name])[:, order] for name in signals})


def only(found: jid.RobotEstimate, code: str) -> Any:
    assert [(each.code, each.severity) for each in found.warnings] == [(code, "blocking")]
    assert found.verdict.level == "not usable"
    return found.warnings[0]


@pytest.mark.parametrize("inertia", ["urdf", "free"])
@pytest.mark.parametrize(
    ("order", "code"),
    [
        ([1, 0, 2, 3, 4, 5, 6], "swapped_torques"),
        ([0, 3, 1, 2, 4, 5, 6], "joint_order"),
        ([6, 5, 4, 3, 2, 1, 0], "joint_order"),
        ([2, 1, 0, 3, 4, 6, 5], "joint_order"),
    ],
)
def test_torques_in_another_order_are_named(
    run: jid.RobotRecording,
    order: list[int],
    code: str,
    inertia: Inertia,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    def tried(*_: object) -> None:
        raise AssertionError("a delay or a fact was tried")

    for name in ("with_better_velocities", "diagnosed"):
        monkeypatch.setattr(examining, name, tried)
    found = jid.identify(in_order(run, order, "torque"), jid.Robot.from_urdf(URDF), inertia=inertia)
    said = only(found, code)
    right = ", ".join(NAMES[place] for place in np.argsort(order))
    assert said.advice[0].text.endswith(f"the right order of the torques is {right}")
    for place, column in enumerate(order):
        moved = f"the torques of {NAMES[place]} hold the values of {NAMES[column]}"
        assert (moved in said.details) == (place != column)


@pytest.mark.parametrize(
    ("order", "code"),
    [
        pytest.param([0, 2, 1, 3, 4, 5, 6], "swapped_joints", marks=pytest.mark.slow),
        ([2, 1, 0, 3, 4, 5, 6], "swapped_joints"),
        pytest.param([2, 0, 1, 3, 4, 5, 6], "joint_order", marks=pytest.mark.slow),
    ],
)
def test_joints_in_another_order_are_named_with_the_call(
    run: jid.RobotRecording, order: list[int], code: str
) -> None:
    wrong = in_order(run, order, "position", "torque")
    wrong = changed(wrong, names=[f"axis {'abcdefg'[each]}" for each in order])
    said = only(jid.identify(wrong, jid.Robot.from_urdf(URDF)), code)
    (advice,) = said.advice
    assert advice.function == "load_robot"
    assert advice.arguments["joints"] == [f"axis {each}" for each in "abcdefg"]


def test_currents_in_another_order_are_named(run: jid.RobotRecording) -> None:
    constants = np.geomspace(2.0, 0.5, JOINTS)
    amperes = changed(run, torque=None, current=np.asarray(run.torque) / constants)
    robot = jid.Robot.from_urdf(URDF, torque_constants=constants.tolist())
    wrong = in_order(amperes, [0, 1, 3, 2, 4, 5, 6], "current")
    assert (
        f"the torques of {NAMES[2]} hold the values of {NAMES[3]}"
        in only(jid.identify(wrong, robot), "swapped_torques").details
    )


@pytest.mark.parametrize(
    ("signals", "code", "what"),
    [
        (("reference",), "swapped_torques", "wanted positions"),
        (("position", "reference"), "swapped_joints", "columns"),
    ],
)
def test_columns_of_drives_in_another_order_are_named(
    run: jid.RobotRecording, signals: tuple[str, ...], code: str, what: str
) -> None:
    wrong = in_order(driven(run), [0, 1, 3, 2, 4, 5, 6], *signals)
    said = only(jid.identify(wrong, jid.Robot.from_urdf(URDF, drive=DRIVE)), code)
    assert said.title.startswith(f"the {what} of {NAMES[2]} and {NAMES[3]} are exchanged")


@pytest.mark.slow
def test_an_order_of_positions_alone_is_not_taken_for_another(run: jid.RobotRecording) -> None:
    """The torques that a drive makes of exchanged positions are no other joint's."""
    wrong = in_order(driven(run), [1, 0, 2, 3, 4, 5, 6], "position")
    found = jid.identify(wrong, jid.Robot.from_urdf(URDF, drive=DRIVE))
    assert found.verdict.level == "not usable"
    assert "swapped_joints" not in {each.code for each in found.findings}


def driven(run: jid.RobotRecording) -> jid.RobotRecording:
    """The wanted positions that make a drive push as much."""
    speed = np.gradient(run.position, run.time, axis=0)
    pushed = (run.torque + DRIVE["kd"] * speed) / DRIVE["kp"]
    return changed(run, torque=None, reference=run.position + pushed)


@pytest.mark.parametrize(
    "signals", [("torque",), pytest.param(("position", "torque"), marks=pytest.mark.slow)]
)
def test_the_order_shows_in_a_long_log_that_stands_still_at_its_ends(
    signals: tuple[str, ...],
) -> None:
    run, order = sines(60.0), [0, 3, 1, 2, 4, 5, 6]
    whole = np.arange(run.samples)
    shown = np.clip(whole, run.samples // 5, 4 * run.samples // 5)
    still = {name: np.asarray(run.fields()[name])[shown] for name in ("position", "torque")}
    wrong = in_order(changed(run, **still, extra={"row": 1.0 * whole}), order, *signals)
    if "position" in signals:
        wrong = changed(wrong, names=[*"abcdefg"])
    only(jid.identify(wrong, jid.Robot.from_urdf(URDF)), "joint_order")


@pytest.mark.parametrize("inertia", ["urdf", "free"])
@pytest.mark.parametrize(
    "factors",
    [
        [1.0, 1.0, 1.25, 1.25, 1.6, 1.6, 1.6],
        [1.0, 0.8, 0.5, 0.5, 0.7, 0.6, 0.6],
        [1.0, 1.0, 1.0, 0.6, 1.0, 1.9, 1.0],
        [1.0, -1.0, -0.7, 1.0, 1.0, 1.0, 1.0],
    ],
)
def test_one_gear_ratio_taken_for_all_is_named_with_the_factors(
    run: jid.RobotRecording, factors: list[float], inertia: Inertia
) -> None:
    wrong = changed(run, torque=np.asarray(run.torque) * factors)
    found = jid.identify(wrong, jid.Robot.from_urdf(URDF), inertia=inertia)
    (advice,) = only(found, "different_factors").advice
    assert advice.function == "Robot.from_urdf"
    np.testing.assert_allclose(advice.arguments["torque_scales"], 1.0 / np.array(factors), rtol=0.1)
    cured = jid.identify(wrong, jid.Robot.from_urdf(URDF, **advice.arguments), inertia=inertia)
    assert "different_factors" not in {each.code for each in cured.findings}


@pytest.mark.parametrize("factor", [1.2, 1.4])
def test_one_factor_of_all_is_no_factor_of_each(run: jid.RobotRecording, factor: float) -> None:
    more = driven(changed(run, torque=factor * np.asarray(run.torque)))
    found = jid.identify(more, jid.Robot.from_urdf(URDF, drive=DRIVE))
    assert "different_factors" not in {each.code for each in found.findings}


@pytest.mark.parametrize("link", [2, 5])
def test_a_heavier_link_is_no_factor(run: jid.RobotRecording, link: int) -> None:
    """All joints below it carry it: their torques seem too large, each by a share of its own."""
    model = pinocchio.buildModelFromUrdf(str(URDF))
    state, other = model.createData(), pinocchio.Model(model)
    was = model.inertias[link]
    other.inertias[link] = pinocchio.Inertia(2.0 * was.mass, was.lever, 2.0 * was.inertia)
    slope = np.gradient(run.position, run.time, axis=0)
    rows = [run.position, slope, np.gradient(slope, run.time, axis=0)]
    more = [
        pinocchio.rnea(other, state, *row) - pinocchio.rnea(model, state, *row)
        for row in zip(*rows, strict=True)
    ]
    heavier = changed(run, torque=np.asarray(run.torque) + np.array(more))
    found = jid.identify(heavier, jid.Robot.from_urdf(URDF))
    assert "different_factors" not in {each.code for each in found.findings}
