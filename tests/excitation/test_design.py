"""A design shows what it holds: as text, in a notebook, in a picture."""

import math
from collections.abc import Iterator
from dataclasses import replace
from typing import Any

import matplotlib
import numpy as np
import pytest

matplotlib.use("Agg")
from designs import designed
from matplotlib import pyplot

import jointid as jid
from jointid.excitation.motion_limits import MotionLimits

DESIGN = designed()


@pytest.fixture(autouse=True)
def _closed() -> Iterator[None]:
    yield
    pyplot.close("all")


def test_the_summary_has_each_error_the_weakest_and_the_limits() -> None:
    lines = str(DESIGN).splitlines()
    assert lines[0] == "designed motion of 'thesis joint': 6 s, complete"
    (row,) = (line for line in lines if line.startswith("sensor_gain"))
    for shown in ("2.4", "± 0.0058", "0.24 %", "0.36 %", "1.4 %", "N·m/unit"):
        assert shown in row
    assert "weakest: sensor_gain, 0.36 % at worst; the velocity is at its limit" in lines
    assert "reaches velocity: 3.38 of 3.4 rad/s (99 %, reached)" in lines
    assert (
        "reaches position: -0.7 to 0.9 of -1 to 1 rad, a stroke of 1.6 rad, 80 % of the range (90 %)"
        in lines
    )
    assert "seed 3" in lines[-1]


@pytest.mark.parametrize(
    ("changes", "line"),
    [
        (
            {},
            "assumes noise of 0.5 N·m at the torque sensor; controller adaptive_robust that believes coulomb 25, "
            "static 20, stribeck 100, viscous 20, with torque feedback, every 1 ms",
        ),
        (
            {
                "sensors": jid.Sensors(encoder_counts=8000.0, velocity="counts", ripple=0.2),
                "controller": jid.Pd(stiffness=2e4, damping=400.0),
                "control_period": 2e-3,
            },
            "assumes an encoder of 8000 counts per motor revolution, velocity from its counts, ripple 0.2; "
            "controller pd with stiffness 2e+04, damping 400, every 2 ms",
        ),
        (
            {"sensors": jid.Sensors(), "controller": jid.OpenLoop()},
            "assumes sensors without noise; controller open_loop, every 1 ms",
        ),
    ],
)
def test_which_sensors_and_which_controller_were_assumed_is_one_line(
    changes: dict[str, Any], line: str
) -> None:
    design = designed(**changes)
    assert line in str(design).splitlines()
    assert line in design._repr_html_()


def test_what_is_not_there_is_not_shown() -> None:
    text = str(designed(reference={}, limits=MotionLimits(position=(-1.0, 1.0), velocity=3.4)))
    assert "thesis's" not in text
    assert "reaches torque" not in text


def test_a_design_that_failed_says_why() -> None:
    failed = designed(status="limits not reachable", reason="no motion keeps the torque")
    assert str(failed).splitlines()[:2] == [
        "designed motion of 'thesis joint': 6 s, limits not reachable",
        "no motion keeps the torque",
    ]


def test_what_is_not_determined_is_said() -> None:
    lost = replace(DESIGN.parameters["viscous"], stderr=math.inf, relative=math.inf, worst=math.inf)
    (row,) = (
        line for line in str(designed(parameters={"viscous": lost})).splitlines() if "∞" in line
    )
    assert row.count("not determined") == 2


def test_a_prismatic_joint_has_its_units() -> None:
    joint = jid.Joint(kind="prismatic", inertia=2.0).with_parameters(
        {"coulomb": 1.0, "viscous": 1.0}
    )
    design = designed(joint=joint)
    assert "of 3.4 m/s (99 %" in str(design)
    assert [axes.get_ylabel() for axes in design.plot()[:2]] == ["position [m]", "velocity [m/s]"]


def test_shares_are_of_the_farther_side() -> None:
    assert DESIGN.shares == pytest.approx(
        {"position": 0.9, "velocity": 3.38 / 3.4, "torque": 0.75, "sensor_range": 0.5}
    )
    aside = replace(DESIGN, limits=MotionLimits(position=(-0.8, 1.2), velocity=3.4))
    assert aside.shares["position"] == pytest.approx(0.9)


def test_a_notebook_shows_the_same() -> None:
    html = designed(joint=replace(DESIGN.joint, name="<elbow>"))._repr_html_()
    assert "&lt;elbow&gt;" in html
    assert "± 0.0058 " in html
    assert "The velocity is at its limit" in html


def test_the_picture_shows_motion_limits_and_speeds() -> None:
    position, velocity, sampled = DESIGN.plot()
    time, drawn = (np.asarray(each, dtype=float) for each in position.lines[0].get_data())
    np.testing.assert_allclose(drawn, DESIGN.trajectory.sample(time)[0])
    for axes, limit in ((position, 1.0), (velocity, 3.4)):
        levels = [np.asarray(line.get_ydata(), dtype=float)[0] for line in axes.lines[1:]]
        assert levels == [-limit, limit]
    bars: Any = sampled.patches
    assert sum(bar.get_height() for bar in bars) == pytest.approx(100.0)
    assert sampled.get_xlabel() == "velocity [rad/s]"
    legend = position.get_legend()
    assert legend is not None
    assert [text.get_text() for text in legend.get_texts()] == [
        "joints reach",
        "reference",
        "limit",
    ]


def test_it_is_drawn_into_given_axes() -> None:
    _, axes = pyplot.subplots(1, 3)
    assert list(DESIGN.plot()) != list(axes)
    assert list(jid.plot.designed_motion(DESIGN, list(axes))) == list(axes)
    with pytest.raises(jid.InputError, match="ax is 2: three axes are expected"):
        jid.plot.designed_motion(DESIGN, list(axes[:2]))
