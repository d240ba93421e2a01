"""Extra signals of a recording: they survive whatever a recording goes through."""

import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import jointid as jid
from jointid.base.errors import InputError
from jointid.recording.shifting import shifted

TIME = np.arange(200) * 0.01
RATE = np.cos(3.0 * TIME)


def recording(**changes: Any) -> jid.Recording:
    fields: dict[str, Any] = {
        "time": TIME,
        "position": np.sin(TIME),
        "torque": np.round(np.cos(TIME), 1),
        "extra": {"rate": RATE, "model": TIME**2},
        "metadata": {"extra_units": {"rate": "rad/s"}},
    }
    return jid.Recording(**{**fields, **changes})


def test_extra_signals_are_read_only_and_checked() -> None:
    run = recording()
    assert list(run.extra) == ["rate", "model"]
    assert np.array_equal(run.extra["rate"], RATE)
    with pytest.raises(TypeError):
        run.extra["rate"] = RATE  # type: ignore[index]
    with pytest.raises(ValueError, match="read-only"):
        run.extra["rate"][0] = 1.0
    assert (run.unit("rate"), run.unit("model")) == ("rad/s", "")
    assert "extra rate" in repr(run)
    for extra, message in (
        ({"rate": RATE[:-1]}, "199 samples, but time has 200"),
        ({"rate": np.where(TIME == 0.5, np.nan, RATE)}, "finite"),
        ({"q6 rate": RATE}, "letters, digits"),
        ({"torque": RATE}, "this name is reserved for a signal"),
        ([RATE], "mapping"),
    ):
        with pytest.raises(InputError, match=message):
            recording(extra=extra)


def test_equality_and_fingerprint_see_extra_signals() -> None:
    run = recording()
    assert run == recording()
    other = recording(extra={"rate": RATE, "model": TIME})
    assert run != other
    assert run.fingerprint != other.fingerprint
    assert recording(extra=None).fingerprint != run.fingerprint


@pytest.mark.parametrize("ending", [".csv", ".csv.gz", ".npz"])
def test_extra_signals_survive_a_file(ending: str, tmp_path: Path) -> None:
    run = recording()
    run.save(tmp_path / f"run{ending}")
    assert jid.load(tmp_path / f"run{ending}", name="") == run
    assert jid.load(tmp_path / f"run{ending}", extra=["rate"], name="") == run


def test_extra_signals_survive_parts_and_changes() -> None:
    run = recording()
    assert np.array_equal(run.crop(0.5, 1.0).extra["rate"], RATE[50:101])
    assert np.array_equal(run.split(2)[1].extra["rate"], RATE[100:])
    assert np.array_equal(run.with_velocity(RATE).extra["rate"], RATE)
    assert np.array_equal(shifted(run, {"torque": 0.02}).extra["rate"], RATE[:-2])
    fine = run.resample(period=0.005)
    assert np.allclose(fine.extra["rate"], np.interp(fine.time, TIME, RATE))
    changed = run.with_signals(torque=RATE, extra={"third": TIME})
    assert list(changed.extra) == ["rate", "model", "third"]
    assert changed.torque is not None
    assert np.array_equal(changed.torque, RATE)
    kept = run.with_signals(rows=TIME < 1.0)
    assert len(kept) == len(kept.extra["rate"]) == 100
    with pytest.raises(InputError, match="not a signal"):
        run.with_signals(rate=RATE)


def test_rows_that_repeat_are_dropped_with_their_extra_signals(tmp_path: Path) -> None:
    position = np.repeat(np.random.default_rng(1).normal(size=100), 2)
    table = np.column_stack([TIME, position, RATE])
    path = tmp_path / "run.csv"
    np.savetxt(path, table, delimiter=",", header="time_s,position_rad,rate", comments="")
    run = jid.load(path, extra=["rate"], drop_copies=True)
    assert np.array_equal(run.extra["rate"], RATE[::2])


def test_columns_are_kept_by_header_or_name_and_converted(tmp_path: Path) -> None:
    path = tmp_path / "arm.csv"
    lines = [f"{t},{t},{10 * t},{t},word,{1000 * t}" for t in TIME[:20].tolist()]
    headers = "time_s,position_rad,speed 6 [deg/s],model_kNm,note,inertia_gcm2"
    path.write_text("\n".join([headers, *lines, ""]))
    assert jid.load(path).extra == {}
    run = jid.load(
        path, extra={"q6_rate": "speed 6 [deg/s]", "model": "model_kNm", "inertia": "inertia_gcm2"}
    )
    assert np.allclose(run.extra["q6_rate"], np.deg2rad(10 * TIME[:20]))
    assert np.allclose(run.extra["model"], 1000 * TIME[:20])
    assert np.allclose(run.extra["inertia"], 1e-4 * TIME[:20])
    assert [run.unit(name) for name in run.extra] == ["rad/s", "N·m", "kg·m²"]
    assert list(jid.load(path, extra=["model_kNm"]).extra) == ["model_kNm"]
    for extra, message in (
        (["note"], r"line 2, column 'note'"),
        (["speed 6 [deg/s]"], r"extra=\{'speed_6_deg_s'"),
        (["modle_kNm"], "did you mean 'model_kNm'"),
        ("model_kNm", "headers of columns"),
    ):
        with pytest.raises(InputError) as caught:
            jid.load(path, extra=extra)
        assert re.search(message, str(caught.value)), caught.value


def test_a_data_frame_keeps_columns_too() -> None:
    pandas = pytest.importorskip("pandas")
    frame = pandas.DataFrame({"time": TIME, "position": np.sin(TIME), "rate": RATE})
    run = jid.Recording.from_dataframe(frame, extra=["rate"])
    assert np.array_equal(run.extra["rate"], RATE)
