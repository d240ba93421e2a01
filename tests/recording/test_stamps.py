"""Time stamps as other programs write them: exact to a nanosecond, or refused."""

import tracemalloc
from datetime import UTC, datetime, timedelta, timezone
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from recording_files import refusal, written

from jointid.recording.readers.loading import load
from jointid.recording.recording import Recording
from jointid.recording.stamps import looks_exact, stamps_of
from jointid.recording.units import UNITS

START = datetime(2024, 10, 27, 0, 59, 59, 999000, tzinfo=UTC)
N = 12


def log(folder: Path, header: str, stamps: list[str]) -> Path:
    rows = [f"{stamp},{k * k},{k}" for k, stamp in enumerate(stamps)]
    return written(folder / "a.csv", [f"{header},q_rad,tau_Nm", *rows])


def milliseconds(recording: Recording) -> list[float]:
    return [round(float(each), 12) for each in recording.time * 1000.0]


STEPS = [START + timedelta(microseconds=1000 * k) for k in range(N)]
NANOSECONDS = 1729990799999000123
ISO = {
    "zone": [each.isoformat() for each in STEPS],
    "blank": [f"{each:%Y-%m-%d %H:%M:%S.%f}" for each in STEPS],
    "letter": [f"{each:%Y-%m-%dT%H:%M:%S.%f}000Z" for each in STEPS],
    "comma": [f'"{each:%Y-%m-%dT%H:%M:%S},{each:%f}Z"' for each in STEPS],
    # Clocks go back at 01:00 UTC of this day in Central Europe: the zones tell the hours apart.
    "daylight": [
        each.astimezone(timezone(timedelta(hours=2 if each.hour == 0 else 1))).isoformat()
        for each in STEPS
    ],
    "ns": [str(NANOSECONDS + 10**6 * k) for k in range(N)],
    "us": [str(NANOSECONDS // 1000 + 1000 * k) for k in range(N)],
    "ms": [str(NANOSECONDS // 10**6 + k) for k in range(N)],
    "s": [f"{NANOSECONDS // 10**9}.{k * 10**6 + 123:09d}" for k in range(N)],
    "file time": [str(133456789012345678 + 10**4 * k) for k in range(N)],
    "ethercat": [str(782735624000000000 + 10**6 * k) for k in range(N)],
}


@pytest.mark.parametrize("form", ISO)
def test_stamps_become_seconds_since_the_first(form: str, tmp_path: Path) -> None:
    loaded = load(log(tmp_path, "timestamp", ISO[form]))
    assert milliseconds(loaded) == [float(k) for k in range(N)]
    assert loaded.metadata["first_stamp"] == ISO[form][0].strip('"')
    by_size = form in ("ns", "us", "ms", "s", "file time", "ethercat")
    assert ("recognised_units" in loaded.metadata) == by_size
    assert "assumed_units" not in loaded.metadata


def test_a_stated_unit_is_obeyed(tmp_path: Path) -> None:
    loaded = load(log(tmp_path, "timestamp_us", ISO["ns"]))
    assert loaded.time[1] == 1.0
    assert "recognised_units" not in loaded.metadata
    assert load(log(tmp_path, "timestamp", ISO["ns"]), units={"time": "us"}).time[1] == 1.0


@pytest.mark.parametrize(
    ("headers", "parts"),
    [
        ("header.stamp.secs,header.stamp.nsecs", 10**9),
        ("sec,nanosec", 10**9),
        ("stamp_sec,stamp_nanosec", 10**9),
        ("tv_sec,tv_usec", 10**6),
        ("secs,nsecs", 10**9),
    ],
)
def test_seconds_and_their_fraction_are_one(headers: str, parts: int, tmp_path: Path) -> None:
    whole = [divmod(NANOSECONDS + 10**6 * k, 10**9) for k in range(N)]
    stamps = [f"{second},{rest * parts // 10**9}" for second, rest in whole]
    loaded = load(log(tmp_path, headers, stamps))
    assert milliseconds(loaded) == [float(k) for k in range(N)]
    assert "left_out" not in loaded.metadata


def test_seconds_beside_all_their_nanoseconds(tmp_path: Path) -> None:
    stamps = [f"{k * 0.001},{k * 10**6}" for k in range(N)]
    loaded = load(log(tmp_path, "time_sec,time_nsec", stamps))
    assert milliseconds(loaded) == [float(k) for k in range(N)]


@pytest.mark.parametrize(
    ("step", "unit", "seconds"),
    [(1_000_000, "ns", 0.001), (2000, "us", 0.002), (250_000, "ns", 0.00025)],
)
def test_small_stamps_are_recognised_by_their_steps(
    step: int, unit: str, seconds: float, tmp_path: Path
) -> None:
    loaded = load(log(tmp_path, "time", [str(step * k) for k in range(N)]))
    assert loaded.sample_period == pytest.approx(seconds)
    assert loaded.metadata["recognised_units"] == {"time": unit}
    assert "assumed_units" not in loaded.metadata


@pytest.mark.parametrize(("step", "units"), [(100, ["us", "ms"]), (100_000, ["ns", "us"])])
def test_steps_that_may_be_either_are_asked_for(
    step: int, units: list[str], tmp_path: Path
) -> None:
    path = log(tmp_path, "time", [str(step * k) for k in range(N)])
    message = refusal(path)
    advice = " or ".join(f"load with units={{'time': '{unit}'}}" for unit in units)
    assert message.endswith(advice), message
    assert load(path, units={"time": units[0]}).time[1] == pytest.approx(
        UNITS[units[0]].factor * step
    )


def test_a_date_that_is_none_names_the_cell(tmp_path: Path) -> None:
    path = log(tmp_path, "time", ["2024-02-30T00:00:00Z", *ISO["zone"][1:]])
    assert "line 2, column 'time': '2024-02-30T00:00:00Z' is not a number" in refusal(path)


@given(
    st.lists(st.integers(0, 2**62), min_size=1, max_size=20), st.sampled_from(["ns", "us", "ms"])
)
def test_integers_keep_every_nanosecond(values: list[int], unit: str) -> None:
    stamps = stamps_of([str(value) for value in values], UNITS[unit])
    assert stamps is not None
    factor = {"ns": 10**9, "us": 10**6, "ms": 10**3}[unit]
    np.testing.assert_array_equal(
        stamps.seconds, [float(value - values[0]) / factor for value in values]
    )


@given(
    st.lists(st.datetimes(datetime(1980, 1, 1), datetime(2100, 1, 1)), min_size=1, max_size=10),
    st.integers(-12 * 60, 14 * 60),
    st.integers(0, 999),
    st.sampled_from("T "),
)
def test_dates_keep_every_nanosecond(
    days: list[datetime], offset: int, nanoseconds: int, between: str
) -> None:
    zone = timezone(timedelta(minutes=offset))
    aware = [day.replace(tzinfo=zone) for day in days]
    cells = []
    for each in aware:
        text = f"{each:%z}"
        cells.append(
            f"{each:%Y-%m-%d}{between}{each:%H:%M:%S.%f}{nanoseconds:03d}{text[:3]}:{text[3:]}"
        )
    stamps = stamps_of(cells, None)
    assert stamps is not None
    expected = [(each - aware[0]) // timedelta(microseconds=1) * 1000 for each in aware]
    np.testing.assert_array_equal(stamps.seconds, np.array(expected, dtype=np.float64) / 10**9)


@given(st.lists(st.text(max_size=40), max_size=5))
def test_any_text_is_stamps_or_none(cells: list[str]) -> None:
    for cell in cells:
        assert looks_exact(cell) in (True, False)
    stamps_of(cells, None)
    stamps_of(cells, UNITS["ns"])


@pytest.mark.parametrize("value", ["1e300", "-1e300", "1.7976931348623157e308", "9.9e37"])
@pytest.mark.parametrize("column", [1, 2])
def test_absurd_values_are_refused(value: str, column: int, tmp_path: Path) -> None:
    rows = [[f"{k}e-3", str(k), str(k)] for k in range(N)]
    rows[5][column] = value
    path = written(tmp_path / "a.csv", ["t_s,q_rad,tau_Nm", *map(",".join, rows)])
    message = refusal(path)
    assert "line 7, column" in message
    assert "this value is impossible for a joint" in message


@pytest.mark.parametrize(
    ("cells", "seconds"),
    [
        (["01.11.2025 12:26:40.000000", "01.11.2025 12:26:40.002000"], [0.0, 0.002]),
        (["31.10.2025 23:59:59,5", "01.11.2025 00:00:00,25"], [0.0, 0.75]),
        (["1.2.2025 9:26:40", "1.2.2025 9:26:41"], [0.0, 1.0]),
        (["12:26:40.5", "12:26:41", "12:26:41.25"], [0.0, 0.5, 0.75]),
        (["23:59:59.5", "00:00:00.5"], [0.0, 1.0]),
        (["31/01/2025 23:59:59", "01/02/2025 00:00:00"], [0.0, 1.0]),
        (["01/31/2025 23:59:59", "02/01/2025 00:00:00"], [0.0, 1.0]),
        (["01/02/2025 10:00:00", "01/02/2025 10:00:01"], [0.0, 1.0]),  # either way
        (["01/02/2025 23:59:59", "02/02/2025 00:00:00"], None),
        (["12:26:40.5", "now"], None),
        (["32.01.2025 10:00:00", "32.01.2025 10:00:01"], None),
    ],
)
def test_dates_with_the_day_first_and_clock_times(
    cells: list[str], seconds: list[float] | None
) -> None:
    found = stamps_of(cells, None)
    assert (found.seconds.tolist() if found else None) == seconds


@pytest.mark.parametrize(
    "form",
    [
        "2025-11-{d:02d} {h:02d}:{m:02d}:{s:02d}.5",
        "{d:02d}.11.2025 {h:02d}:{m:02d}:{s:02d}",
        "{d:02d}/11/2025 {h:02d}:{m:02d}:{s:02d}",
        "{h:02d}:{m:02d}:{s:02d}.5",
        "17299908{d:02d}{h:02d}{m:02d}{s:02d}123",
    ],
)
def test_many_stamps_take_little_beside_their_texts(form: str) -> None:
    cells = [
        form.format(d=13 + k // 86400, h=k // 3600 % 24, m=k // 60 % 60, s=k % 60)
        for k in range(20_000)
    ]
    stamps_of(cells[:10], None, "")
    tracemalloc.start()
    found = stamps_of(cells, None, "")
    _, peak = tracemalloc.get_traced_memory()
    tracemalloc.stop()
    assert found is not None
    assert len(found.seconds) == len(cells)
    assert peak < 250 * len(cells)  # with a match and a second of each: 700
