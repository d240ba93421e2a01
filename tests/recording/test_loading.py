"""Loading: the files people have, and one helpful sentence for those that cannot be used."""

import math
import os
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from recording_files import ROWS, N, column, lines, npz, refusal, written

from jointid.base.errors import InputError
from jointid.recording.readers.loading import load
from jointid.recording.recording import Recording


@pytest.mark.parametrize(
    ("header", "signal", "factor"),
    [
        ("torque_Nm", "torque", 1.0),
        ("TAU [mN·m]", "torque", 1e-3),
        ("force_Nm", "torque", 1.0),
        ("motor_torque_output_Nm", "torque", 1.0),
        ("output_torque (kNm)", "torque", 1e3),
        ("vel_deg_s", "velocity", math.pi / 180),
        ("Speed rpm", "velocity", math.pi / 30),
        ("velocity[rad/s]", "velocity", 1.0),
        ("sensor_raw", "sensor", 1.0),
        ("torque_sensor_mV", "sensor", 1e-3),
        ("sensor", "sensor", 1.0),
        ("position_ref_deg", "reference", math.pi / 180),
        ("goal position (rad)", "reference", 1.0),
        ("Position_Reference_mrad", "reference", 1e-3),
        ("link_position_rad", "link_position", 1.0),
        ("temperature [°C]", "temperature", 1.0),
        ("motor_torque_mNm", "motor_torque", 1e-3),
        ("motor_current_mA", "current", 1e-3),
        ('"current, A"', "current", 1.0),
    ],
)
def test_headers_are_recognised(header: str, signal: str, factor: float, tmp_path: Path) -> None:
    header = header.replace("current, A", "current (A)")  # quoted, as spreadsheets do
    loaded = load(written(tmp_path / "run.csv", lines(f"t_s,q_rad,{header}")))
    others = {"time", "position", "velocity"}
    assert set(loaded.signals) == others | {signal}
    assert loaded.velocity_derived == (signal != "velocity")
    expected = np.array(column(2)) * factor
    np.testing.assert_allclose(getattr(loaded, signal), expected, rtol=1e-14)
    kept = (
        signal in ("torque", "motor_torque", "sensor") and factor != 1.0
    )  # to read it with the other sign
    assert dict(loaded.metadata) == ({"scale": {signal: factor}} if kept else {})
    assert loaded.name == "run"


@pytest.mark.parametrize("ending", [".csv", ".csv.gz", ".CSV"])
def test_plain_file(ending: str, tmp_path: Path) -> None:
    text = lines("time_ms,position_deg,velocity_rad_s,torque_Nm")
    loaded = load(written(tmp_path / f"my.run{ending}", text), torque_hold="zoh")
    assert loaded.time.tolist() == [row[0] / 1000 for row in ROWS]
    np.testing.assert_allclose(loaded.position, np.deg2rad(column(1)))
    assert loaded.velocity.tolist() == column(2)
    assert loaded.torque is not None
    assert loaded.torque.tolist() == column(3)
    assert (loaded.name, loaded.kind, loaded.torque_hold) == ("my.run", "revolute", "zoh")


def test_si_is_assumed_and_noted(tmp_path: Path) -> None:
    loaded = load(written(tmp_path / "a.csv", lines("time,angle,vel_rad_s,sensor")))
    assert loaded.metadata == {"assumed_units": ["time", "position"]}
    assert load(tmp_path / "a.csv", units={"position": "rad"}).metadata == {
        "assumed_units": ["time"],
        "stated_units": {"position": "rad"},
    }


@pytest.mark.parametrize(
    ("header", "kind"),
    [
        ("t,pos_mm,vel_mm_s,force_N", "prismatic"),
        ("t,pos,vel,force_N", "prismatic"),
        ("t,pos,vel,tau_Nm", "revolute"),
        ("t,pos,vel,tau", "revolute"),
        ("t,pos_m,position_ref_m,motor_torque_Nm", "prismatic"),
    ],
)
def test_units_show_the_kind(header: str, kind: str, tmp_path: Path) -> None:
    assert load(written(tmp_path / "a.csv", lines(header))).kind == kind


def test_kind_can_be_given(tmp_path: Path) -> None:
    path = written(tmp_path / "a.csv", lines("t,pos,vel,force"))
    assert load(path, kind="prismatic").unit("torque") == "N"


def test_columns_by_header_number_or_none(tmp_path: Path) -> None:
    path = written(tmp_path / "a.csv", lines("time_s,axis_1_deg,velocity_rad_s,torque_Nm"))
    loaded = load(path, columns={"position": "Axis_1_deg", "sensor": 3, "velocity": None})
    np.testing.assert_allclose(loaded.position, np.deg2rad(column(1)))
    assert loaded.signals == ("time", "position", "velocity", "sensor")
    assert loaded.velocity_derived
    assert loaded.sensor is not None
    assert loaded.sensor.tolist() == column(3)


def test_units_override_the_header(tmp_path: Path) -> None:
    path = written(tmp_path / "a.csv", lines("t_s,q_rad,velocity_s"))
    loaded = load(path, units={"position": "deg", "velocity": "rpm"}, name="other")
    np.testing.assert_allclose(loaded.position, np.deg2rad(column(1)))
    np.testing.assert_allclose(loaded.velocity, np.array(column(2)) * math.pi / 30)
    assert loaded.name == "other"


def test_the_fitting_one_of_two_columns_is_taken(tmp_path: Path) -> None:
    path = written(tmp_path / "a.csv", lines("t_s,q_raw,q_rad,torque_enabled"))
    loaded = load(path)
    assert loaded.position.tolist() == column(2)
    assert loaded.torque is None


def test_where_keeps_matching_rows(tmp_path: Path) -> None:
    rows = [f"{run},{'ab'[run]},{0.1 * k!r},{k + 100 * run}" for run in (0, 1) for k in range(9)]
    path = written(tmp_path / "a.csv", ["run,name,t_s,q_rad", *rows])
    choices: list[dict[str, float | str]] = [{"run": 1}, {"name": "b"}, {"RUN": 1.0, "name": "b"}]
    for where in choices:
        assert load(path, where=where).position.tolist() == [100.0 + k for k in range(9)]
    with pytest.raises(
        InputError, match=r"line 11, column 't_s': time is .* with where=\{'run': 0\} "
    ):
        load(path)


def test_where_and_bad_rows_name_the_line_of_the_file(tmp_path: Path) -> None:
    rows = [f"{run},{0.1 * k!r},{k}" for run in (0, 1) for k in range(9)]
    rows[13] = "1,0.4,nan"
    path = written(tmp_path / "a.csv", ["# a", "", "run,t_s,q_rad", "", *rows])
    with pytest.raises(InputError, match=r"a\.csv, line 18, column 'q_rad': position is nan"):
        load(path, where={"run": 1})


@pytest.mark.parametrize("end", ["\n", "\r\n", "\r"])
def test_line_ends_comments_blanks_and_byte_order_mark(end: str, tmp_path: Path) -> None:
    text = ["\ufeff# from a drive", " ", *lines("t_s, q_rad ,velocity_rad_s"), "", " ", ""]
    loaded = load(written(tmp_path / "a.csv", end.join(text)))
    assert loaded.velocity.tolist() == column(2)


def test_header_in_a_comment_and_no_header(tmp_path: Path) -> None:
    rows = lines("a,b,c,d")[1:]
    commented = load(written(tmp_path / "a.csv", ["# t_s,q_deg,velocity_rad_s,torque_Nm", *rows]))
    np.testing.assert_allclose(commented.position, np.deg2rad(column(1)))
    bare = written(tmp_path / "b.csv", rows)
    loaded = load(bare, columns={"time": 0, "position": 1, "torque": 3})
    assert len(loaded) == N
    assert loaded.torque is not None
    assert loaded.torque.tolist() == column(3)
    assert loaded.metadata["assumed_units"] == ["time", "position", "torque"]


def test_foreign_npz(tmp_path: Path) -> None:
    path = npz(
        tmp_path / "a.npz",
        time_ms=np.arange(N),
        q=np.array(column(1), dtype=np.float32),
        torque_Nm=column(3),
        run=np.arange(N) // 9,
        notes=np.array(["x"]),
        pickled=np.array([{}], dtype=object),
    )
    loaded = load(path)
    assert loaded.signals == ("time", "position", "velocity", "torque")
    assert loaded.time.tolist() == [k / 1000 for k in range(N)]
    assert loaded.metadata == {"assumed_units": ["position"]}
    assert len(load(path, where={"run": 0}, columns={"torque": None})) == 9


def frame() -> Any:
    pandas = pytest.importorskip("pandas")
    table = pandas.DataFrame(ROWS, columns=["t_s", "pos_deg", 7, "torque_Nm"])
    table.index = table.index + 100
    return table


def test_from_dataframe() -> None:
    made = Recording.from_dataframe(frame(), columns={"sensor": 2}, torque_hold="linear")
    np.testing.assert_allclose(made.position, np.deg2rad(column(1)))
    assert made.sensor is not None
    assert made.sensor.tolist() == column(2)
    assert (made.kind, made.torque_hold, made.name) == ("revolute", "linear", "")
    assert len(Recording.from_dataframe(frame().iloc[1:], units={"position": "rad"})) == N - 1


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (
            lambda f: f.assign(pos_deg=np.nan),
            "data frame, row 0, column 'pos_deg': position is nan",
        ),
        (lambda f: f.assign(pos_deg="x"), "data frame, column 'pos_deg': 'x' at index 0 is not"),
        (
            lambda f: f.astype({"pos_deg": "datetime64[ns]"}),
            "column 'pos_deg': an array of numbers is expected",
        ),
        (lambda f: f.drop(columns="t_s"), "data frame: no column is recognised as time"),
        (lambda f: f.to_numpy(), "df is a ndarray: a data frame with columns is expected"),
    ],
)
def test_bad_frames(change: Callable[[Any], Any], message: str) -> None:
    with pytest.raises(InputError, match=message):
        Recording.from_dataframe(change(frame()))


POSITION = "motor_encoder_pos_1_linkside_rad"
KR300 = {
    "position": POSITION,
    "velocity": "motor_encoder_vel_1_linkside_rad_s",
    "motor_torque": "motor_torque_1_Nm",
}
PLAIN = ("time", "position", "velocity", "torque")


@pytest.mark.parametrize(
    ("file", "arguments", "kind", "signals", "length"),
    [
        ("ak80/ak80_swing_up.csv", {}, "revolute", PLAIN, 3000),
        ("ak80/ak80_energy_shaping.csv", {}, "revolute", PLAIN, 4000),
        ("simulated/well_excited.csv.gz", {}, "revolute", (*PLAIN, "sensor"), 12000),
        ("simulated/poorly_excited.csv.gz", {}, "revolute", (*PLAIN, "sensor"), 6000),
        ("simulated/rippled.csv.gz", {}, "revolute", (*PLAIN, "sensor"), 12000),
        ("simulated/realistic.csv.gz", {}, "revolute", (*PLAIN, "sensor"), 6000),
        (
            *("xl330/bam_xl330.csv.gz", {"where": {"run_index": 0}}, "revolute"),
            *((*PLAIN[:3], "reference", "temperature"), 1124),
        ),
        (
            *("kr300/kr300_A.csv.gz", {"columns": KR300}, "revolute"),
            *((*PLAIN[:3], "motor_torque"), 2501),
        ),
    ],
)
def test_shared_recordings(
    file: str,
    arguments: Mapping[str, Any],
    kind: str,
    signals: tuple[str, ...],
    length: int,
    shared_data: Path,
    tmp_path: Path,
) -> None:
    loaded = load(shared_data / file, **arguments)
    assert (loaded.kind, loaded.signals, len(loaded)) == (kind, signals, length)
    assert not loaded.velocity_derived
    assert dict(loaded.metadata) == {}
    loaded.save(tmp_path / "again.csv")
    assert load(tmp_path / "again.csv") == loaded


def test_emps_has_no_velocity_of_its_own(emps: Path, tmp_path: Path) -> None:
    loaded = load(emps / "emps_train.csv.gz")
    assert (loaded.kind, loaded.signals, len(loaded)) == (
        "prismatic",
        (*PLAIN, "reference"),
        24841,
    )
    assert loaded.velocity_derived
    assert dict(loaded.metadata) == {}
    loaded.save(tmp_path / "again.csv")
    assert load(tmp_path / "again.csv") == loaded


def test_several_axes_are_refused_with_a_remedy(shared_data: Path) -> None:
    error_text = refusal(shared_data / "kr300" / "kr300_A.csv.gz")
    assert "6 joints (1, 2, 3, 4, 5, 6)" in error_text
    assert "load with joint=1" in error_text


def test_several_runs_are_refused_with_a_remedy(shared_data: Path) -> None:
    error_text = refusal(shared_data / "xl330" / "bam_xl330.csv.gz")
    assert "line 1126, column 'time_s'" in error_text
    assert "; load with where={'run_index': 0} (one run) or load with by='run_index'" in error_text


def test_a_file_name_that_is_not_utf8_is_replaced_once(tmp_path: Path) -> None:
    original = tmp_path / "run.csv"
    table = (f"{0.01 * i},{1e-4 * i * i},{i}" for i in range(101))
    original.write_text("\n".join(["time_s,position_rad,torque_Nm", *table, ""]))
    odd = tmp_path / os.fsdecode(b"caf\xe9.csv")
    try:
        original.rename(odd)
    except OSError:
        pytest.skip("this file system has no such names")
    loaded = load(odd)
    assert loaded.name == "caf\ufffd"
    for ending in (".npz", ".csv"):
        loaded.save(tmp_path / f"again{ending}")
    assert load(tmp_path / "again.npz").name == loaded.name
