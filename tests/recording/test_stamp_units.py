"""Stamps without a stated unit, in every form of file: their true steps, or a refusal that tells how."""

from fractions import Fraction
from pathlib import Path
from typing import Any

import h5py
import numpy as np
import pandas
import pytest
from hypothesis import HealthCheck, example, given, settings
from hypothesis import strategies as st
from recording_files import mat, npz, written

from jointid.base.advice import Action
from jointid.base.errors import InputError
from jointid.recording.readers.loading import load
from jointid.recording.recording import Recording

N = 12
EPOCH = 1_732_262_400_123_456_789  # ns
UPTIMES = (0, 2 * 10**12, 2 * 10**15, 9 * 10**16)  # ns
PARTS = {"ms": 10**3, "us": 10**6, "ns": 10**9}
FORMATS = ("csv", "npz", "h5", "parquet", "mat")


def saved(folder: Path, form: str, stamps: Any) -> Path:
    path = folder / f"a.{form}"
    columns = {"timestamp": np.asarray(stamps), "q_rad": np.arange(N) ** 2.0}
    if form == "csv":
        rows = [f"{stamp},{k * k}" for k, stamp in enumerate(stamps)]
        return written(path, ["timestamp,q_rad", *rows])
    if form == "npz":
        return npz(path, **columns)
    if form == "mat":
        return mat(path, columns)
    if form == "parquet":
        pandas.DataFrame(columns).to_parquet(path)
        return path
    with h5py.File(path, "w") as file:
        for name, values in columns.items():
            file[name] = values
    return path


def pastes(error: InputError) -> list[dict[str, Any]]:
    return [dict(each.arguments) for each in error.remedy if isinstance(each, Action)]


def true_steps(recording: Recording, stamps: list[int], parts: int) -> bool:
    expected = [float(Fraction(each - stamps[0], parts)) for each in stamps]
    return bool(np.abs(recording.time - recording.time[0] - expected).max() < 1e-9)


@settings(
    max_examples=150, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture]
)
@given(
    st.sampled_from(list(PARTS)),
    st.sampled_from((EPOCH, *UPTIMES)),
    st.floats(10.0, 20_000.0),
    st.sampled_from(FORMATS),
)
@example("ns", EPOCH, 20_000.0, "h5")
@example("ns", EPOCH, 4_000.0, "npz")
@example("ns", 2 * 10**15, 8_000.0, "csv")
@example("ns", 2 * 10**15, 10_000.0, "csv")
@example("ns", 2 * 10**12, 1_000.0, "csv")
@example("us", EPOCH, 10.0, "mat")
@example("ms", EPOCH, 10.0, "parquet")
@example("ms", 0, 1_000.0, "csv")
def test_never_a_silent_wrong_unit(
    tmp_path: Path, unit: str, origin: int, rate: float, form: str
) -> None:
    parts = PARTS[unit]
    step = round(10**9 / rate) * parts / 10**9
    if step < 1.0:  # whole numbers cannot count these
        return
    stamps = [origin * parts // 10**9 + round(step * k) for k in range(N)]
    path = saved(tmp_path, form, stamps)
    asked: list[str] = []
    try:
        loaded = load(path)
    except InputError as error:
        asked = [each["units"]["time"] for each in pastes(error) if "units" in each]
    if asked:
        assert unit in asked
        loaded = load(path, units={"time": unit})
    else:
        assert loaded.metadata["recognised_units"] == {"time": unit}
    assert true_steps(loaded, stamps, parts)


@pytest.mark.parametrize("form", FORMATS)
@pytest.mark.parametrize("origin", [EPOCH, 0])
def test_seconds_with_a_fraction(form: str, origin: int, tmp_path: Path) -> None:
    whole = [origin + 10**6 * k for k in range(N)]
    texts = [f"{each // 10**9}.{each % 10**9:09d}" for each in whole]
    loaded = load(
        saved(tmp_path, form, texts if form == "csv" else [float(each) for each in texts])
    )
    # Floats hold seconds since 1970 to 0.24 µs.
    close = 1e-9 if form == "csv" or not origin else 2.5e-7
    np.testing.assert_allclose(np.diff(loaded.time), 0.001, rtol=0, atol=close)


def test_seconds_with_three_digits_are_not_rounded(tmp_path: Path) -> None:
    loaded = load(saved(tmp_path, "csv", [f"{1_732_262_400 + k / 1000:.3f}" for k in range(N)]))
    np.testing.assert_allclose(loaded.time, np.arange(N) / 1000, rtol=0, atol=1e-15)


@pytest.mark.parametrize("form", ["npz", "h5", "mat"])
def test_unsigned_and_stated_units_stay_exact(form: str, tmp_path: Path) -> None:
    stamps = np.array([EPOCH + 50_000 * k + k % 2 for k in range(N)], dtype=np.uint64)
    expected = [(50_000 * k + k % 2) / 1e9 for k in range(N)]
    path = saved(tmp_path, form, stamps)
    assert load(path).time.tolist() == expected
    assert load(path, units={"time": "ns"}).time.tolist() == expected


@pytest.mark.parametrize("zone", [None, "Europe/Berlin"])
@pytest.mark.parametrize("unit", ["ns", "us"])
@pytest.mark.parametrize("form", ["frame", "parquet", "object"])
def test_dates_of_frames_are_exact(form: str, unit: str, zone: str | None, tmp_path: Path) -> None:
    dates = pandas.to_datetime([EPOCH // 1000 * 1000 + 250_000 * k for k in range(N)], utc=True)
    dates = dates.as_unit(unit).tz_convert(zone)  # type: ignore[arg-type]
    frame = pandas.DataFrame({"time": dates, "q_rad": np.arange(N) ** 2.0})
    if form == "parquet":
        frame.to_parquet(tmp_path / "a.parquet")
        loaded = load(tmp_path / "a.parquet")
    else:
        loaded = Recording.from_dataframe(frame)
    assert loaded.time.tolist() == [250_000 * k / 1e9 for k in range(N)]
    assert loaded.metadata.get("assumed_units") is None
    assert loaded.metadata["first_stamp"].startswith("2024-11-22")


def test_integers_of_frames_are_exact() -> None:
    stamps = [EPOCH + 50_000 * k for k in range(N)]
    frame = pandas.DataFrame({"time": stamps, "q_rad": np.arange(N) ** 2.0})
    for each in (frame, frame.astype({"time": object})):
        loaded = Recording.from_dataframe(each)
        assert loaded.time.tolist() == [50_000 * k / 1e9 for k in range(N)]


def test_a_date_that_is_missing_is_named() -> None:
    dates = np.array([EPOCH + 10**6 * k for k in range(N)]).astype("M8[ns]")
    dates[3] = np.datetime64("NaT", "ns")
    frame = pandas.DataFrame({"time": dates, "q_rad": np.arange(N) ** 2.0})
    with pytest.raises(InputError, match="row 3, column 'time': the cell is empty"):
        Recording.from_dataframe(frame)


def test_a_joint_among_several_keeps_its_nanoseconds(tmp_path: Path) -> None:
    stamps = np.array([EPOCH + 50_000 * k for k in range(N)])
    q = np.arange(N) ** 2.0
    path = npz(tmp_path / "a.npz", timestamp=stamps, q_1=q, q_2=q + 1.0)
    assert load(path, joint=2).time.tolist() == [50_000 * k / 1e9 for k in range(N)]


@pytest.mark.parametrize(("step", "advised"), [(1, ["ms", "rate"]), (2, ["ms"])])
def test_no_unit_is_proposed_that_would_be_refused(
    step: int, advised: list[str], tmp_path: Path
) -> None:
    """Seconds would be too slow for any friction; a count of rows needs the rate."""
    with pytest.raises(InputError) as caught:
        load(saved(tmp_path, "csv", [step * k for k in range(N)]))
    assert [each.get("units", {}).get("time", "rate") for each in pastes(caught.value)] == advised
