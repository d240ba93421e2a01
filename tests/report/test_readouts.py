"""What a pointer over a picture reads: the values that are drawn there, without a program in the page."""

import re

import numpy as np
import pytest
from drawn_pictures import Picture

from jointid.panels.marks import Bars, Line, Panel, Points
from jointid.report.drawing.picture import WIDTH, drawn


def read(*panels: Panel) -> list[dict[str, str]]:
    """By strip from the left: what its title says, by name."""
    root = Picture(str(drawn(list(panels), "a picture"))).root
    titles = [
        each[0].text or "" for each in root.iter("path") if each.attrib.get("class") == "readout"
    ]
    return [dict(line.split(": ", 1) for line in title.split("\n")) for title in titles]


def number(text: str) -> float:
    return float(re.split("[ %]", text)[0].replace("\u2212", "-"))


def test_two_panels_are_read_at_once_with_names_and_units() -> None:
    time = np.linspace(0.0, 10.0, 5000)
    seen = read(
        Panel(
            across="time [s]",
            up="torque [N·m]",
            marks=(Line(label="measured", across=time, up=-3.0 * time),),
        ),
        Panel(across="time [s]", up="residual [N·m]", marks=(Points(across=time, up=time**2),)),
    )
    assert len(seen) >= 70
    for strip in seen[1:-1]:  # at the ends a strip may hold the last point and no line
        assert list(strip) == ["time", "measured", "residual"]
        assert 0.0 <= number(strip["time"]) <= 10.0
        assert strip["time"].endswith(" s")
        assert strip["measured"].endswith(" N·m")
        at = number(strip["time"])
        assert number(strip["measured"]) == pytest.approx(-3.0 * at, abs=0.02)
        assert number(strip["residual"]) == pytest.approx(at**2, abs=0.06)


def test_logarithmic_axes_and_the_axis_at_the_right_are_read_in_their_units() -> None:
    x = 10.0 ** np.linspace(0.0, 3.0, 4)
    panel = Panel(
        across="population",
        up="error [%]",
        marks=(Line(across=x, up=np.log10(x)),),
        right=(Line(label="torque", across=x, up=2.0 * np.log10(x)),),
        right_up="torque [N·m]",
        logarithmic_across=True,
    )
    seen = read(panel)
    assert len(seen) >= 70
    for strip in seen:
        at = np.log10(number(strip["population"]))
        assert number(strip["error"]) == pytest.approx(at, abs=0.01)
        assert number(strip["torque"]) == pytest.approx(2.0 * at, abs=0.01)
        assert strip["torque"].endswith(" N·m")


def test_strips_lie_side_by_side_over_the_panels() -> None:
    x = np.linspace(0.0, 1.0, 500)
    panel = Panel(across="x", up="y", marks=(Line(across=x, up=x),))
    seen = Picture(str(drawn([panel], "a picture")))
    corners = [
        np.array(re.findall(r"-?\d+", each.attrib["d"])[:2], dtype=int)
        for each in seen.root.iter("path")
        if each.attrib.get("class") == "readout"
    ]
    steps = np.diff([corner[0] for corner in corners])
    assert (steps > 0).all()
    assert np.ptp(steps) <= 1
    assert sum(steps) < 10 * WIDTH
    read_at = [number(strip["y"]) for strip in read(panel)]
    axis = seen.axis("across")
    middles = np.array([corner[0] for corner in corners]) + 0.5 * steps[0]
    assert axis.value(middles) == pytest.approx(read_at, abs=0.01)


def test_where_nothing_is_drawn_nothing_is_read() -> None:
    gap = np.array([0.0, 0.1, 0.2, np.nan, 0.8, 0.9, 1.0])
    seen = read(Panel(across="x", up="y", marks=(Line(across=gap, up=gap),)))
    read_at = np.array([number(strip["x"]) for strip in seen])
    assert len(read_at) >= 20
    assert not ((read_at > 0.25) & (read_at < 0.75)).any()
    assert read(Panel(across="x", up="y", marks=(Points(across=[], up=[]),))) == []


def test_a_line_that_turns_back_has_no_single_value() -> None:
    angle = np.linspace(0.0, 6.3, 400)
    assert read(Panel(across="x", up="y", marks=(Line(across=np.cos(angle), up=angle),))) == []


def test_bars_are_read_by_where_they_stand() -> None:
    bars = Bars(label="trials", edges=[0.0, 1.0, 2.0], up=[3.0, 5.0])
    seen = read(Panel(across="x", up="count", marks=(bars,)))
    for strip in seen:
        assert number(strip["trials"]) == (3.0 if number(strip["x"]) < 1.0 else 5.0)


def test_a_name_is_escaped() -> None:
    hostile = "<script>1</script>"
    panel = Panel(across="x", up="y", marks=(Points(label=hostile, across=[1.0], up=[1.0]),))
    assert "<script" not in str(drawn([panel], "a picture"))
