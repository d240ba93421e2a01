"""The code in docs/several_joints.md runs, and shows what the page says."""

from pathlib import Path

import pytest
from documents import read, run_python_blocks


def test_the_page_runs(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    names = run_python_blocks(read("docs/several_joints.md"), tmp_path, monkeypatch)
    (share,) = (each for each in names["found"].results["1"].others if each.certain)
    assert (share.joint, share.by) == ("2", "speed")
    assert names["found"]["1"].parameters["coulomb"].value == pytest.approx(8.0, rel=0.1)
    text = read("docs/several_joints.md")
    (sentence,) = [line for line in text.splitlines() if line.startswith("joint 2's speed")]
    assert sentence in capsys.readouterr().out
