"""Faults of logged joint states: signals that come and go, zeros for what nobody measures, two publishers."""

import tracemalloc
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from message_files import State, joint_state, mcap, motion
from recording_files import refusal

import jointid as jid
from jointid.recording.messages.publishers import jump_between_publishers

pytest.importorskip("mcap")
pytest.importorskip("rosbags")


def log(folder: Path, states: list[State]) -> Path:
    return mcap(folder / "run.mcap", [joint_state("/joint_states", state) for state in states])


def test_velocities_of_zero_are_named_with_what_to_paste(tmp_path: Path) -> None:
    states = [replace(state, velocity=[0.0]) for state in motion(200, ["a"])]
    path = log(tmp_path, states)
    with pytest.raises(jid.InputError, match="velocity: the velocity is always 0") as caught:
        jid.identify(jid.load(path))
    (advice,) = caught.value.remedy
    assert not isinstance(advice, str)
    assert advice.arguments == {"columns": {"velocity": None}}
    jid.identify(jid.load(path, **advice.arguments), model="coulomb_viscous")


def test_an_effort_that_ends_can_be_left_out(tmp_path: Path) -> None:
    states = [replace(s, effort=s.effort if k < 30 else []) for k, s in enumerate(motion(50))]
    path = log(tmp_path, states)
    text = refusal(path, joint="elbow")
    assert "message 30" in text
    assert "load with columns={'torque': None}" in text
    assert "one joint at a time" not in text
    assert len(jid.load(path, joint="elbow", columns={"torque": None})) == 50


@pytest.mark.parametrize("large", [1e200, 1.7e308, -1.7e308])
def test_a_damaged_position_says_nothing_of_publishers(large: float) -> None:
    position = np.sin(np.arange(40.0))
    position[[20, 22, 25]] = large
    position[26] = -large
    with np.errstate(all="raise"):
        assert jump_between_publishers(position) is None


@pytest.mark.parametrize("every", [1, 2, 3])
def test_two_publishers_of_one_joint_are_refused(every: int, tmp_path: Path) -> None:
    states = []
    for k, state in enumerate(motion(200)):
        states.append(state)
        if k % every == 0:
            moved = [each + 1.0 for each in state.position]
            states.append(replace(state, stamp=state.stamp + 3_000_000, position=moved))
    text = refusal(log(tmp_path, states), joint="elbow")
    assert "two nodes published the same joint" in text


def test_noise_dither_and_motion_are_one_publisher() -> None:
    random = np.random.default_rng(0)
    time = np.arange(2000) * 0.01
    positions: tuple[np.ndarray, ...] = (
        np.sin(3.0 * time),
        random.normal(size=2000),
        1e-3 * (np.arange(2000) % 2),
        np.sin(3.0 * time) + random.normal(scale=0.02, size=2000),
        np.cumsum(random.normal(size=2000)),
    )
    for position in positions:
        assert jump_between_publishers(position) is None


def test_a_damaged_length_reserves_no_memory(tmp_path: Path) -> None:
    path = log(tmp_path, motion(20))
    jid.load(path, joint="elbow")  # what is imported takes memory, too
    content = bytearray(path.read_bytes()[:-8])  # without an end it is read from the beginning
    content[17:21] = (1_000_000_000).to_bytes(4, "little")  # characters of the profile's name
    path.write_bytes(content)
    tracemalloc.start()
    refusal(path, joint="elbow")
    _, most = tracemalloc.get_traced_memory()
    tracemalloc.stop()
    assert most < 10_000_000
