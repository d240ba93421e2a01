"""The page of several joints: the table, what couples them, and a section for each."""

from pathlib import Path

import numpy as np
import pytest
from moving_joints import sines, torques

import jointid as jid
from jointid.report.joints_page import joints_report
from jointid.report.saving import save_report


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
    page = joints_report(found)
    for name in ("a-b", "wrist", "idle"):
        assert f'<h2 id="joint-{name}">' in page
    assert page.count("<svg ") == 4  # two pictures a joint that was identified
    assert "This joint failed: joint idle" in page
    assert "<a<b" not in page


def test_the_couplings_are_told_and_tabled(found: jid.JointEstimates) -> None:
    page = joints_report(found)
    assert "joint wrist&#x27;s speed explains" in page
    assert "by joint wrist" in page


def test_it_needs_no_other_file(found: jid.JointEstimates, tmp_path: Path) -> None:
    path = save_report(found, tmp_path / "arm.html")
    text = path.read_text(encoding="utf-8")
    assert text == joints_report(found)
    assert text.endswith("</body></html>")
    assert "src=" not in text
    assert "url(" not in text
    assert "http" not in text


def test_a_notebook_shows_the_table(found: jid.JointEstimates) -> None:
    shown = found._repr_html_()
    assert shown.startswith("<div><b>jointid estimates — robot</b>")
    assert np.all([name in shown for name in ("wrist", "failed", "coulomb")])
