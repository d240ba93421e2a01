"""Logs of messages and HDF5 files on the command line: what is printed can be pasted."""

import re
import shlex
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from example_recordings import WELL_EXCITED
from message_files import START, State, in_order, joint_state, mcap, motion

import jointid as jid
from jointid.cli.command_line import main

pytest.importorskip("mcap")
pytest.importorskip("rosbags")
h5py = pytest.importorskip("h5py")


def pasted(text: str, option: str) -> list[str]:
    """The first advised option with its value, as a shell reads it."""
    found = re.search(rf"{option} ('[^']*'|\S+?)(?=[\s;]|$)", text)
    assert found, text
    return [option, *shlex.split(found[1])]


def test_a_topic_is_chosen_by_pasting(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    both = [joint_state("/joint_states", state) for state in motion(50, ["a"])]
    both += [joint_state("/left arm/joint_states", state) for state in motion(40, ["a"])]
    path = str(mcap(tmp_path / "run.mcap", in_order(both)))
    assert main(["info", path]) == 2
    error = capsys.readouterr().err
    assert "2 topics hold joints" in error
    assert "topic=" not in error
    assert main(["info", path, *pasted(error, "--topic")]) == 0
    shown = capsys.readouterr().out
    assert "topic: /joint_states\n" in shown
    assert "50 rows over" in shown
    assert main(["info", path, "--topic", "/left arm/joint_states"]) == 0
    assert "40 rows over" in capsys.readouterr().out
    assert main(["info", path, "--topic", "/right"]) == 2
    assert "--topic /right: no such topic" in capsys.readouterr().err


def test_a_group_is_chosen_by_pasting(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    time = np.arange(30.0) / 1000.0
    path = str(tmp_path / "demos.h5")
    with h5py.File(path, "w") as file:
        for k in range(3):
            file[f"data/demo_{k}/time"] = file[f"data/demo_{k}/q"] = time
    assert main(["info", path]) == 2
    assert main(["info", path, *pasted(capsys.readouterr().err, "--group")]) == 0


def test_a_group_and_a_joint_in_one_line(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = str(tmp_path / "demos.h5")
    with h5py.File(path, "w") as file:
        for k in range(2):
            file[f"data/demo_{k}/time"] = 0.01 * np.arange(30.0)
            file[f"data/demo_{k}/q"] = np.outer(np.arange(30.0), [1.0, 2.0])
    assert main(["info", path]) == 2
    error = capsys.readouterr().err
    assert "--group data/demo_0 --joints 1 (or another joint)" in error
    pasted_options = [*pasted(error, "--group"), *pasted(error, "--joints")]
    assert main(["info", path, *pasted_options]) == 0


def test_a_topic_and_a_joint_in_one_line(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    both = [joint_state("/joint_states", state) for state in motion(50, ["a", "b"])]
    both += [joint_state("/gripper", state) for state in motion(40, ["finger"])]
    path = str(mcap(tmp_path / "run.mcap", in_order(both)))
    assert main(["info", path]) == 2
    error = capsys.readouterr().err
    assert "--topic /joint_states --joints a (or another joint)" in error
    assert "--topic /gripper\n" in error
    assert main(["info", path, "--topic", "/joint_states", "--joints", "a"]) == 0


def test_what_a_log_lacks_is_said(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    states = [
        joint_state("/js", replace(state, stamp=0), late=state.stamp) for state in motion(50, ["a"])
    ]
    path = str(mcap(tmp_path / "run.mcap", states, use_chunking=False))
    raw = Path(path).read_bytes()
    Path(path).write_bytes(raw[: len(raw) * 2 // 3])
    assert main(["info", path]) == 0
    shown = " ".join(capsys.readouterr().out.split())
    assert "the end of the file is missing" in shown
    assert "times are log times, because the messages have no time stamps" in shown


def test_a_joint_is_identified_from_a_log(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """The shipped recording as an MCAP file gives the same values, and how it was read is a finding."""
    run = jid.load(WELL_EXCITED).crop(0.0, 8.0)
    assert run.torque is not None
    states = [
        State(
            stamp=START + round(time * 1e9),
            name=["elbow"],
            position=[position],
            velocity=[velocity],
            effort=[torque],
        )
        for time, position, velocity, torque in zip(
            run.time, run.position, run.velocity, run.torque, strict=True
        )
    ]
    messages = [joint_state("/joint_states", state) for state in states]
    path = mcap(tmp_path / "run.mcap", [*messages[:9], messages[8], *messages[9:]])
    model = "coulomb_viscous"
    found = jid.identify(jid.load(path), model=jid.Model.parse(model))
    alike = jid.Recording(
        time=run.time - run.time[0],
        position=run.position,
        velocity=run.velocity,
        torque=run.torque,
    )
    same = jid.identify(alike, model=jid.Model.parse(model))
    for name, parameter in same.parameters.items():
        assert found.parameters[name].value == pytest.approx(parameter.value, rel=1e-6)
    (finding,) = [each for each in found.findings if each.code == "message_log"]
    assert "1 messages repeat another message" in str(finding)
    assert finding.evidence["repeated_messages"].value == 1
    assert main(["identify", str(path), "--topic", "/joint_states", "--model", model, "-v"]) == 0
    assert "repeat another message and are left out" in " ".join(capsys.readouterr().out.split())
