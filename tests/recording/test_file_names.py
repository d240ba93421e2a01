"""Which files and folders are recordings, and names of columns that a file of matrices also has."""

from pathlib import Path

import numpy as np
import pytest

import jointid as jid
from jointid.base.errors import InputError
from jointid.recording.readers.registry import reader_of


def test_a_stray_bag_does_not_make_a_folder_a_recording(tmp_path: Path) -> None:
    (tmp_path / "stray.mcap").write_bytes(b"x")
    reader_of(tmp_path)  # nothing else in it
    (tmp_path / "thesis.odt").write_bytes(b"x")
    with pytest.raises(InputError, match="a file name that ends in"):
        reader_of(tmp_path)
    (tmp_path / "metadata.yaml").write_text("rosbag2_bagfile_information:\n")
    reader_of(tmp_path)


def test_a_column_of_a_matrix_by_its_plain_name(tmp_path: Path) -> None:
    h5py = pytest.importorskip("h5py")
    angles = np.sin(np.arange(300.0)).reshape(100, 3)
    path = tmp_path / "log.h5"
    with h5py.File(path, "w") as file:
        file["data/t"] = np.arange(100) * 0.002
        file["data/joint_positions"] = angles
    loaded = jid.load(path, columns={"position": "joint_positions(:,3)"})
    np.testing.assert_array_equal(loaded.position, angles[:, 2])


def test_a_recording_is_no_joint_file(tmp_path: Path) -> None:
    path = tmp_path / "run.csv"
    path.write_text("time,position\n0,1\n")
    with pytest.raises(
        InputError, match=r"a joint file \(.toml\) or an estimate \(.json\) is expected"
    ):
        jid.Joint.load(path)
