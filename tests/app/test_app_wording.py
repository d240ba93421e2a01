"""Errors and advice name the fields of the page and the user's file, never an argument or a path of this machine."""

from __future__ import annotations

from pathlib import Path

import pytest

import jointid as jid
from jointid.app.wording import label_of, worded
from jointid.base.advice import Action

CURRENT = "t_s,q_rad,current_A\n" + "".join(f"{k * 1e-3:.3f},{k % 9},1\n" for k in range(400))


@pytest.mark.parametrize(
    ("text", "how", "said"),
    [
        ("time,position\n0,0\n1,1\n2,2\n", {}, "choose the unit ms for time"),
        ("a,b\n1,2\n", {}, "choose the column of position"),
        ("t_s,motor_position,tau_Nm\n0,1,2\n", {}, "choose the side motor for position"),
        (CURRENT, {"gear_ratio": 0.0}, "gear ratio is 0: "),
        (CURRENT, {"sample_period": -1.0}, "time between rows is -1: "),
        (CURRENT, {"side": {"position": "left"}}, "side of position: "),
    ],
)
def test_a_log_that_is_refused(
    tmp_path: Path, text: str, how: dict[str, object], said: str
) -> None:
    path = tmp_path / "recording.csv"
    path.write_text(text, encoding="utf-8")
    with pytest.raises(jid.InputError) as found:
        jid.load(path, **how)  # type: ignore[call-overload]
    sentence = worded(found.value, path, "drive 3.csv")
    assert said in sentence
    for never in (str(tmp_path), "recording.csv", "gear_ratio", "sample_period", "={"):
        assert never not in sentence


def test_facts_that_a_current_needs_are_fields(tmp_path: Path) -> None:
    path = tmp_path / "log.csv"
    path.write_text(CURRENT, encoding="utf-8")
    with pytest.raises(jid.InputError) as found:
        jid.identify(jid.load(path))
    assert "fill in torque constant, fill in gear ratio" in worded(found.value)


def test_a_joint_that_is_refused() -> None:
    with pytest.raises(jid.InputError) as found:
        jid.Joint(torque_constant=-1.0)
    assert worded(found.value).startswith("torque constant is -1: more than 0 is expected")


@pytest.mark.parametrize(
    ("action", "label"),
    [
        (
            Action("call", {"columns": {"velocity": None}}, function="load"),
            "Choose no column for velocity",
        ),
        (
            Action("call", {"units": {"velocity": "deg_s"}}, function="load"),
            "Choose the unit deg/s for velocity",
        ),
        (Action("call", {"gear_ratio": 50.0}, function="Joint"), "Fill in 50 for gear ratio"),
        (Action("call", {"model": "stribeck"}), "Choose the friction model stribeck"),
        (Action("call", {"mask_standstill": True}, "rest"), "Mask standstill: yes (rest)"),
        (Action("record", text="slow motion"), "Record slow motion"),
    ],
)
def test_a_button_says_what_it_does(action: Action, label: str) -> None:
    assert label_of(action) == label
