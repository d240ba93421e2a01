"""An arm and its gripper on one topic: the joints of one clock are read, the others are named."""

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from message_files import START, Sent, State, joint_state, mcap
from shared_cases import case

import jointid as jid
from jointid.base.advice import Action

pytest.importorskip("mcap")


def publisher(
    names: Sequence[str], period: int, count: int, *, effort: bool, late: int = 0
) -> list[Sent]:
    """States of some joints, `period` ns apart."""
    number = np.arange(len(names))
    return [
        joint_state(
            "/joint_states",
            State(
                stamp=START + late + period * k,
                name=list(names),
                position=(np.sin(1e-9 * period * k + number)).tolist(),
                effort=(np.cos(1e-9 * period * k + number)).tolist() if effort else [],
            ),
        )
        for k in range(count)
    ]


def log(path: Path, *publishers: list[Sent]) -> Path:
    messages = sorted((sent for each in publishers for sent in each), key=lambda s: s.log_time)
    return mcap(path, messages)


def _joints(remedy: str | Action) -> Any:
    assert isinstance(remedy, Action)
    return remedy.arguments["joints"]


ARM = ("shoulder", "elbow")


@pytest.mark.parametrize(
    "gripper",
    [
        publisher(["finger"], 33_000_000, 60, effort=False, late=1_000),
        publisher(["left", "right", "thumb"], 20_000_000, 100, effort=False, late=700),
        publisher(["jaw"], 10_000_000, 200, effort=True, late=5_000_000),
    ],
    ids=["slow", "more joints", "with effort"],
)
def test_the_clock_of_most_torques_is_read(gripper: list[Sent], tmp_path: Path) -> None:
    arm = publisher(ARM, 10_000_000, 200, effort=True)
    path = log(tmp_path / "run.mcap", arm, gripper)
    read = jid.load(path, joints="all")
    assert read.names == ARM
    written = np.array([each.value.effort for each in arm])
    assert read.torque is not None
    assert np.array_equal(read.torque, written)
    left_out = read.metadata["joints_left_out"]
    assert list(left_out) == list(gripper[0].value.name)
    for why in left_out.values():
        assert ("no torque" in why) == (not gripper[0].value.effort)


def test_two_arms_are_asked_about(tmp_path: Path) -> None:
    """Neither clock has more torques; the message names the joints of each."""
    path = log(
        tmp_path / "run.mcap",
        publisher(["left_1", "left_2"], 10_000_000, 100, effort=True),
        publisher(["right_1", "right_2"], 10_000_000, 100, effort=True, late=3_000_000),
    )
    with pytest.raises(jid.InputError, match="logged at different times") as refused:
        jid.load(path, joints="all")
    proposed = [_joints(each) for each in refused.value.remedy]
    assert proposed == [["left_1", "left_2"], ["right_1", "right_2"]]
    for joints in proposed:
        assert jid.load(path, joints=joints).names == tuple(joints)


def test_named_joints_are_never_left_out(tmp_path: Path) -> None:
    path = log(
        tmp_path / "run.mcap",
        publisher(ARM, 10_000_000, 100, effort=True),
        publisher(["finger"], 33_000_000, 30, effort=False, late=1_000),
    )
    with pytest.raises(
        jid.InputError, match=r"finger and .* were logged at different times"
    ) as refused:
        jid.load(path, joints=["shoulder", "elbow", "finger"])
    assert _joints(refused.value.remedy[0]) == ["shoulder", "elbow"]


def test_the_arm_of_the_case_is_read() -> None:
    read = jid.load(case("robot-13-two-publishers-bag"), joints="all")
    assert read.names == ("shoulder", "elbow")
    assert list(read.metadata["joints_left_out"]) == ["finger"]
