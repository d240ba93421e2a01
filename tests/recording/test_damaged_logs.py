"""Damaged, cut and unfinished logs: a recording as far as it goes, or one sentence."""

import shutil
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from message_files import distractors, in_order, joint_state, mcap, motion, ros1_bag, ros2_bag
from recording_files import assert_one_sentence, refusal

from jointid.base.errors import InputError
from jointid.recording.readers.loading import load

pytest.importorskip("mcap")
pytest.importorskip("rosbags")
h5py = pytest.importorskip("h5py")


def logged(count: int = 40) -> Any:
    return in_order([*(joint_state("/js", s) for s in motion(count, ["a"])), *distractors(count)])


def _mcap(folder: Path, compression: str) -> Path:
    from mcap.writer import CompressionType

    return mcap(
        folder / f"{compression}.mcap",
        logged(),
        compression=CompressionType[compression],
        chunk_size=1500,
    )


def _hdf5(path: Path) -> Path:
    with h5py.File(path, "w", userblock_size=512 if path.suffix == ".mat" else 0) as file:
        file.create_dataset("log/t", data=np.arange(40.0), compression="gzip", chunks=(10,))
        file["log/q"] = np.arange(40.0)
        file["log/q"].attrs["unit"] = "rad"
        file["log/q"].attrs["MATLAB_class"] = np.bytes_("double")
        file["log/torque"] = np.ones((40, 1))
        file["rows"] = np.zeros(9, dtype=[("a", "f8"), ("b", "i2")])
    return path


def _db3(path: Path) -> Path:
    folder = ros2_bag(path.with_suffix(""), logged())
    shutil.move(next(folder.glob("*.db3")), path)
    shutil.rmtree(folder)
    return path


MAKERS: dict[str, Callable[[Path], Path]] = {
    "none.mcap": lambda folder: _mcap(folder, "NONE"),
    "lz4.mcap": lambda folder: _mcap(folder, "LZ4"),
    "zstd.mcap": lambda folder: _mcap(folder, "ZSTD"),
    "json.mcap": lambda folder: mcap(folder / "json.mcap", logged(), encoding="json"),
    "plain.mcap": lambda folder: mcap(folder / "plain.mcap", logged(), use_chunking=False),
    "run.bag": lambda folder: ros1_bag(folder / "run.bag", logged(), chunk=1500),
    "run.db3": lambda folder: _db3(folder / "run.db3"),
    "run.h5": lambda folder: _hdf5(folder / "run.h5"),
    "run.mat": lambda folder: _hdf5(folder / "run.mat"),
}


@pytest.fixture(scope="module")
def whole(tmp_path_factory: pytest.TempPathFactory) -> dict[str, bytes]:
    folder = tmp_path_factory.mktemp("whole")
    return {name: make(folder).read_bytes() for name, make in MAKERS.items()}


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


@pytest.mark.parametrize("name", MAKERS)
@given(data=st.data())
@settings(
    deadline=None, max_examples=60, suppress_health_check=[HealthCheck.function_scoped_fixture]
)
def test_flipped_bytes_and_cuts(
    name: str, data: st.DataObject, whole: dict[str, bytes], tmp_path: Path
) -> None:
    raw = bytearray(whole[name])
    for _ in range(data.draw(st.integers(0, 4))):
        raw[data.draw(st.integers(0, len(raw) - 1))] = data.draw(st.integers(0, 255))
    path = tmp_path / name
    path.write_bytes(raw[: data.draw(st.integers(0, len(raw)) | st.just(len(raw)))])
    assert_loads_or_is_refused(path)


@pytest.mark.parametrize("ending", [".mcap", ".bag", ".db3", ".h5"])
@given(raw=st.binary(max_size=300))
@settings(
    deadline=None, max_examples=40, suppress_health_check=[HealthCheck.function_scoped_fixture]
)
def test_any_bytes(ending: str, raw: bytes, tmp_path: Path) -> None:
    starts = {".mcap": b"\x89MCAP0\r\n", ".bag": b"#ROSBAG V2.0\n", ".h5": b"\x89HDF\r\n\x1a\n"}
    path = tmp_path / f"any{ending}"
    for head in (b"", starts.get(ending, b"SQLite format 3\0")):
        path.write_bytes(head + raw)
        assert_loads_or_is_refused(path)


# --- The recorder was killed ---


@pytest.mark.parametrize("name", ["none.mcap", "zstd.mcap", "plain.mcap", "run.bag"])
def test_a_cut_file_is_read_as_far_as_it_goes_and_it_is_said(
    name: str, whole: dict[str, bytes], tmp_path: Path
) -> None:
    path = tmp_path / name
    path.write_bytes(whole[name])
    all_of_it = load(path)
    assert "incomplete" not in all_of_it.metadata
    lengths = set()
    for share in np.linspace(0.3, 0.6, 7) if name.endswith("mcap") else np.linspace(0.6, 0.8, 7):
        path.write_bytes(whole[name][: int(share * len(whole[name]))])
        loaded = load(path)
        assert "recorder was killed" in str(loaded.metadata["incomplete"])
        assert loaded.position.tolist() == all_of_it.position[: len(loaded)].tolist()
        lengths.add(len(loaded))
    assert len(lengths) > 2
    assert max(lengths) < 40


def test_a_bag_without_its_index_is_read_and_it_is_said(
    whole: dict[str, bytes], tmp_path: Path
) -> None:
    """As a recorder leaves it: the header's place of the index is 0, and the index is missing."""
    raw = whole["run.bag"]
    place = raw.index(b"index_pos=") + len(b"index_pos=")
    index = int.from_bytes(raw[place : place + 8], "little")
    path = tmp_path / "run.bag"
    path.write_bytes(raw[:place] + bytes(8) + raw[place + 8 : index])
    loaded = load(path)
    assert len(loaded) == 40
    assert "no index" in str(loaded.metadata["incomplete"])


def test_a_folder_that_nobody_finished(tmp_path: Path) -> None:
    """Without metadata.yaml, as a killed recorder leaves it; and with two files in order."""
    folder = ros2_bag(tmp_path / "run", logged())
    assert load(f"{folder}/").name == "run"
    (folder / "metadata.yaml").unlink()
    assert len(load(folder)) == 40
    later = ros2_bag(tmp_path / "other", logged(60)[len(logged()) :])
    next(later.glob("*.db3")).rename(folder / "run_10.db3")
    next(folder.glob("run.db3")).rename(folder / "run_9.db3")
    loaded = load(folder)
    assert loaded.time.tolist() == [k * 10_000_000 / 1e9 for k in range(60)]
    assert "reordered_messages" not in loaded.metadata
    empty = tmp_path / "empty"
    empty.mkdir()
    assert "a file name that ends in" in refusal(empty)


def test_a_damaged_chunk_is_named(whole: dict[str, bytes], tmp_path: Path) -> None:
    """Its checksum is looked at: else a flipped bit would be a wrong position."""
    raw = bytearray(whole["none.mcap"])
    raw[raw.index(b"base") + 60] ^= 4
    path = tmp_path / "run.mcap"
    path.write_bytes(raw)
    message = refusal(path)
    assert_one_sentence(message, path)
    assert "it is damaged (crc validation failed in Chunk" in message


def test_protobuf_is_said_not_to_be_read(tmp_path: Path) -> None:
    from mcap.writer import Writer

    path = tmp_path / "run.mcap"
    writer = Writer(str(path))
    writer.start()
    schema = writer.register_schema("foxglove.JointStates", "protobuf", b"")
    channel = writer.register_channel("/js", "protobuf", schema)
    writer.add_message(channel, 1, b"\x0a\x00", 1)
    writer.finish()  # type: ignore[no-untyped-call]
    message = refusal(path)
    assert_one_sentence(message, path)
    assert (
        "topic /js: messages in the encoding 'protobuf' are not read; known encodings are cdr, ros1, json"
        in message
    )


@pytest.mark.parametrize("package", ["mcap", "rosbags"])
def test_without_the_packages_the_message_names_the_extra(
    package: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    import sys

    from jointid.recording.messages import definitions

    path = mcap(tmp_path / "run.mcap", logged())
    definitions._types.cache_clear()
    definitions._common.cache_clear()
    for name in [name for name in sys.modules if name.partition(".")[0] == package]:
        monkeypatch.delitem(sys.modules, name)
    monkeypatch.setitem(sys.modules, package, None)
    assert (
        f"reading .mcap files needs {package}, which is not installed; pip install mcap rosbags"
        in refusal(path)
    )
