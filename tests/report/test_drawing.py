"""Pictures: marks lie where the axes say, also where there is little or nothing to draw."""

import numpy as np
import pytest
from drawn_pictures import Picture, corners

from jointid.panels.marks import Band, Bars, Level, Line, Mark, Panel, Points, Range
from jointid.report.drawing.picture import WIDTH, drawn

TENTHS = 10  # places a unit


def picture(*marks: Mark, logarithmic: bool = False, across: str = "time [s]") -> Picture:
    panel = Panel(across=across, up="torque [N·m]", marks=marks, logarithmic=logarithmic)
    return Picture(str(drawn([panel], "a picture")))


@pytest.mark.parametrize(("size", "middle"), [(1.0, 0.0), (3e-7, 0.0), (40.0, -900.0), (8e5, 1e6)])
def test_points_lie_where_the_axes_say(size: float, middle: float) -> None:
    random = np.random.default_rng(1)
    x, y = random.normal(size=(2, 200)) * size + middle
    seen = picture(Points(across=x, up=y))
    dots = np.array([piece[0] for piece in seen.points("points")])
    exponents = {text: np.round(np.log10(size)) for text in seen.texts}
    assert exponents
    for column, (values, kind) in enumerate(((x, "across"), (y, "up"))):
        axis = seen.axis(kind)
        read = axis.value(dots[:, column])
        # Numbers at the ticks may stand for multiples of a power of ten, which the title says.
        power = 10.0 ** np.round(np.log10(np.ptp(values) / np.ptp(read)))
        unit = np.ptp(values) / 400.0 / TENTHS  # about a place
        assert read * power == pytest.approx(values, abs=3.0 * unit)
        titled = any("[10" in text for text in seen.texts)
        assert (power != 1.0) <= titled


def test_two_panels_share_the_axis_across() -> None:
    x = np.linspace(2.0, 8.0, 50)
    first = Panel(across="time [s]", up="a [rad]", marks=(Line(across=x, up=x),))
    second = Panel(across="time [s]", up="b", marks=(Line(across=x[10:20], up=-x[10:20]),))
    seen = Picture(str(drawn([first, second], "two")))
    upper, lower = seen.points("line", 0)[0], seen.points("line", 1)[0]
    axis = seen.axis("across")
    assert axis.value(upper[:, 0]) == pytest.approx(x, abs=0.01)
    assert axis.value(lower[[0, -1], 0]) == pytest.approx(x[[10, 19]], abs=0.01)
    assert seen.texts.count("time [s]") == 1


def test_a_gap_interrupts_a_line_and_a_band() -> None:
    x = np.arange(6.0)
    y = np.array([0.0, 1.0, np.nan, 1.0, np.inf, 3.0])
    seen = picture(Line(across=x, up=y), Band(across=x, low=y - 1.0, high=y + 1.0))
    assert [len(piece) for piece in seen.points("line")] == [2, 2, 2]  # the last two are dots
    assert len(seen.points("band")) == 3


@pytest.mark.parametrize(
    "values",
    [
        *([], [np.nan, np.nan], [3.0], [0.0, 0.0], [7.0] * 5, [np.inf, 1.0], [-1e300, 1e300, 0.0]),
        *([1e-320, 2e-320], [1e9, 1e9 + 1e-3], [-1e-12, 1e-12], [5e-324], [1e149, -1e149]),
    ],
)
@pytest.mark.parametrize("logarithmic", [False, True])
def test_poor_signals_are_drawn(values: list[float], logarithmic: bool) -> None:
    x, y = np.arange(len(values)), np.array(values)
    marks = (
        *(Line(across=x, up=y), Points(across=x, up=y), Level(up=y[0] if len(y) else np.nan)),
        Band(across=x, low=y, high=y),
    )
    seen = picture(*marks, logarithmic=logarithmic)
    inside = [corner for each in seen.root.iter("path") for corner in corners(each.attrib["d"])]
    _, _, width, height = map(float, seen.root.attrib["viewBox"].split())
    for piece in inside:
        assert np.all((piece >= 0.0) & (piece <= [width, height]))
    shown = np.isfinite(y) & (np.abs(y) < 1e150) & ((y > 0.0) | (not logarithmic))
    assert ("no values" in seen.texts) == (
        not shown.any() or bool(logarithmic and y.max() < 1e-150)
    )


def test_a_constant_stands_in_the_middle() -> None:
    seen = picture(Line(across=[0.0, 1.0], up=[7.0, 7.0]))
    assert seen.axis("up").value(seen.points("line")[0][:, 1]) == pytest.approx(7.0, abs=0.05)


def test_a_logarithmic_axis_has_decades() -> None:
    x = np.arange(50.0)
    seen = picture(Line(across=x, up=10.0 ** (-x / 10.0)), logarithmic=True)
    assert {"10⁰", "10⁻²", "10⁻⁴"} <= set(seen.texts)
    heights = np.diff(seen.points("line")[0][:, 1])
    assert heights == pytest.approx(np.full(49, heights.mean()), abs=1.0)
    few = picture(Line(across=x, up=1.0 + x / 20.0), logarithmic=True)
    assert {"1", "2"} <= set(few.texts)


def test_an_axis_across_may_be_logarithmic() -> None:
    x = 10.0 ** np.arange(4.0)
    line = Line(across=x, up=np.arange(4.0))
    panel = Panel(across="population", up="error", marks=(line,), logarithmic_across=True)
    seen = Picture(str(drawn([panel], "a study")))
    assert {"10⁰", "10¹", "10²", "10³"} <= set(seen.texts)
    steps = np.diff(seen.points("line")[0][:, 0])
    assert steps == pytest.approx(np.full(3, steps.mean()), abs=1.0)


def test_an_axis_at_the_right_has_its_own_numbers() -> None:
    x = np.linspace(0.0, 1.0, 5)
    panel = Panel(
        across="velocity [rad/s]",
        up="share [%]",
        marks=(Line(across=x, up=x),),
        right=(Line(label="friction", across=x, up=100.0 * x),),
        right_up="friction [N·m]",
    )
    seen = Picture(str(drawn([panel], "two units")))
    first, second = seen.points("line", 0)[0], seen.points("line", 1)[0]
    np.testing.assert_array_equal(first, second)  # one shape in two units
    assert {"friction [N·m]", "friction", "1.0", "100"} <= set(seen.texts)
    numbers = [each for each in seen.root.iter("text") if each.text == "100"]
    assert float(numbers[0].attrib["x"]) > second[:, 0].max()
    assert "At the right: friction [N·m]: friction (line, 5 values)" in (
        seen.root.findtext("desc") or ""
    )


def test_a_range_is_as_wide_as_the_picture() -> None:
    seen = picture(Range(low=1.0, high=3.0), Line(across=[0.0, 1.0], up=[0.0, 5.0]))
    (box,) = seen.points("shade")
    assert seen.axis("up").value(box[[0, 1], 1]) == pytest.approx([1.0, 3.0], abs=0.02)
    line = seen.points("line")[0]
    assert box[0, 0] < line[0, 0] < line[1, 0] < box[2, 0]
    assert "shade measured" in {each.attrib.get("class") for each in seen.root.iter("path")}


def test_bars_stand_on_zero() -> None:
    seen = picture(Bars(edges=[0.0, 1.0, 3.0], up=[2.0, 5.0]))
    first, second = seen.points("bars")
    axis = seen.axis("up")
    assert axis.value(first[[0, 1], 1]) == pytest.approx([0.0, 2.0], abs=0.02)
    assert axis.value(second[[0, 1], 1]) == pytest.approx([0.0, 5.0], abs=0.02)
    assert first[2, 0] == second[0, 0]


def test_a_look_that_no_palette_has_is_refused() -> None:
    with pytest.raises(ValueError, match="no look 'pink'"):
        Level(look="pink", up=0.0)


def test_texts_cannot_leave_the_picture() -> None:
    hostile = '</svg><script>alert("1")</script>&amp;\x00'
    panel = Panel(across=hostile, up=hostile, marks=(Level(label=hostile, up=1.0),))
    markup = str(drawn([panel], hostile, hostile))
    assert "<script" not in markup
    assert markup.count("</svg>") == 1
    seen = Picture(markup)
    assert [each.tag for each in seen.root][:2] == ["title", "desc"]
    assert sum("script" in text for text in seen.texts) == 3


def test_a_picture_is_told_in_words() -> None:
    x = np.arange(5.0)
    seen = picture(Points(label="measured", across=x, up=np.where(x == 2.0, np.nan, 10.0 * x)))
    title, described = (seen.root.findtext(name) or "" for name in ("title", "desc"))
    assert title == "a picture"
    assert seen.root.attrib["role"] == "img"
    assert "time [s], from -0.16 to 4.16" in described
    assert "torque [N·m]" in described
    assert "measured (points, 4 values)" in described


def test_long_legends_wrap_within_the_picture() -> None:
    marks = [Level(up=float(number), label=f"a rather long name {number}") for number in range(5)]
    seen = picture(*marks)
    places = [
        (float(each.attrib["x"]), float(each.attrib["y"]), each.text or "")
        for each in seen.root.iter("text")
        if "long name" in (each.text or "")
    ]
    assert len({y for _, y, _ in places}) == 3
    for x, _, text in places:
        assert x + 100.0 * len(text) < WIDTH * TENTHS
