"""The page of several joints: the table, what couples them, and a section for each."""

from pathlib import Path

import numpy as np
import pytest
from moving_joints import sines, torques

import jointid as jid
from jointid.report.saving import report_page, save_report


@pytest.fixture(scope="module")
def found() -> jid.JointEstimates:
    """Two coupled joints, and one that stands still."""
    motion = sines(3, 1, duration=8.0)
    torque = torques(motion, 1)
    torque[:, 0] += motion.velocity[:, 1]
    position = motion.position.copy()
    position[:, 2] = 0.1
    robot = jid.RobotRecording(
        time=motion.time, position=position, torque=torque, names=["a<b", "wrist", "idle"]
    )
    return jid.identify_joints(robot)


def test_every_joint_has_its_section(found: jid.JointEstimates) -> None:
    page = report_page(found)
    for number, name in enumerate(("a&lt;b", "wrist"), 1):
        assert f'<a href="#of-{number}">{name}</a>' in page
        assert f'<div id="of-{number}">' in page
    assert ">failed</td>" in page
    # Of each joint a small friction map, and folded its map, its windows and its residual.
    assert page.count("<svg ") == 2 * 4
    assert "joint idle failed: " in page
    assert "joint idle failed: joint idle" not in page
    assert "<a<b" not in page


def test_the_couplings_are_told_and_tabled(found: jid.JointEstimates) -> None:
    page = report_page(found)
    assert "joint wrist&#x27;s speed explains" in page
    assert "by joint wrist" in page


def test_it_needs_no_other_file(found: jid.JointEstimates, tmp_path: Path) -> None:
    path = save_report(found, tmp_path / "arm.html")
    text = path.read_text(encoding="utf-8")
    assert text == report_page(found)
    assert text.endswith("</body></html>")
    assert "src=" not in text
    assert "url(" not in text
    assert "http" not in text


def test_a_notebook_shows_the_table(found: jid.JointEstimates) -> None:
    shown = found._repr_html_()
    assert np.all([name in shown for name in ("wrist", "failed", "coulomb")])
