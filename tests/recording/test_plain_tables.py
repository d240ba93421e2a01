"""Tables of plain numbers that are not what was asked for; signals that a session's file lacks."""

import io
import warnings

import numpy as np

from jointid.recording.readers.csv_stream import plain_numbers
from jointid.recording.truncated import unrecorded


def test_a_table_of_another_width_is_none() -> None:
    rows = "1,2,3\n4,5,6\n"
    assert plain_numbers(io.StringIO(rows), 0, ",", 2) is None
    found = plain_numbers(io.StringIO(rows), 0, ",", 3)
    assert found is not None
    np.testing.assert_array_equal(found, [[1.0, 2.0, 3.0], [4.0, 5.0, 6.0]])


def test_a_table_without_rows_is_none() -> None:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # NumPy says so, too
        assert plain_numbers(io.StringIO("a\n"), 1, ",", 1) is None


def test_a_current_that_is_missing_once_is_no_signal() -> None:
    saved = {"metadata": {"session": True}}
    full = {"current": np.array([1.0, 2.0])}
    assert unrecorded(saved, full) == []
    assert unrecorded(saved, {"current": np.array([1.0, np.nan])}) == ["current"]
