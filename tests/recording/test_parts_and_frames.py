"""Parts of a recording by `[...]`, and the way to a data frame and back."""

from typing import Any

import numpy as np
import pandas as pd
import pytest

from jointid.base.errors import InputError
from jointid.recording.recording import Recording

TIME = 0.5 + np.arange(200) * 0.01


def recording(**changes: Any) -> Recording:
    fields: dict[str, Any] = {
        "time": TIME,
        "position": np.sin(3.0 * TIME),
        "torque": np.cos(TIME),
        "name": "run 7",
        "torque_hold": "zoh",
        "metadata": {"operator": "A"},
    }
    return Recording(**(fields | changes))


def test_a_slice_is_of_times_both_ends_included() -> None:
    run = recording()
    part = run[1.0:1.5]
    assert part == run.crop(1.0, 1.5)
    assert run[:] == run
    assert part[1.2:].time[0] == pytest.approx(1.2)


def test_a_name_is_a_signal_also_an_extra_one() -> None:
    run = recording(extra={"gravity_model": 2.0 * TIME})
    assert run["torque"] is run.torque
    assert run["gravity_model"] is run.extra["gravity_model"]


@pytest.mark.parametrize(
    ("wanted", "message"),
    [
        ("torqe", "did you mean 'torque'"),
        ("sensor", "it has time, position, velocity, torque"),
        (3, "a signal's name or times"),
        (1.5, "a signal's name or times"),
        (slice(0.6, 0.9, 0.1), "`resample` changes the sample period"),
        (slice("a", None), "a time"),
        (slice(0.6, 0.61), "at least 8"),
    ],
)
def test_something_else_is_refused(wanted: Any, message: str) -> None:
    with pytest.raises(InputError, match=message):
        recording()[wanted]


def test_a_recording_is_no_sequence() -> None:
    with pytest.raises(TypeError, match="not iterable"):
        iter(recording())  # type: ignore[call-overload]


@pytest.mark.parametrize(
    "changes",
    [
        {},
        {"kind": "prismatic"},
        {"extra": {"gravity_model": 2.0 * TIME, "load": -TIME}},
        {"velocity": np.arange(200.0), "velocity_derived": True},
        {"sensor": np.arange(200.0), "truth": {"coulomb": 25.0}},
        {"name": "", "torque_hold": None, "metadata": {}},
    ],
    ids=["plain", "slide", "extra", "derived", "truth", "bare"],
)
def test_a_data_frame_gives_the_same_recording_back(changes: dict[str, Any]) -> None:
    run = recording(**changes)
    frame = run.to_pandas()
    assert frame.index.name == "time"
    assert Recording.from_dataframe(frame) == run


def test_rows_may_be_chosen_in_the_data_frame() -> None:
    run = recording()
    assert Recording.from_dataframe(run.to_pandas().loc[1.0:1.5]) == run[1.0:1.5]


@pytest.mark.parametrize(
    "index",
    [
        pd.to_timedelta(TIME, unit="s"),
        pd.to_datetime(1.7e9 + TIME, unit="s"),
        pd.to_datetime(1.7e9 + TIME, unit="s", utc=True).tz_convert("Europe/Berlin"),
        pd.Index(1e3 * TIME, name="stamp [ms]"),
    ],
    ids=["durations", "dates", "dates of a zone", "milliseconds"],
)
def test_an_index_of_times_is_the_time(index: Any) -> None:
    frame = pd.DataFrame({"position": np.sin(3.0 * TIME), "torque": np.cos(TIME)}, index=index)
    made = Recording.from_dataframe(frame)
    np.testing.assert_allclose(made.time - made.time[0], TIME - TIME[0], atol=1e-6)
    np.testing.assert_array_equal(made.position, np.sin(3.0 * TIME))


def test_a_column_of_times_counts_before_an_index_of_the_same_name() -> None:
    frame = pd.DataFrame({"time": TIME, "position": np.sin(TIME)})
    frame.index = pd.Index(np.arange(200.0), name="time")
    np.testing.assert_array_equal(Recording.from_dataframe(frame).time, TIME)


def test_an_index_that_numbers_rows_is_no_time() -> None:
    frame = pd.DataFrame({"position": np.sin(TIME)})
    with pytest.raises(InputError, match="time"):
        Recording.from_dataframe(frame)


def test_a_dataset_with_one_time_is_read_as_its_data_frame() -> None:
    class Dataset:
        """What of xarray's Dataset counts."""

        data_vars = ("position",)

        def to_dataframe(self) -> pd.DataFrame:
            return pd.DataFrame({"position": np.sin(TIME)}, index=pd.Index(TIME, name="time"))

    np.testing.assert_array_equal(Recording.from_dataframe(Dataset()).time, TIME)


def test_a_damaged_description_in_a_data_frame_is_said() -> None:
    frame = recording().to_pandas()
    frame.attrs["jointid_recording"] = '{"schema": 99}'
    with pytest.raises(InputError, match="data frame, attrs"):
        Recording.from_dataframe(frame)


def test_a_notebook_shows_signals_with_units_and_escapes_names() -> None:
    shown = recording(name="<b>x</b>", extra={"load": TIME})._repr_html_()
    assert "&lt;b&gt;x" in shown
    for text in ("position", "rad", "N·m", "load (extra)", "velocity (derived)", "10 ms"):
        assert text in shown


def test_an_index_without_a_name_is_not_taken_for_time_and_the_error_says_so() -> None:
    frame = pd.DataFrame({"position_rad": np.sin(TIME), "torque_Nm": np.cos(TIME)}, index=TIME)
    with pytest.raises(InputError, match=r"index has no name \(rename_axis\('time_s'\)"):
        Recording.from_dataframe(frame)
    assert Recording.from_dataframe(frame.rename_axis("time_s")).time[0] == TIME[0]
    with pytest.raises(InputError, match=r"^data frame: the file has no time column"):
        Recording.from_dataframe(frame.reset_index(drop=True))
