"""A long signal's picture has every extreme of it, and is short."""

import numpy as np
import pytest
from drawn_pictures import Picture

from jointid.panels.marks import Band, Line, Mark, Panel, Points
from jointid.report.drawing.decimation import distinct, outline
from jointid.report.drawing.picture import drawn

LONG = 200_000


def picture(*marks: Mark) -> Picture:
    return Picture(str(drawn([Panel(across="time [s]", up="torque", marks=marks)], "long")))


def test_the_outline_of_each_column_is_its_own() -> None:
    random = np.random.default_rng(2)
    columns = np.sort(random.integers(0, 40, 5000))
    values = random.normal(size=5000)
    kept = outline(columns, values)
    assert (np.diff(kept) > 0).all()
    for column in np.unique(columns):
        there = np.flatnonzero(columns == column)
        seen = np.intersect1d(kept, there)
        assert len(seen) <= 4
        assert {there[0], there[-1]} <= set(seen.tolist())
        assert values[seen].min() == values[there].min()
        assert values[seen].max() == values[there].max()
    assert len(outline(np.zeros(0, dtype=np.int64), np.zeros(0))) == 0


def test_an_extreme_that_comes_again_is_kept_in_each_column() -> None:
    columns = np.repeat([0, 1, 2], 5)
    values = np.tile([0.0, 1.0, 0.5, 0.5, 0.0], 3)
    kept = outline(columns, values)
    assert kept.tolist() == [0, 1, 4, 5, 6, 9, 10, 11, 14]


@pytest.mark.parametrize("gap", [False, True])
def test_a_spike_of_one_sample_stays(gap: bool) -> None:
    time = np.linspace(0.0, 100.0, LONG)
    values = np.sin(time)
    values[[50_001, 120_003]] = 9.0, -7.0
    if gap:
        values[80_000:90_000] = np.nan
    seen = picture(Line(across=time, up=values))
    axis = seen.axis("up")
    drawn_values = axis.value(np.concatenate(seen.points("line"))[:, 1])
    assert drawn_values.max() == pytest.approx(9.0, abs=0.02)
    assert drawn_values.min() == pytest.approx(-7.0, abs=0.02)
    times = seen.axis("across").value(np.concatenate(seen.points("line"))[:, 0])
    assert times[np.argmax(drawn_values)] == pytest.approx(time[50_001], abs=0.1)
    assert len(drawn_values) < 2200
    assert len(seen.points("line")) == (2 if gap else 1)


def test_a_long_band_keeps_its_width() -> None:
    time = np.linspace(0.0, 1.0, LONG)
    high = np.ones(LONG)
    high[777] = 5.0
    seen = picture(Band(across=time, low=-high[::-1], high=high))
    reached = seen.axis("up").value(np.concatenate(seen.points("band"))[:, 1])
    assert reached.max() == pytest.approx(5.0, abs=0.02)
    assert reached.min() == pytest.approx(-5.0, abs=0.02)
    assert len(reached) < 8800


def test_a_line_that_comes_back_is_drawn_as_it_is() -> None:
    """Only a signal over an increasing axis has an outline."""
    angle = np.linspace(0.0, 20.0 * np.pi, 20_000)
    (line,) = picture(Line(across=np.cos(angle), up=np.sin(angle))).points("line")
    assert len(line) > 10_000


def test_points_upon_each_other_are_drawn_once() -> None:
    random = np.random.default_rng(3)
    x, y = random.normal(size=(2, LONG))
    dots = picture(Points(across=x, up=y)).points("points")
    assert 5_000 < len(dots) < 60_000
    places = np.array([piece[0] for piece in dots]) // 10
    assert len(np.unique(places, axis=0)) == len(dots)
    kept = distinct(np.array([0, 4, 12, 3]), np.array([0, 9, 0, 25]), 10)
    assert kept.tolist() == [0, 2, 3]
