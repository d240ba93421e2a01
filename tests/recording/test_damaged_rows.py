"""Rows with a value that is no measurement: refused with the way to leave them out, and left out on demand."""

from pathlib import Path

import numpy as np
import pytest

import jointid as jid
from jointid.base.errors import InputError


def written(path: Path, damage: dict[int, str], count: int = 60) -> Path:
    rows = [
        f"{0.002 * k:.3f},{np.sin(0.1 * k)},{damage.get(k, str(np.cos(0.1 * k)))}"
        for k in range(count)
    ]
    path.write_text("\n".join(["time_s,position_rad,torque_Nm", *rows, ""]))
    return path


@pytest.mark.parametrize("cell", ["1e300", "nan", "-inf"])
def test_a_damaged_row_is_left_out_on_demand(cell: str, tmp_path: Path) -> None:
    path = written(tmp_path / "a.csv", {20: cell})
    with pytest.raises(InputError, match="load with drop_invalid=True") as caught:
        jid.load(path)
    assert "line 22" in str(caught.value)
    loaded = jid.load(path, drop_invalid=True)
    assert len(loaded) == 59
    assert 0.04 not in loaded.time
    assert loaded.metadata["dropped_rows"] == 1
    assert not loaded.gaps
    sound = jid.load(written(tmp_path / "b.csv", {}), drop_invalid=True)
    assert len(sound) == 60
    assert "dropped_rows" not in sound.metadata


def test_several_damaged_rows_make_a_gap(tmp_path: Path) -> None:
    path = written(tmp_path / "a.csv", dict.fromkeys(range(30, 34), "nan"))
    loaded = jid.load(path, drop_invalid=True)
    (gap,) = loaded.gaps
    assert gap.duration == pytest.approx(0.01)


def test_a_damaged_column_is_not_dropped_row_by_row(tmp_path: Path) -> None:
    path = written(tmp_path / "a.csv", dict.fromkeys(range(30), "1e300"))
    with pytest.raises(InputError, match="check the column and its unit"):
        jid.load(path)
    with pytest.raises(
        InputError, match="30 of 60 rows have a value that is impossible for a joint"
    ):
        jid.load(path, drop_invalid=True)


@pytest.mark.parametrize("cell", ["", "overflow"])
def test_a_cell_without_a_number_is_a_damaged_row(cell: str, tmp_path: Path) -> None:
    """MATLAB writes blanks where a value is missing."""
    path = written(tmp_path / "a.csv", {20: cell})
    with pytest.raises(InputError, match="load with drop_invalid=True") as caught:
        jid.load(path)
    assert "line 22" in str(caught.value)
    loaded = jid.load(path, drop_invalid=True)
    assert len(loaded) == 59
    assert 0.04 not in loaded.time
    assert loaded.metadata["dropped_rows"] == 1


def test_a_column_of_words_is_not_dropped_row_by_row(tmp_path: Path) -> None:
    path = written(tmp_path / "a.csv", dict.fromkeys(range(30), "off"))
    for given in (False, True):
        with pytest.raises(InputError, match="'off' is not a number") as caught:
            jid.load(path, drop_invalid=given)
        assert "drop_invalid" not in str(caught.value)


def test_rows_out_of_order_are_advised_to_be_sorted(tmp_path: Path) -> None:
    head, *rows = written(tmp_path / "a.csv", {}).read_text().splitlines()
    (tmp_path / "b.csv").write_text("\n".join([head, *rows[30:], *rows[:30], ""]))
    with pytest.raises(InputError, match="strictly increase; sort the rows by time, or cut"):
        jid.load(tmp_path / "b.csv")


def test_an_appended_file_is_no_damage(tmp_path: Path) -> None:
    """Its header is in the way, and nothing of it is left out: the advice cuts the file there."""
    path = written(tmp_path / "a.csv", {})
    text = path.read_text().replace("torque_Nm", "velocity_rad_s,i_A").replace("\n", ",1\n")
    text = text.replace("i_A,1", "i_A")
    path.write_text(2 * text)
    with pytest.raises(InputError, match="another file was appended") as caught:
        jid.load(path)
    assert f"head -n 61 {path}" in str(caught.value)
    assert f"tail -n +62 {path}" in str(caught.value)
    assert "load with" not in str(caught.value)


@pytest.mark.parametrize("cell", ["nan", "", "overflow"])
def test_a_row_that_is_damaged_in_one_joint_is_left_out_in_all(cell: str, tmp_path: Path) -> None:
    path = tmp_path / "arm.csv"
    rows = [[f"{0.002 * k:.3f}", *(f"{np.sin(0.1 * k + c)}" for c in range(4))] for k in range(90)]
    rows[20][1] = rows[40][4] = rows[60][1] = rows[60][3] = cell
    head = "time_s,position_1_rad,torque_1_Nm,position_2_rad,torque_2_Nm"
    path.write_text("\n".join([head, *map(",".join, rows), ""]))
    with pytest.raises(InputError, match=r"line 22.*load with drop_invalid=True"):
        jid.load(path, joints="all")
    loaded = jid.load(path, joints="all", drop_invalid=True)
    assert loaded.torque is not None
    assert loaded.position.shape == loaded.torque.shape == (87, 2)
    assert not {0.04, 0.08, 0.12} & set(loaded.time)
    assert loaded.metadata["dropped_rows"] == 3
    np.testing.assert_allclose(loaded.torque[:, 1], np.sin(50.0 * loaded.time + 3.0))
    some = jid.load(path, joints=[2], drop_invalid=True)
    assert some.metadata["dropped_rows"] == 2
