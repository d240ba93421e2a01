"""A joint that would leave its window is braked before its motor goes off; one that does not obey is not."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from session_bench import JOINT, PERIOD, TRUE, devices, limits, session

import jointid as jid
from jointid.hardware import EmulatedBus, SessionStoppedError
from jointid.hardware.elmo import EmulatedElmo
from jointid.hardware.elmo.drive import ElmoDrive
from jointid.hardware.elmo.emulated_converter import EmulatedConverter
from jointid.hardware.emulated.faults import BusFault
from jointid.hardware.session.foresight import Foresight
from jointid.hardware.session.limits import SessionLimits
from jointid.hardware.session.moving_joint import MovingJoint
from jointid.hardware.session.session import Session, SessionOptions
from jointid.hardware.session.stop import LimitError
from jointid.simulation.stepped import stepped_joint

EDGE = 0.5  # rad
POSITION = 0x4FF  # identifier of the drive's samples
LIGHT = {"coulomb": 3.0, "static": 0.0, "viscous": 0.1}


def pushed(
    friction: dict[str, float], torque: float, **changes: Any
) -> tuple[SessionStoppedError, float, float, EmulatedElmo]:
    """A constant torque drives the joint to its window's edge; returns how far it went and where it rests."""
    true = changes.pop("true", TRUE).with_parameters(friction)
    elmo = EmulatedElmo(
        stepped_joint(true, sensors=jid.Sensors(torque_noise=0.5), period=PERIOD, seed=0)
    )
    faults = changes.pop("faults", ())
    with EmulatedBus(elmo, EmulatedConverter(elmo), faults=faults) as bus:
        run = Session(
            ElmoDrive(bus, changes.pop("joint", JOINT)),
            jid.OpenLoop(),
            jid.Trajectory.step(torque, duration=3.0),
            limits(
                position=(-1.0, EDGE),
                saturated_samples=10**6,
                velocity=10.0,
                watchdog_travel=10.0,
                **changes,
            ),
            options=SessionOptions(settle=0.05),
        )
        with pytest.raises(SessionStoppedError) as caught:
            run.run()
        farthest = elmo.joint.position
        for _ in range(1000):
            bus.sleep_until(bus.now() + PERIOD)
            elmo.advance()
            farthest = max(farthest, elmo.joint.position)
    return caught.value, farthest, elmo.joint.position, elmo


@pytest.mark.parametrize("friction", [{}, LIGHT], ids=["thesis", "light"])
@pytest.mark.parametrize("torque", [60.0, 110.0, 159.0])
def test_a_fast_approach_ends_inside_the_window(friction: dict[str, float], torque: float) -> None:
    stopped, farthest, rests, elmo = pushed(friction, torque)
    assert stopped.stop.limit == "position"
    assert "even immediate braking would stop" in stopped.stop.message
    assert stopped.recording is not None
    braked = stopped.recording.metadata["braked"]
    if torque > 60.0:
        assert braked["velocity"] > 2.5
    if torque == 159.0:
        assert braked["velocity"] >= 4.0
    assert farthest < EDGE + math.radians(1.0)
    assert rests < EDGE + math.radians(1.0)
    assert farthest > EDGE - math.radians(6.0)  # and not far before it either
    assert not elmo.motor_on


@pytest.mark.parametrize("friction", [{}, LIGHT], ids=["thesis", "light"])
def test_samples_lost_near_the_edge_move_it_no_farther(friction: dict[str, float]) -> None:
    """Four in a row are tolerated, five are not; wherever they begin, the joint rests at most 1 degree beyond."""
    stopped, _, _, elmo = pushed(friction, 159.0)
    assert stopped.recording is not None
    at_edge = elmo.switchings[-1][0] - stopped.recording.metadata["braked"]["time"]
    stops = set()
    for lost in (4, 5):
        for cycles in (-7, -5, -4, -3, -2, -1, 0, 1):
            begin = at_edge + (cycles - 0.5) * PERIOD
            silent = BusFault(
                kind="drop", start=begin, stop=begin + lost * PERIOD, identifier=POSITION
            )
            stopped, farthest, rests, elmo = pushed(friction, 159.0, faults=(silent,))
            assert stopped.recording is not None
            braked = stopped.recording.metadata["braked"]
            assert braked["velocity"] >= 3.5
            assert braked["left"] < 0.1
            assert max(farthest, rests) < EDGE + math.radians(1.0)
            assert not elmo.motor_on
            stops.add(stopped.stop.limit)
    assert "position" in stops


@pytest.mark.parametrize("friction", [{}, LIGHT], ids=["thesis", "light"])
def test_behind_a_burst_of_lost_samples_it_is_braked(friction: dict[str, float]) -> None:
    _, _, _, elmo = pushed(friction, 159.0)
    begin = elmo.switchings[-1][0] - 0.15
    silent = BusFault(kind="drop", start=begin, stop=begin + 5 * PERIOD, identifier=POSITION)
    stopped, farthest, rests, elmo = pushed(friction, 159.0, faults=(silent,))
    assert stopped.stop.limit == "late_samples"
    assert stopped.recording is not None
    assert stopped.recording.metadata["braked"]["left"] < 0.1
    assert stopped.recording.metadata["braked"]["velocity"] > 1.0
    assert stopped.recording.metadata["braked"]["samples"] > 10
    assert max(farthest, rests) < EDGE


def test_a_joint_that_is_no_longer_seen_is_braked_for_some_cycles_only() -> None:
    _, _, _, elmo = pushed(LIGHT, 159.0)
    begin = elmo.switchings[-1][0] - 0.15
    silent = BusFault(kind="drop", start=begin, identifier=POSITION)
    stopped, _, _, elmo = pushed(LIGHT, 159.0, faults=(silent,))
    assert stopped.stop.limit == "late_samples"
    assert stopped.recording is not None
    braked = stopped.recording.metadata["braked"]
    assert braked["samples"] == 0
    assert braked["left"] < braked["velocity"] - 0.5
    assert braked["time"] < 11 * PERIOD
    assert elmo.switchings[-1][0] - begin < 18 * PERIOD


@pytest.mark.parametrize("factor", [3.0, 10.0])
def test_a_joint_heavier_than_stated_is_braked_to_rest(factor: float) -> None:
    assert TRUE.rotor_inertia is not None
    heavy = TRUE.replace(rotor_inertia=factor * TRUE.rotor_inertia)
    stopped, _, _, elmo = pushed(LIGHT, 110.0, true=heavy)
    assert stopped.recording is not None
    braked = stopped.recording.metadata["braked"]
    assert braked["velocity"] > 1.0
    assert braked["left"] < 0.1
    assert not elmo.motor_on


def test_without_a_known_inertia_the_window_is_watched_as_before() -> None:
    unknown = JOINT.replace(rotor_inertia=None, parameters={"coulomb": 25.0})
    assert MovingJoint.of(unknown) is None
    stopped, farthest, _, _ = pushed(LIGHT, 110.0, joint=unknown)
    assert "outside" in stopped.stop.message
    assert "braked" not in stopped.stop.message
    assert stopped.recording is not None
    assert "braked" not in stopped.recording.metadata
    assert farthest > EDGE


def test_a_joint_that_gets_faster_is_not_braked_for_long() -> None:
    elmo, converter = devices(seed=1)
    with EmulatedBus(elmo, converter) as bus:

        def reverse() -> None:
            elmo.stage_gain = -1.0
            elmo.slipped_counts = 2000  # ends the run: tracking error

        bus.at(1.0, reverse)
        wide = limits(torque_difference=1e3, measured_torque=1e3, tracking_error=0.01)
        with pytest.raises(SessionStoppedError) as caught:
            session(bus, limits=wide).run()
    assert caught.value.recording is not None
    braked = caught.value.recording.metadata["braked"]
    assert braked["time"] <= 8 * PERIOD
    assert not elmo.motor_on


def foresight(**changes: Any) -> Foresight:
    """Of a joint of 2 kg·m² without weight."""
    joint = MovingJoint(inertia=2.0, dry=10.0, growing=(("viscous", 5.0),))
    within: dict[str, Any] = {"position": (-1.0, 1.0), "torque": 100.0} | changes
    return Foresight(SessionLimits(**within), PERIOD, joint, 0.0)


def test_where_it_would_stop_is_compared_with_the_nearer_edge() -> None:
    ahead = foresight()  # 45 rad/s²
    distance = 2.0 * 4e-3 + 4.0 / 90.0
    for sign in (1.0, -1.0):
        ahead.moving(sign * (0.999 - distance), sign * 2.0, 0.0)
        ahead.moving(sign * 0.99, -sign * 2.0, 0.0)  # it comes back
        with pytest.raises(LimitError) as stopped:
            ahead.moving(sign * (1.001 - distance), sign * 2.0, 0.0)
        assert stopped.value.limit == "position"
        assert stopped.value.allowed == sign
        with pytest.raises(LimitError):  # until braking acts, the torque may still drive it
            ahead.moving(sign * (0.999 - distance), sign * 2.0, sign * 100.0)


def driven(ahead: Foresight, sign: float, cycles: int) -> int:
    """A joint of 2 kg·m² without friction that 20 N·m drive the right or the wrong way; cycles until a stop."""
    position = velocity = 0.0
    for cycle in range(cycles):
        try:
            ahead.driven(position, velocity, 20.0)
        except LimitError as error:
            return cycle if error.limit == "torque_sign" else -1
        velocity += sign * 10.0 * PERIOD
        position += velocity * PERIOD
    return cycles


def test_energy_from_nowhere_is_a_wrong_sign() -> None:
    assert driven(foresight(), 1.0, 100) == 100
    assert 0 <= driven(foresight(), -1.0, 100) < 25


def held_beyond(ahead: Foresight, torque: float, cycles: int) -> int:
    """A command that stays; cycles until a stop."""
    for cycle in range(cycles):
        try:
            ahead.commanded(torque, 0.0, 1.0, 3.0)
        except LimitError as error:
            return cycle if error.limit == "torque_envelope" else -1
    return cycles


def test_an_envelope_holds_for_a_time_and_only_with_a_factor() -> None:
    assert held_beyond(foresight(), 99.0, 100) == 100
    ahead = foresight(torque_envelope=2.0)
    most = 2.0 * (10.0 + 5.0 * 1.0 + 2.0 * 3.0) + 5.0
    assert held_beyond(ahead, most - 0.1, 100) == 100
    assert held_beyond(ahead, most + 0.1, 25) == 25
    assert held_beyond(ahead, most - 0.1, 1) == 1
    assert held_beyond(ahead, -most - 0.1, 100) == 25  # 50 ms


def test_what_a_joint_states_about_its_motion() -> None:
    joint = MovingJoint.of(
        JOINT.with_parameters({"coulomb": 25.0, "static": 20.0, "viscous": 20.0})
    )
    assert joint is not None
    assert joint.inertia == pytest.approx(2.472e-4 * 101.0**2 + JOINT.link_inertia)
    assert joint.dry == 45.0
    assert joint.needed(-math.pi / 2.0, -0.5, 0.0) is not None
    used, surely = joint.braking(160.0) or (0.0, 0.0)
    assert used == pytest.approx(144.0)
    assert 0.0 < surely < 144.0 / joint.inertia
    assert joint.braking(joint.weight) is None
    assert joint.braking(math.inf) is None
    assert MovingJoint.of(None) is None
    assert replace(joint, dry=None).needed(0.0, 1.0, 1.0) is None
    assert np.isclose(joint.energy(0.3, 2.0) - joint.energy(0.3, 0.0), 2.0 * joint.inertia)
