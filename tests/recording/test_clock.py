"""Stamps that repeat, that are rounded, or that are not there at all."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from command_line_answers import answer
from numpy.typing import NDArray

import jointid as jid
from jointid.cli.command_line import main

PERIOD = 0.0025
TRUE: NDArray[np.float64] = np.asarray(PERIOD * np.arange(2000), dtype=np.float64)


def written(
    path: Path,
    stamps: NDArray[np.float64] | None = None,
    form: str = "{:.4f}",
    kept: NDArray[np.intp] | None = None,
) -> Path:
    """A log of a joint in motion, with these stamps, or none, and some of its rows."""
    columns = {"position_rad": np.sin(3.0 * TRUE), "torque_Nm": np.cos(5.0 * TRUE)}
    text = [[f"{value:.7f}" for value in values] for values in columns.values()]
    if stamps is not None:
        text.insert(0, [form.format(stamp) for stamp in stamps])
    rows = [",".join(cells) for cells in zip(*text, strict=True)]
    if kept is not None:
        rows = [rows[k] for k in kept]
    header = ",".join([*["time_s"] * (stamps is not None), *columns])
    path.write_text("\n".join([header, *rows, ""]))
    return path


EVERY = np.arange(len(TRUE))
REPEATED = {
    "some": np.sort(np.concatenate([EVERY, EVERY[100:1300:100]])),
    "one": np.sort(np.concatenate([EVERY, EVERY[700:701]])),
    "a tail": np.concatenate([EVERY, [EVERY[-1]] * 250]),
    "a block at the end": np.concatenate([EVERY, EVERY[-250:]]),
}


@pytest.mark.parametrize("name", REPEATED)
def test_rows_that_repeat_stamp_and_values_are_left_out(
    name: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = written(tmp_path / "a.csv", TRUE, kept=REPEATED[name])
    loaded = jid.load(path)
    assert loaded.time.tolist() == jid.load(written(tmp_path / "b.csv", TRUE)).time.tolist()
    count = len(REPEATED[name]) - len(TRUE)
    assert loaded.metadata["repeated_rows"] == count
    assert main(["info", str(path)]) == 0
    assert f"{count} row" in capsys.readouterr().out


ROUNDED = {
    "to 1 ms": (TRUE, "{:.3f}"),
    "to 10 ms": (TRUE, "{:.2f}"),
    "down to 10 ms": (np.floor(TRUE * 100.0) / 100.0, "{:.2f}"),
    "to a tick of 1/64 s": (np.floor(TRUE * 64.0) / 64.0, "{:.6f}"),
}


@pytest.mark.parametrize("name", ROUNDED)
def test_rounded_stamps_are_those_of_an_even_clock(name: str, tmp_path: Path) -> None:
    stamps, form = ROUNDED[name]
    loaded = jid.load(written(tmp_path / "a.csv", stamps, form))
    np.testing.assert_allclose(np.diff(loaded.time), PERIOD, rtol=1e-4)
    assert loaded.metadata["rounded_stamps"]["period"] == pytest.approx(PERIOD, rel=1e-4)


def test_rows_that_are_missing_stay_missing_where_stamps_are_rounded(tmp_path: Path) -> None:
    for form, lost in (("{:.3f}", 1), ("{:.3f}", 7), ("{:.2f}", 100)):
        kept = np.concatenate([EVERY[:700], EVERY[700 + lost :]])
        loaded = jid.load(written(tmp_path / "a.csv", TRUE, form, kept))
        steps = np.diff(loaded.time)
        assert steps[699] == pytest.approx(PERIOD * (lost + 1), rel=0.05)
        np.testing.assert_allclose(np.delete(steps, 699), PERIOD, rtol=1e-3)


def test_stamps_that_no_even_clock_explains_stay(tmp_path: Path) -> None:
    late = TRUE + np.random.default_rng(1).uniform(0.0, 0.0024, len(TRUE))
    loaded = jid.load(written(tmp_path / "a.csv", late, "{:.4f}"))
    assert "rounded_stamps" not in loaded.metadata
    assert loaded.time.tolist() == [float(f"{stamp:.4f}") for stamp in late]
    lost = np.delete(EVERY, 1000)  # of whole milliseconds: no rounding
    loaded = jid.load(written(tmp_path / "b.csv", TRUE * 0.4, "{:.3f}", lost))
    assert "rounded_stamps" not in loaded.metadata
    with pytest.raises(jid.InputError, match="must strictly increase; load with sample_period"):
        jid.load(written(tmp_path / "c.csv", late, "{:.3f}"))


def test_stamps_that_go_back_stay_an_error(tmp_path: Path) -> None:
    back = np.concatenate([TRUE[:1000], TRUE[1000:] - 0.5])
    with pytest.raises(jid.InputError, match="strictly increase; sort the rows"):
        jid.load(written(tmp_path / "a.csv", back))


def test_a_rate_stands_for_the_time(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = written(tmp_path / "a.csv")
    code, said = answer(["identify", str(path)], capsys)
    assert code == 2
    assert "the file has no time column" in said
    assert "load with --rate HZ" in said
    loaded = jid.load(path, sample_period=PERIOD)
    assert loaded.time.tolist() == TRUE.tolist()
    assert main(["info", str(path), "--rate", "400"]) == 0
    assert "one every 2.5 ms" in capsys.readouterr().out
    pandas = pytest.importorskip("pandas")
    frame = pandas.read_csv(path)
    framed = jid.Recording.from_dataframe(frame, sample_period=PERIOD)
    assert framed.fingerprint == loaded.fingerprint


def test_a_rate_wins_over_stamps_and_says_so(tmp_path: Path) -> None:
    loaded = jid.load(written(tmp_path / "a.csv", TRUE, "{:.2f}"), sample_period=PERIOD)
    assert loaded.time.tolist() == TRUE.tolist()
    assert [each["column"] for each in loaded.metadata["left_out"]] == ["time_s"]
    both: dict[str, Any] = {"sample_period": PERIOD, "columns": {"time": "time_s"}}
    with pytest.raises(
        jid.InputError, match=r"sample_period is 0\.0025: the file has a time column"
    ):
        jid.load(tmp_path / "a.csv", **both)
    for value in (0.0, -1.0, float("nan"), "fast"):
        with pytest.raises(jid.InputError, match="a positive number of seconds is expected"):
            jid.load(tmp_path / "a.csv", sample_period=value)  # type: ignore[arg-type]


def test_a_rate_for_runs_and_robots(tmp_path: Path) -> None:
    path = tmp_path / "runs.csv"
    rows = [f"{k // 50},{np.sin(0.1 * k):.5f},{np.cos(0.1 * k):.5f}" for k in range(100)]
    path.write_text("\n".join(["run,position_rad,torque_Nm", *rows, ""]))
    first, second = jid.load_runs(path, by="run", sample_period=0.01)
    assert first.sample_period == pytest.approx(0.01) == second.sample_period
    path = tmp_path / "robot.csv"
    rows = [f"{np.sin(0.1 * k):.5f},{np.cos(0.1 * k):.5f},1,2" for k in range(100)]
    path.write_text("\n".join(["q_0,q_1,tau_0,tau_1", *rows, ""]))
    robot = jid.load_robot(path, sample_period=0.01)
    assert robot.names == ("0", "1")
    assert robot.time[-1] == pytest.approx(0.99)


def test_rows_of_a_robot_that_repeat_in_all_joints_are_left_out(tmp_path: Path) -> None:
    rows = [f"{0.01 * k:.2f},{np.sin(0.1 * k):.5f},{min(k, 50)},1,2" for k in range(100)]
    path = tmp_path / "robot.csv"
    path.write_text("\n".join(["t_s,q_0,q_1,tau_0,tau_1", *rows[:60], *rows[59:], rows[-1], ""]))
    robot = jid.load_robot(path)
    assert len(robot.time) == 100
    assert robot.metadata["repeated_rows"] == 2


def test_a_missing_time_is_said_beside_another_problem(tmp_path: Path) -> None:
    path = tmp_path / "a.csv"
    rows = [f"{k % 9},{k % 7}" for k in range(20)]
    path.write_text("\n".join(["position [counts],torque_Nm", *rows, ""]))
    with pytest.raises(jid.InputError, match=r"no time column.* is a raw reading.*") as caught:
        jid.load(path)
    assert "load with sample_period=..., scale={'position': ...}" in str(caught.value)
