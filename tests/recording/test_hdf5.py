"""HDF5 files and MATLAB 7.3 files: datasets at any depth, matrices, tables, structs, groups that repeat."""

from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from recording_files import ROWS, N, assert_one_sentence, column, refusal

from jointid.base.errors import InputError
from jointid.recording.hierarchies.hdf5_table import Hdf5Table
from jointid.recording.readers.loading import load
from jointid.recording.readers.loading import table_of as _table
from jointid.recording.readers.loading_robot import load_robot
from jointid.recording.recording import Recording

h5py = pytest.importorskip("h5py")
TIME, ANGLE, SPEED = (np.array(column(k)) for k in range(3))
ARM = np.stack([ANGLE + k for k in range(3)], axis=1)  # 3 joints


def hdf5(
    path: Path,
    datasets: Mapping[str, Any],
    attributes: Mapping[str, Mapping[str, Any]] | None = None,
) -> Path:
    with h5py.File(path, "w") as file:
        for name, values in datasets.items():
            file[name] = values
        for name, found in (attributes or {}).items():
            file[name].attrs.update(found)
    return path


def mat73(path: Path, write: Callable[[Any], None]) -> Path:
    """A file as MATLAB writes it with -v7.3: HDF5 behind a block of 512 bytes."""
    with h5py.File(path, "w", userblock_size=512) as file:
        write(file)
    head = b"MATLAB 7.3 MAT-file, Platform: GLNXA64, Created on: Sun Nov 22 09:00:00 2026 HDF5 schema 1.00 ."
    with path.open("r+b") as stream:
        stream.write(head.ljust(116) + bytes(8) + b"\x00\x02IM")
    return path


def variable(group: Any, name: str, values: Any, kind: str = "double") -> None:
    """A MATLAB matrix: its transpose, with the class as an attribute."""
    values = np.atleast_2d(np.asarray(values))
    group[name] = values if values.shape[0] == 1 else values.T
    group[name].attrs["MATLAB_class"] = np.bytes_(kind)


def test_vectors_at_any_depth_with_units(tmp_path: Path) -> None:
    path = hdf5(
        tmp_path / "run.h5",
        {
            "log/time": TIME * 1000.0,
            "log/drive/position": ANGLE.astype(np.float32)[:, None],
            "log/drive/tau": SPEED[None, :],
            "log/drive/enabled": TIME > 0.02,
            "log/camera/frame": np.zeros((4, 5, 6), dtype=np.uint8),
            "log/operator": ["a", "b"],
            "log/gain": 3.0,
            "other/notes": np.bytes_("x" * 100),
        },
        {
            "log/time": {"unit": "ms"},
            "log/drive/position": {"units": np.bytes_("deg")},
            "log/drive/tau": {"Unit": ["mNm"]},
        },
    )
    loaded = load(path)
    assert loaded.signals == ("time", "position", "velocity", "torque")
    np.testing.assert_allclose(loaded.time, TIME, rtol=1e-15)
    np.testing.assert_allclose(loaded.position, np.deg2rad(ANGLE), rtol=1e-6)
    assert loaded.torque is not None
    np.testing.assert_allclose(loaded.torque, SPEED / 1000.0, rtol=1e-15)
    assert dict(loaded.metadata) == {"scale": {"position": np.pi / 180.0, "torque": 1e-3}}
    assert (
        load(path, columns={"torque": "log/drive/enabled"}, units={"torque": "Nm"}).torque
        is not None
    )


@pytest.mark.parametrize("ending", [".h5", ".hdf5", ".H5"])
@pytest.mark.parametrize("turned", [False, True])
def test_a_matrix_has_a_column_for_each_joint(turned: bool, ending: str, tmp_path: Path) -> None:
    """Of 10 samples and 3 joints, whichever comes first."""
    values = ARM.T if turned else ARM
    path = hdf5(
        tmp_path / f"arm{ending}",
        {"t": TIME, "position": values, "effort": 2.0 * values},
        {"position": {"unit": "rad"}},
    )
    assert _table(path).headers == (
        *("effort(:,1)", "effort(:,2)", "effort(:,3)"),
        *("position(:,1) [rad]", "position(:,2) [rad]", "position(:,3) [rad]", "t"),
    )
    for torque in ("joint_3.effort", "effort(:,3)"):
        loaded = load(path, columns={"position": "joint_3.position", "torque": torque})
        assert loaded.position.tolist() == ARM[:, 2].tolist()
        assert loaded.torque is not None
        assert loaded.torque.tolist() == (2.0 * ARM[:, 2]).tolist()


@pytest.mark.parametrize(
    ("position", "velocity", "torque"),
    [
        ("data/joint_positions", "data/joint_velocities", "data/joint_torques"),
        ("positions", "velocities", "torques"),
        ("observations/qpos", "observations/qvel", "observations/effort"),
        ("qpos", "qvel", "qfrc_actuator"),
    ],
)
def test_joints_of_matrices_with_plural_names(
    position: str, velocity: str, torque: str, tmp_path: Path
) -> None:
    path = hdf5(
        tmp_path / "arm.h5",
        {"timestamps": TIME, "action": ARM, position: ARM, velocity: 2.0 * ARM, torque: 3.0 * ARM},
        {position: {"unit": "rad"}},
    )
    loaded = load(path, joint=3)
    assert loaded.velocity is not None
    assert loaded.torque is not None
    np.testing.assert_array_equal(loaded.position, ARM[:, 2])
    np.testing.assert_array_equal(loaded.velocity, 2.0 * ARM[:, 2])
    np.testing.assert_array_equal(loaded.torque, 3.0 * ARM[:, 2])
    assert load_robot(path).names == ("1", "2", "3")
    name = position.rpartition("/")[2]
    for pattern in (f"joint_{{joint}}.{name} [rad]", f"{name}(:,{{joint}})"):
        assert load_robot(path, columns={"position": pattern}).names == ("1", "2", "3")
        assert load(path, joint=3, columns={"position": pattern}) == loaded


def test_either_version_of_mat_names_the_joints_alike(tmp_path: Path) -> None:
    scipy_io = pytest.importorskip("scipy.io")

    def fill(file: Any) -> None:
        variable(file, "tout", TIME)
        variable(file, "q", ARM)

    mat73(new := tmp_path / "new.mat", fill)
    scipy_io.savemat(old := tmp_path / "old.mat", {"tout": TIME, "q": ARM})
    assert load_robot(new).names == load_robot(old).names == ("1", "2", "3")
    np.testing.assert_array_equal(load(new, joint=2).position, load(old, joint=2).position)


def test_groups_of_joints_name_them(tmp_path: Path) -> None:
    path = hdf5(
        tmp_path / "arm.h5",
        {"t": TIME, "joints/elbow/q": ANGLE, "joints/wrist/q": SPEED, "joints/wrist/tau": SPEED},
    )
    assert _table(path).headers == ("elbow.q", "wrist.q", "tau", "t")
    assert load(path, columns={"position": "joints/wrist/q"}).position.tolist() == SPEED.tolist()


def test_fields_of_a_table(tmp_path: Path) -> None:
    kind = [("t", "f8"), ("q", "f4", (3,)), ("id", "S4"), ("drive", [("tau", "f8"), ("n", "i4")])]
    rows = np.zeros(N, dtype=kind)
    rows["t"], rows["q"], rows["drive"]["tau"] = TIME, ARM, SPEED
    path = hdf5(tmp_path / "table.h5", {"runs/table": rows})
    assert _table(path).headers == (*("t", "q(:,1)", "q(:,2)", "q(:,3)", "drive.tau", "drive.n"),)
    loaded = load(path, columns={"position": "joint_2.q", "torque": "drive.tau"})
    np.testing.assert_allclose(loaded.position, ARM[:, 1], rtol=1e-6)
    assert loaded.torque is not None
    assert loaded.torque.tolist() == SPEED.tolist()


def test_a_data_frame_of_pandas_as_it_stores_one(tmp_path: Path) -> None:
    """The layout of `DataFrame.to_hdf` with its fixed format; the package tables is not needed."""
    names = np.array([b"t_s", b"q_rad", b"vel_rad_s", b"tau_Nm"])
    values = np.array(ROWS)
    path = hdf5(
        tmp_path / "frame.h5",
        {
            "df/axis0": names,
            "df/axis1": np.arange(N),
            "df/block0_items": names,
            "df/block0_values": values,
        },
    )
    loaded = load(path, name="")
    assert _table(path).headers == ("index", "t_s", "q_rad", "vel_rad_s", "tau_Nm")
    assert loaded == Recording(
        time=values[:, 0], position=values[:, 1], velocity=values[:, 2], torque=values[:, 3]
    )


# --- Groups that repeat ---


def episodes(tmp_path: Path) -> Path:
    datasets: dict[str, Any] = {"calibration": np.arange(5.0)}
    for k in range(3):
        datasets[f"data/demo_{k}/obs/time"] = TIME
        datasets[f"data/demo_{k}/obs/position"] = ANGLE + k
        datasets[f"data/demo_{k}/actions/torque"] = SPEED
    return hdf5(tmp_path / "demos.h5", datasets)


def test_groups_that_repeat_are_listed_with_the_line_to_paste(tmp_path: Path) -> None:
    path = episodes(tmp_path)
    with pytest.raises(InputError) as caught:
        load(path)
    message = str(caught.value)
    assert_one_sentence(message, path)
    assert "3 groups hold the same datasets: data/demo_0, data/demo_1, data/demo_2; " in message
    assert "load with group='data/demo_1'" in message
    for group in ("data/demo_1", "/data/demo_1/", "data.demo_1"):
        loaded = load(path, group=group)
        assert loaded.position.tolist() == (ANGLE + 1).tolist()
        assert loaded.torque is not None
    assert "no such group; did you mean 'data/demo_2'" in refusal(path, group="data/demo2")
    assert "the file has no" not in refusal(path, group="data")
    assert "group is 3: a name is expected" in refusal(path, group=3)


def test_a_time_for_all_groups_stands_above_them(tmp_path: Path) -> None:
    path = hdf5(tmp_path / "a.h5", {"time": TIME, "a/position": ANGLE, "b/position": SPEED})
    assert load(path, group="b").position.tolist() == SPEED.tolist()


# --- MATLAB ---


def test_a_matlab_struct(tmp_path: Path) -> None:
    def write(file: Any) -> None:
        log = file.create_group("log")
        log.attrs["MATLAB_class"] = np.bytes_("struct")
        variable(log, "time", TIME[:, None])
        variable(log, "position", ANGLE)
        variable(log, "enabled", (TIME > 0).astype(np.uint8), "logical")
        variable(
            log, "note", np.frombuffer(b"a b c d e ", dtype=np.uint8).astype(np.uint16), "char"
        )
        variable(log, "joints", ARM)
        variable(file, "gain", 3.0)
        file["empty"] = np.array([0, 0], dtype=np.uint64)
        file["empty"].attrs.update({"MATLAB_class": np.bytes_("double"), "MATLAB_empty": 1})
        file["cells"] = np.array([[file["log/time"].ref]], dtype=h5py.ref_dtype)
        file["cells"].attrs["MATLAB_class"] = np.bytes_("cell")
        file["#refs#/a"] = SPEED
        file["#refs#/a"].attrs["MATLAB_class"] = np.bytes_("double")

    path = mat73(tmp_path / "run.mat", write)
    assert _table(path).headers == (
        *("enabled", "joints(:,1)", "joints(:,2)", "joints(:,3)", "position", "time"),
    )
    loaded = load(path, columns={"torque": "log.joints(:,2)"})
    assert loaded.name == "run"
    assert loaded.time.tolist() == TIME.tolist()
    assert loaded.position.tolist() == ANGLE.tolist()
    assert loaded.torque is not None
    assert loaded.torque.tolist() == ARM[:, 1].tolist()


def test_objects_of_matlab_are_named(tmp_path: Path) -> None:
    def write(file: Any) -> None:
        variable(file, "ts", np.arange(6, dtype=np.uint32), "timeseries")

    path = mat73(tmp_path / "run.mat", write)
    message = refusal(path)
    assert_one_sentence(message, path)
    assert "objects such as ts (timeseries) are not read" in message

    def beside(file: Any) -> None:
        write(file)
        variable(file, "t", TIME)
        variable(file, "q", ANGLE)

    assert load(mat73(path, beside)).metadata["not_read"] == ["ts (timeseries)"]


def test_older_matlab_files_have_no_groups(tmp_path: Path) -> None:
    from recording_files import mat

    path = mat(tmp_path / "a.mat", {"t": TIME, "q": ANGLE})
    assert "group is 'a': MATLAB files up to version 7 have no groups" in refusal(path, group="a")


# --- What is refused ---


def test_files_that_are_none(tmp_path: Path) -> None:
    for content in (b"", b"t,q\n", b"\x89HDF\r\n\x1a\n"):
        path = tmp_path / "a.h5"
        path.write_bytes(content)
        message = refusal(path)
        assert_one_sentence(message, path)
        assert "the file is not an HDF5 file, or is truncated" in message or "damaged" in message
    assert "there is no such file" in refusal(tmp_path / "b.h5")


def test_nothing_but_text(tmp_path: Path) -> None:
    path = hdf5(tmp_path / "a.h5", {"name": "x", "words": ["a", "b"]})
    assert "no vectors of numbers are found; save time and position as vectors" in refusal(path)


def test_another_file_is_not_read(tmp_path: Path) -> None:
    """Neither a link, nor the storage of a dataset, nor a virtual one leads out of the file."""
    other = tmp_path / "secret.bin"
    other.write_bytes(SPEED.tobytes())
    path = hdf5(tmp_path / "a.h5", {"t": TIME, "q": ANGLE})
    with h5py.File(path, "a") as file:
        file.create_dataset(
            "torque", shape=(N,), dtype="f8", external=[(str(other), 0, h5py.h5f.UNLIMITED)]
        )
        beside = str(hdf5(tmp_path / "b.h5", {"v": SPEED}))
        file["velocity"] = h5py.ExternalLink(beside, "v")
        layout = h5py.VirtualLayout(shape=(N,), dtype="f8")
        layout[:] = h5py.VirtualSource(beside, "v", shape=(N,))
        file.create_virtual_dataset("current", layout)
    table = Hdf5Table(path, None)
    assert table.headers == ("q", "t")
    assert table.notes == {"not_read": ["current (virtual)", "torque (external)"]}


def test_a_nan_is_named(tmp_path: Path) -> None:
    path = hdf5(tmp_path / "a.h5", {"t": TIME, "log/q": np.where(TIME > 0.02, np.nan, ANGLE)})
    assert "dataset 'q', index 3: position is nan" in refusal(path)


def test_without_h5py_the_message_names_the_extra(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    import sys

    monkeypatch.setitem(sys.modules, "h5py", None)
    path = tmp_path / "a.h5"
    path.write_bytes(b"x")
    assert "reading .h5 files needs h5py, which is not installed; pip install h5py" in (
        refusal(path)
    )
    path = tmp_path / "a.mat"
    path.write_bytes(b"MATLAB 7.3 MAT-file".ljust(600))
    assert "a MATLAB 7.3 file (HDF5) needs h5py, which is not installed; pip install" in refusal(
        path
    )
