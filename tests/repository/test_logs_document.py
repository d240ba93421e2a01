"""The code in docs/logs.md runs on logs with the topics, joints and groups that it names."""

from pathlib import Path

import numpy as np
import pytest
from documents import read, run_python_blocks
from message_files import joint_state, mcap, motion

h5py = pytest.importorskip("h5py")


def test_the_page_runs(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    text = read("docs/logs.md")
    first = next(line for line in text.splitlines() if line.startswith("recording = "))
    states = [joint_state("/joint_states", each) for each in motion(joints=["elbow", "slide"])]
    mcap(tmp_path / "run.mcap", states)
    mcap(tmp_path / "alone.mcap", [joint_state("/js", each) for each in motion(joints=["elbow"])])
    with h5py.File(tmp_path / "demos.h5", "w") as file:
        for number in range(4):
            group = file.create_group(f"data/demo_{number}")
            group["time"] = np.arange(50) * 0.01
            group["position"] = np.sin(np.arange(50) * 0.1) + number
            group["torque"] = np.cos(np.arange(50) * 0.1)
    # Only a log of one joint needs no name of it.
    alone = first.replace("run.mcap", "alone.mcap")
    names = run_python_blocks(text.replace(first, alone), tmp_path, monkeypatch)
    assert names["slide"].kind == "prismatic"
    assert list(names["robot"].names) == ["elbow", "slide"]
    assert names["demo"].position[0] == 3.0
