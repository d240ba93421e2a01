"""Segments of motion: cut at reversals, none too short or too long, and nothing lost."""

import numpy as np
import pytest

from jointid.identification.inference.motion import Motion, motion_segments


def motion(travel: np.ndarray, recording: np.ndarray | None = None) -> Motion:
    start = np.asarray(0.01 * np.arange(len(travel)), dtype=np.float64)
    which = np.zeros(len(travel), dtype=np.int64) if recording is None else recording
    return Motion(start=start, stop=start + 0.01, travel=travel, recording=which)


def test_reversals_are_cuts() -> None:
    sign = np.repeat([1.0, -1.0, 1.0, -1.0, 1.0, -1.0, 1.0, -1.0, 1.0], 100)
    found = motion_segments(motion(sign))
    assert found.length == 1.0
    assert found.cuts[0].tolist() == list(range(0, 901, 100))
    assert found.cuts[1].tolist() == [0, *range(150, 800, 100), 900]


def test_long_ones_are_divided_and_short_ones_merged() -> None:
    sign = np.concatenate([np.ones(600), np.tile([1.0, -1.0], 10).repeat(3), -np.ones(540)])
    lengths = np.diff(motion_segments(motion(sign)).cuts[0])
    assert lengths.sum() == len(sign)
    assert np.all((lengths >= 50) & (lengths <= 150))


def test_no_segment_spans_two_recordings() -> None:
    which = np.repeat([0, 1, 2], [130, 20, 250])
    assert {0, 130, 150, 400} <= set(motion_segments(motion(np.ones(400), which)).cuts[0].tolist())


def test_an_hour_has_segments_that_are_longer_not_more() -> None:
    found = motion_segments(motion(np.ones(360_000)))
    assert found.length == pytest.approx(6.0)
    assert len(found.cuts[0]) == 601
