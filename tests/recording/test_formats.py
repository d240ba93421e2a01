"""Parquet files, any bytes under any name, scales, and several runs in one file."""

import builtins
import re
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st
from recording_files import ROWS, N, assert_one_sentence, column, headed, mat, npz, refusal, written

from jointid.base.advice import Action
from jointid.base.errors import InputError
from jointid.recording.readers.loading import load, load_runs
from jointid.recording.recording import Recording

TIME = np.array(column(0))
ANGLE = np.array(column(1))
SPEED = np.array(column(2))


def parquet(path: Path, **columns: Any) -> Path:
    pyarrow = pytest.importorskip("pyarrow")
    from pyarrow import parquet as writer

    writer.write_table(pyarrow.table(columns), path)
    return path


# --- .parquet ---


def test_parquet(tmp_path: Path) -> None:
    path = parquet(
        tmp_path / "run.parquet",
        time_ms=np.arange(N),
        pos_deg=ANGLE.astype(np.float32),
        torque_Nm=SPEED,
        run=["a"] * 9 + ["b"],
    )
    loaded = load(path)
    assert loaded.time.tolist() == [k / 1000 for k in range(N)]
    np.testing.assert_allclose(loaded.position, np.deg2rad(ANGLE), rtol=1e-6)
    assert loaded.signals == ("time", "position", "velocity", "torque")
    scale = {"position": np.pi / 180.0}
    assert (loaded.name, dict(loaded.metadata)) == ("run", {"scale": scale})
    assert len(load(path, where={"run": "a"})) == 9


def test_parquet_of_a_data_frame(tmp_path: Path) -> None:
    pandas = pytest.importorskip("pandas")
    pytest.importorskip("pyarrow")
    frame = pandas.DataFrame(ROWS, columns=["t_s", "q_rad", "vel_rad_s", "tau_Nm"])
    frame.iloc[1:].to_parquet(tmp_path / "frame.parquet")
    assert load(tmp_path / "frame.parquet", name="") == Recording.from_dataframe(frame.iloc[1:])


def bad_parquets() -> list[tuple[dict[str, Any], str]]:
    import datetime
    import decimal

    stamps = [datetime.time(0, 0, k) for k in range(N)]
    return [
        (
            {"t": stamps, "q": ANGLE},
            r"column 't': the column holds time64\[us\]; .* seconds since the start",
        ),
        ({"t": TIME, "q": [1.0, None] * 5}, "row 1, column 'q': the cell is empty; a number is"),
        ({"t": TIME, "q": ["x"] * N}, "column 'q': 'x' at index 0 is not a number"),
        (
            {"t": TIME, "q": [{"a": 1}] * N},
            "column 'q': the column holds struct<a: int64>; numbers are expected",
        ),
        (
            {"t": TIME, "q": [["x"]] * N},
            "column 'q': the column holds list<element: string>; numbers are expected",
        ),
        (
            {"t": [decimal.Decimal(1)] * N, "q": ANGLE},
            "row 1, column 't': time is 1.0: the sample before is at 1.0",
        ),
        ({"t": TIME, "q": [np.inf] * N}, "row 0, column 'q': position is inf"),
        ({"x": TIME}, "the file has no position column; headers are 'x'"),
        ({}, "the file has no columns; time and position are expected"),
    ]


@pytest.mark.parametrize("number", range(9))
def test_bad_parquet_gives_one_sentence(number: int, tmp_path: Path) -> None:
    columns, message = bad_parquets()[number]
    path = parquet(tmp_path / "a.parquet", **columns)
    error_text = refusal(path)
    assert_one_sentence(error_text, path)
    assert re.search(message, error_text), error_text


@pytest.mark.parametrize("content", [b"", b"PAR1", b"PAR1" + bytes(50) + b"PAR1", b"t,q\n1,2\n"])
def test_no_parquet_at_all(content: bytes, tmp_path: Path) -> None:
    pytest.importorskip("pyarrow")
    path = written(tmp_path / "a.parquet", content)
    error_text = refusal(path)
    assert_one_sentence(error_text, path)
    assert "the file is not a .parquet file, or is damaged (" in error_text


def test_without_pyarrow_the_message_names_the_extra(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    for name in [name for name in sys.modules if name.partition(".")[0] == "pyarrow"]:
        monkeypatch.delitem(sys.modules, name)
    original = builtins.__import__

    def without(name: str, *rest: Any) -> Any:
        if name.partition(".")[0] == "pyarrow":
            raise ModuleNotFoundError(name, name=name)
        return original(name, *rest)

    monkeypatch.setattr(builtins, "__import__", without)
    path = written(tmp_path / "a.parquet", b"PAR1")
    error_text = refusal(path)
    assert_one_sentence(error_text, path)
    assert "needs pyarrow, which is not installed; pip install pyarrow or save" in error_text


@pytest.mark.parametrize("name", ["a.mat", "a.parquet"])
def test_missing_file_and_folder(name: str, tmp_path: Path) -> None:
    assert "there is no such file" in refusal(tmp_path / name)
    (tmp_path / name).mkdir()
    assert "this is a folder" in refusal(tmp_path / name)


# --- Any bytes: a recording, or one sentence. ---


def assert_loads_or_is_refused(path: Path) -> None:
    error_text = str(path)
    try:
        loaded = load(path)
    except InputError as error:
        error_text = str(error)
    else:
        assert len(loaded) >= 8
        assert all(np.isfinite(getattr(loaded, name)).all() for name in loaded.signals)
    assert error_text.startswith(str(path))
    assert "\n" not in error_text


@given(raw=st.binary(max_size=400))
@example(raw=b"MATLAB 5.0 MAT-file".ljust(124) + b"\x00\x01IM")
@example(raw=b"MATLAB 5.0 MAT-file".ljust(124) + b"\x00\x01IM" + bytes(range(1, 200)))
@pytest.mark.parametrize("ending", [".mat", ".parquet", ".csv", ".csv.gz", ".npz"])
@settings(deadline=None)
def test_any_bytes_load_or_are_refused(
    ending: str, raw: bytes, tmp_path_factory: pytest.TempPathFactory
) -> None:
    if ending == ".parquet":
        pytest.importorskip("pyarrow")
    path = tmp_path_factory.getbasetemp() / f"any{ending}"
    path.write_bytes(raw)
    assert_loads_or_is_refused(path)


@given(data=st.data())
@pytest.mark.parametrize("form", ["mat", "zipped.mat", "parquet"])
@settings(deadline=None, max_examples=150)
def test_damaged_files_load_or_are_refused(
    form: str, data: st.DataObject, tmp_path_factory: pytest.TempPathFactory
) -> None:
    path = tmp_path_factory.getbasetemp() / f"damaged.{form}"
    if form == "parquet":
        parquet(path, t=TIME, q=ANGLE, run=["a"] * N)
    else:
        variables = {"t": TIME, "log": {"q": ANGLE, "note": "x"}, "M": np.ones((3, 9))}
        mat(path, variables, do_compression=form.startswith("zipped"))
    raw = bytearray(path.read_bytes())
    for _ in range(data.draw(st.integers(1, 4))):
        raw[data.draw(st.integers(0, len(raw) - 1))] = data.draw(st.integers(0, 255))
    path.write_bytes(raw[: data.draw(st.just(len(raw)) | st.integers(0, len(raw)))])
    assert_loads_or_is_refused(path)


values = st.lists(st.tuples(*[st.floats(-1e15, 1e15)] * 2), min_size=8, max_size=20)


@given(pairs=values)
@pytest.mark.parametrize("form", ["mat", "zipped.mat", "parquet"])
@settings(deadline=None, max_examples=40)
def test_numbers_keep_every_bit(
    form: str, pairs: list[tuple[float, float]], tmp_path_factory: pytest.TempPathFactory
) -> None:
    table = np.array(pairs)
    columns: dict[str, Any] = {
        "time_s": np.arange(len(pairs)) * 0.001,
        "position_rad": np.ascontiguousarray(table[:, 0]),
        "velocity_rad_s": np.ascontiguousarray(table[:, 1]),
    }
    made = Recording(**{name.partition("_")[0]: array for name, array in columns.items()}, name="x")
    path = tmp_path_factory.getbasetemp() / f"bits.{form}"
    if form == "parquet":
        parquet(path, **columns)
    else:
        mat(path, columns, do_compression=form.startswith("zipped"))
    assert load(path, name="x") == made


# --- scale= and runs ---


def test_scale_turns_counts_and_voltages(tmp_path: Path) -> None:
    path = written(tmp_path / "a.csv", headed("t_s,q_counts,u_V,motor [furlong]"))
    loaded = load(
        path,
        columns={"torque": "u_V", "current": 3},
        scale={"position": 0.5, "torque": -35.0, "current": 2},
    )
    assert loaded.position.tolist() == (ANGLE * 0.5).tolist()
    assert loaded.torque is not None
    assert loaded.torque.tolist() == (SPEED * -35.0).tolist()
    assert loaded.current is not None
    assert loaded.current.tolist() == [-2.5] * N
    assert loaded.kind == "revolute"
    assert loaded.metadata == {"scale": {"position": 0.5, "torque": -35.0, "current": 2.0}}


def test_scale_of_a_data_frame() -> None:
    pandas = pytest.importorskip("pandas")
    frame = pandas.DataFrame(ROWS, columns=["t_s", "q_counts", "vel_rad_s", "tau_Nm"])
    made = Recording.from_dataframe(frame, scale={"position": 0.25})
    assert made.position.tolist() == (ANGLE * 0.25).tolist()


def runs_file(path: Path, run: Any = lambda k: k // 9, rows: int = 27) -> Path:
    return written(
        path, ["run,t_s,q_rad", *(f"{run(k)},{k % 9 * 0.1},{float(k)}" for k in range(rows))]
    )


def test_runs_in_order_of_appearance(tmp_path: Path) -> None:
    path = runs_file(tmp_path / "log.csv", lambda k: ("b", "a", "10")[k // 9])
    runs = load_runs(path, by="run", torque_hold="zoh")
    assert [run.name for run in runs] == ["log run=b", "log run=a", "log run=10"]
    assert [run.position[0] for run in runs] == [0.0, 9.0, 18.0]
    assert {run.torque_hold for run in runs} == {"zoh"}
    assert [run.name for run in load_runs(path, by=0, name="")] == ["run=b", "run=a", "run=10"]
    assert load_runs(path, by="run")[1] == load(path, where={"run": "a"}, name="log run=a")


def test_bad_runs_name_the_run(tmp_path: Path) -> None:
    path = runs_file(tmp_path / "a.csv", rows=20)
    with pytest.raises(InputError, match=r"a\.csv \(run=2\): time: 2 samples.* at least 8$"):
        load_runs(path, by="run")
    with pytest.raises(InputError, match=r"by is 'runs': no such header; did you mean 'run'$"):
        load_runs(path, by="runs")
    with pytest.raises(
        InputError, match=r"line 11, column 't_s': time is .*\{'run': 0\}"
    ) as caught:
        load(path)
    one, *others = caught.value.remedy  # the third run is too short to be loaded
    assert isinstance(one, Action)
    assert len(load(path, **one.arguments)) == 9
    assert others == []


@pytest.mark.parametrize(
    "name", [lambda k: k // 9, lambda k: "cab"[k // 9], lambda k: 1.5 + k // 9]
)
def test_the_advice_on_several_runs_can_be_followed(name: Any, tmp_path: Path) -> None:
    path = runs_file(tmp_path / "a.csv", name)
    with pytest.raises(InputError, match=r"one run.* or load with by='run'") as caught:
        load(path)
    one, every = caught.value.remedy
    assert isinstance(one, Action)
    assert isinstance(every, Action)
    assert len(load(path, **one.arguments)) == 9
    assert len(load_runs(path, **every.arguments)) == 3


def test_no_advice_where_no_column_numbers_the_runs(tmp_path: Path) -> None:
    # Neither a counter of samples nor a setting that several runs share.
    rows = [f"{k % 18},{k},{k},{int(k % 18 < 9)}" for k in range(36)]
    path = written(tmp_path / "a.csv", ["t_s,q,n,set", *rows])
    with pytest.raises(InputError, match=r"strictly increase; sort the rows") as caught:
        load(path)
    assert not any(isinstance(each, Action) for each in caught.value.remedy)


def test_a_column_of_another_length_does_not_number_runs(tmp_path: Path) -> None:
    path = npz(tmp_path / "a.npz", time=TIME, position=ANGLE, run=np.arange(3))
    with pytest.raises(
        InputError, match="'run' has 3 samples, but time has 10; a column that selects"
    ):
        load_runs(path, by="run")


def test_shared_runs(shared_data: Path) -> None:
    path = shared_data / "xl330" / "bam_xl330.csv.gz"
    runs = load_runs(path, by="run_index")
    assert len(runs) == 16
    assert runs[3] == load(path, where={"run_index": 3}, name="bam_xl330 run_index=3")
