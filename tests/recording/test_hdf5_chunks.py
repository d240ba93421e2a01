"""Chunks of HDF5 files that hold less or more than they should: the library reads the memory behind them."""

import struct
import zlib
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import jointid as jid
from jointid.base import unpacking

h5py = pytest.importorskip("h5py")

_ROWS = 20
_TIME = np.arange(_ROWS) * 1e-3
_TORQUE = np.cos(np.arange(_ROWS))
# Each as HDF5 or h5py packs it: of 20 numbers, the last chunk has 8 in use.
PACKED: dict[str, dict[str, Any]] = {
    "plain": {},
    "gzip": {"compression": "gzip"},
    "shuffled": {"compression": "gzip", "shuffle": True},
    "summed": {"fletcher32": True},
    "all": {"compression": "gzip", "shuffle": True, "fletcher32": True},
    "lzf": {"compression": "lzf"},
    "lzf and sum": {"compression": "lzf", "fletcher32": True},
}


def _file(path: Path, change: Callable[[Any], object] = lambda _: None, **options: Any) -> Path:
    with h5py.File(path, "w") as file:
        file["time"] = _TIME
        file["position"] = np.sin(_TIME)
        file.create_dataset("torque", **{"data": _TORQUE, "chunks": (12,), **options})
        change(file["torque"])
    return path


def _torque(path: Path) -> Any:
    return jid.load(path).torque


def _refused(path: Path) -> str:
    with pytest.raises(jid.InputError) as caught:
        jid.load(path)
    assert path.name in str(caught.value)
    return str(caught.value)


@pytest.mark.parametrize("name", PACKED)
@pytest.mark.parametrize("kind", ["f8", "f4", ">f8"])
def test_whole_chunks_are_read(name: str, kind: str, tmp_path: Path) -> None:
    values = _TORQUE.astype(kind)
    path = _file(tmp_path / "a.h5", lambda torque: torque.write_direct(values), **PACKED[name])
    assert np.array_equal(_torque(path), values)


@pytest.mark.parametrize("name", PACKED)
def test_texts_of_any_length_beside_the_numbers(name: str, tmp_path: Path) -> None:
    """In memory a text is an address of 8 bytes, in the file one of 16."""
    text = h5py.string_dtype()
    kind = np.dtype(
        [
            ("time", "f8"),
            ("position", "f8"),
            ("torque", "f8"),
            ("inner", [("state", text)]),
            ("more", text, (2,)),
        ]
    )
    values = np.zeros(_ROWS, kind)
    values["time"], values["torque"] = _TIME, _TORQUE
    values["inner"]["state"], values["more"] = "moving", "still"
    path = tmp_path / "a.h5"
    with h5py.File(path, "w") as file:
        file.create_dataset("log", data=values, chunks=(12,), **PACKED[name])
    assert np.array_equal(_torque(path), _TORQUE)


@pytest.mark.parametrize("latest", [True, False])
@pytest.mark.parametrize("packed", [True, False])
@pytest.mark.parametrize("written", [True, False])
def test_places_that_the_library_tells_wrong(
    latest: bool, packed: bool, written: bool, tmp_path: Path
) -> None:
    """Of rows of chunks that may grow to the right, HDF5 2.0 tells other places; some may not be stored."""
    path = tmp_path / "a.h5"
    values = np.sin(np.arange(3 * 53.0).reshape(3, 53))
    with h5py.File(path, "w", **({"libver": "latest"} if latest else {})) as file:
        file["time"] = np.arange(53) * 1e-3
        file["position"] = np.arange(53.0)
        options = {"compression": "gzip"} if packed else {}
        torque = file.create_dataset(
            "torque", (3, 53), "f8", chunks=(1, 10), maxshape=(3, None), **options
        )
        torque[:, :] = values
        if not written:
            values[:] = 0.0
            del file["torque"]
            file.create_dataset(
                "torque", (3, 53), "f8", chunks=(1, 10), maxshape=(3, None), **options
            )
    found = jid.load(path, columns={"torque": "torque(:,2)"})
    assert np.array_equal(np.asarray(found.torque), values[1])


def test_the_whole_limit_may_be_used(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(unpacking, "LEAST", 4 * 8 * _ROWS)
    monkeypatch.setattr(unpacking, "TIMES", 0)
    path = tmp_path / "a.h5"
    with h5py.File(path, "w") as file:
        for name in ("time", "position", "torque"):
            values = _TIME if name == "time" else _TORQUE
            file.create_dataset(name, data=values, chunks=(5,), compression="gzip")
    assert len(jid.load(path)) == _ROWS
    with h5py.File(path, "a") as file:
        file.create_dataset("velocity", data=_TORQUE, chunks=(5,), compression="gzip")
    assert len(jid.load(path)) == _ROWS


def test_chunks_without_their_filters_are_read(tmp_path: Path) -> None:
    """A writer may leave out a filter that makes a chunk larger; its number in a mask says so."""

    def change(torque: Any) -> None:
        torque.id.write_direct_chunk((0,), _TORQUE[:12].tobytes(), filter_mask=1)

    path = _file(tmp_path / "a.h5", change, compression="gzip")
    assert np.array_equal(_torque(path), _TORQUE)


@pytest.mark.parametrize(
    ("options", "written", "mask"),
    [
        ({"compression": "gzip"}, zlib.compress(bytes(88)), 0),
        ({"compression": "gzip"}, zlib.compress(bytes(104)), 0),
        ({"compression": "gzip"}, bytes(88), 1),
        ({"compression": "gzip", "shuffle": True}, zlib.compress(bytes(95)), 0),
        ({"compression": "gzip", "shuffle": True}, bytes(88), 2),
        ({"fletcher32": True}, bytes(92), 1),
    ],
)
def test_a_chunk_of_another_size_is_refused(
    options: dict[str, Any], written: bytes, mask: int, tmp_path: Path
) -> None:
    path = _file(
        tmp_path / "a.h5",
        lambda torque: torque.id.write_direct_chunk((0,), written, filter_mask=mask),
        **options,
    )
    assert "the file is damaged (a chunk holds " in _refused(path)


@pytest.mark.parametrize("size", [0, 88])
def test_a_filter_that_makes_less_is_refused(size: int, tmp_path: Path) -> None:
    path = _file(tmp_path / "a.h5", compression="lzf")
    with h5py.File(path) as file:
        _, _, values, _ = file["torque"].id.get_create_plist().get_filter(0)
    content = path.read_bytes()
    known = struct.pack("<III", *values)
    assert content.count(known) == 1
    path.write_bytes(content.replace(known, struct.pack("<III", *values[:2], size)))
    assert "the output of an LZF filter is smaller than a chunk of 96 bytes" in _refused(path)


def test_a_chunk_larger_than_its_file_is_refused(tmp_path: Path) -> None:
    path = _file(tmp_path / "a.h5", chunks=(20,), compression="gzip")
    with h5py.File(path) as file:
        size = file["torque"].id.get_chunk_info(0).size
    content = path.read_bytes()
    known = struct.pack("<IIQQ", size, 0, 0, 0)  # of a chunk in the index: its size, mask and place
    assert content.count(known) == 1
    path.write_bytes(content.replace(known, struct.pack("<IIQQ", 2_600_000_000, 0, 0, 0)))
    assert "a chunk states 2600000000 bytes, but the whole file has only" in _refused(path)


def test_all_chunks_together_are_counted(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Each may be far larger than what the dataset has of it, and all may be one place of the file."""
    monkeypatch.setattr(unpacking, "LEAST", 20_000)
    monkeypatch.setattr(unpacking, "TIMES", 0)
    path = _file(
        tmp_path / "a.h5",
        data=_TORQUE[:, None],
        chunks=(1, 1000),
        maxshape=(None, None),
        compression="gzip",
    )
    assert "unpacked file is larger than" in _refused(path)
