"""Small files of which much would be made: each is refused at a limit, in one sentence and in little time.

Each is far larger than its limit and still small enough to be read where the limit is missing.
"""

import gzip
import struct
import zipfile
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from recording_files import refused

import jointid as jid
from jointid.base import unpacking
from jointid.recording.headers import understood
from jointid.recording.hierarchies import datasets, hdf5_chunks
from jointid.recording.readers import csv_reader, csv_text, twincat_scope
from jointid.recording.readers.csv_dialect import BLANK, cells_of

_HEAD = b"time_s,position,torque\n"


# --- Text ---


def test_a_first_line_of_megabytes(tmp_path: Path) -> None:
    path = tmp_path / "a.csv"
    path.write_bytes(b"," * 1_100_000 + b"\n0,0,1\n")
    assert "the first line is longer than 1 MB; a header is expected" in refused(path)


@pytest.mark.parametrize("piece", ["_a", " [", " ", "1_", "["])
def test_of_a_long_header_the_end_counts(piece: str) -> None:
    """The patterns that look for units take a time that grows with its square."""
    assert understood("x" + piece * 500_000).meaning is None
    long = understood("/" + "r" * 400 + "/position [deg]")
    assert long.unit is not None
    assert long.unit.name == "deg"
    assert long.meaning is not None
    assert long.meaning.signal == "position"


@pytest.mark.parametrize("piece", ["[ ", "a ( "])
def test_brackets_of_a_long_line_are_not_looked_for(piece: str) -> None:
    line = piece * 200_000
    assert cells_of(line, BLANK) == line.split()
    assert cells_of("time [s] q ( rad )", BLANK) == ["time [s]", "q ( rad )"]


def test_a_table_of_many_columns(tmp_path: Path) -> None:
    path = tmp_path / "a.csv"
    names = [f"c{k}" for k in range(10_001)]
    path.write_text("\n".join([",".join(names), *[",".join("0" * 10_001)] * 3]))
    assert "it has 10001 columns; at most 10000 are read" in refused(path)


@pytest.mark.parametrize(
    "line",
    [b"0,0,0\n", b"0;0;0\n", b"0 0 0\n", b"0\t0\t0\n", b"a,b,c\n", "\N{GRINNING FACE}\n".encode()],
)
def test_a_packed_text_counts_as_what_is_made_of_it(
    line: bytes, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(csv_text, "_LEAST", 300_000)
    path = tmp_path / "a.csv.gz"
    path.write_bytes(gzip.compress(_HEAD + line * (250_000 // len(line))))
    assert "unpacked file is larger than" in refused(path)


_SCOPE = (
    b"Name,position,Name,torque\nData-Type,REAL64,Data-Type,REAL64\n"
    b"SampleTime[ms],1,SampleTime[ms],1\n0,0,0,0\n"
)


@pytest.mark.parametrize(
    ("head", "line"),
    [
        (_HEAD, b'"0","0","0"\n'),
        (_HEAD, b"0,0,x\r"),
        (_HEAD, b'"0",0,' + b"0" * 5000 + b"\r\n"),
        (_HEAD, b"1\n"),
        (_HEAD, b"#\n"),
        (_HEAD, b"2025-11-01 12:26:40.5,0," + b"0" * 5000 + b"\n"),
        (_HEAD, b'"0",' * 2000),
        (_HEAD.replace(b",", b" "), b"0 0 a\n"),
        (_HEAD.replace(b",", b" "), b'"0" ' * 2000),
        (_HEAD.replace(b",", b";"), b"0,1;0,1;0,1\n"),
        (_HEAD, b"2025-11-01 12:26:40.5,0,0\n"),
        (_SCOPE, b"0,0,0,0\n"),
        (_SCOPE, b"0,0,0,\n"),
        (_SCOPE, b"0,0,0," + b"," * 5000 + b"\n"),
    ],
)
@pytest.mark.parametrize("packed", [True, False])
def test_the_lines_of_a_packed_text_count_as_texts(
    head: bytes, line: bytes, packed: bool, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Each takes 100 bytes of memory beside its characters, and so do cells."""
    monkeypatch.setattr(csv_text, "_LEAST_AS_TEXTS", 300_000)
    monkeypatch.setattr(csv_reader, "_LONG", 200)
    content = head + line * (200_000 // len(line))
    path = tmp_path / ("a.csv.gz" if packed else "a.csv")
    path.write_bytes(gzip.compress(content) if packed else content)
    assert ("unpacked file is larger than" in refused(path)) is packed


@pytest.mark.parametrize("end", [b"\n", b"\r\n"])
def test_the_limit_of_texts_can_be_raised(
    end: bytes, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(csv_text, "_LEAST_AS_TEXTS", 1000)
    monkeypatch.setattr(unpacking, "TIMES", 0)
    path = tmp_path / "a.csv.gz"
    rows = (b'%d,"0",%d' % (k, k % 7) for k in range(100))
    path.write_bytes(gzip.compress(end.join([b"time [ms],position,torque", *rows, b""])))
    assert "unpacked file is larger than" in refused(path)
    # 11 characters and 110 bytes for each line, 64 of a cell once more
    assert len(jid.load(path, unpacked=20_000)) == 100
    monkeypatch.setattr(csv_text, "_USUAL", 100)
    assert len(jid.load(path)) == 100


def test_the_place_of_a_row_makes_no_list(tmp_path: Path) -> None:
    path = tmp_path / "a.csv"
    path.write_bytes(_HEAD + b"0,1,2\r\n\n# pause\r3,4,5\n \n6,7,x")
    table = csv_reader.CsvTable(path)
    places = [table.place(2, row) for row in range(3)]
    assert places == [f"{path}, line {line}, column 'torque'" for line in (2, 5, 7)]


@pytest.mark.parametrize("unit", ["rad", "\N{DEGREE SIGN}"])
@pytest.mark.parametrize("encoding", ["utf-8", "latin-1"])
def test_constant_columns_are_no_bomb(unit: str, encoding: str, tmp_path: Path) -> None:
    names = [f"q{k} [{unit}]" for k in range(50)]
    rows = (f"{row / 1000},{row % 7}" + ",0.0" * 50 for row in range(20_000))
    text = "\n".join([",".join(["time_s", "position", *names]), *rows])
    path = tmp_path / "a.csv.gz"
    path.write_bytes(gzip.compress(text.encode(encoding)))
    assert len(jid.load(path)) == 20_000


def test_a_long_toml_file(tmp_path: Path) -> None:
    path = tmp_path / "a.toml"
    path.write_text(".".join("a" * 200_000) + " = 1\n")
    assert "too long for a TOML file of jointid" in refused(path, jid.Joint.load)


# --- Arrays ---


@pytest.mark.parametrize("form", ["npz", "h5", "mat"])
def test_bytes_count_as_the_numbers_that_they_become(
    form: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(unpacking, "LEAST", 600_000)
    path = tmp_path / f"a.{form}"
    arrays = {name: np.zeros(90_000, np.int8) for name in ("time", "position", "torque")}
    if form == "npz":
        np.savez_compressed(path, **arrays)  # type: ignore[arg-type]
    elif form == "mat":
        pytest.importorskip("scipy.io").savemat(path, arrays, do_compression=True)
    else:
        with pytest.importorskip("h5py").File(path, "w") as file:
            for name, array in arrays.items():
                file.create_dataset(name, data=array, compression="gzip")
    assert path.stat().st_size < 600_000 / unpacking.TIMES
    assert "unpacked file is larger than" in refused(path)


def test_a_text_array_counts_its_cells(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(unpacking, "LEAST", 300_000)
    monkeypatch.setattr(unpacking, "TIMES", 1)
    path = tmp_path / "a.npz"
    time = np.arange(6000) * 1e-3
    run = np.full(6000, "a")
    np.savez_compressed(path, time=time, position=time, torque=time, run=run)
    assert len(jid.load(path)) == 6000
    message = refused(path, lambda file: jid.load(file, where={"run": "a"}))
    assert "unpacked file is larger than" in message


@pytest.mark.slow
def test_a_struct_of_many_elements_is_left_out(tmp_path: Path) -> None:
    io = pytest.importorskip("scipy.io")
    path = tmp_path / "a.mat"
    signals = {name: np.arange(20) * 1e-3 for name in ("time", "position", "torque")}
    events = np.zeros(50_001, dtype=[("a", "O"), ("b", "O")])
    io.savemat(path, signals | {"events": events})
    assert len(jid.load(path)) == 20
    io.savemat(path, {"events": events})
    assert "no vectors of numbers are found, only 'events'" in refused(path)
    io.savemat(path, {"log": {f"f{k}": 1.0 for k in range(10_001)}})
    assert "no vectors of numbers are found, only 'log'" in refused(path)
    io.savemat(path, {"log": signals | {f"f{k}": np.arange(20.0) for k in range(1200)}})
    assert len(jid.load(path)) == 20


@pytest.mark.parametrize(
    "header",
    [b"(" * 70 + b"\n", b"{'descr': '<f8', 'shape': (\n", b"{1: 2, 'descr': 3}\n", b"{[]: 1}\n"],
)
def test_a_header_that_is_not_python(header: bytes, tmp_path: Path) -> None:
    path = tmp_path / "a.npz"
    with zipfile.ZipFile(path, "w") as archive:
        for name in ("time", "position", "torque"):
            start = b"\x93NUMPY\1\0" + struct.pack("<H", len(header)) + header
            archive.writestr(f"{name}.npy", start)
    assert "its header is damaged" in refused(path)


@pytest.mark.parametrize("kind", ["m8", "M8"])
def test_a_time_without_a_unit(kind: str, tmp_path: Path) -> None:
    path = tmp_path / "a.npz"
    time = np.arange(20, dtype="i8").view(kind)
    np.savez(path, time=time, position=np.zeros(20), torque=np.zeros(20))
    assert "dates or durations without a unit; seconds are expected" in refused(path)


def test_rows_of_many_groups(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Of an export with thousands of time columns, each row may end early: only whole ones are looked through."""
    count = 40
    names = ",".join(f"Name,c{k}" for k in range(count))
    data = ",".join(["Data-Type,REAL64"] * count)
    rows = "0,0\n" * 500 + ",".join(f"{k},0" for k in range(count)) + "\n"
    path = tmp_path / "a.csv"
    path.write_text(f"{names}\n{data}\n{rows}")
    table = twincat_scope.ScopeTable(str(path), path.read_text(), ",")
    looked: list[int] = []

    class Rows(list[list[str]]):
        def __getitem__(self, index: Any) -> Any:
            looked.append(index)
            return super().__getitem__(index)

        def __iter__(self) -> Any:
            looked.extend(range(len(self)))
            return super().__iter__()

    rows_of = Rows(table._all_cells)
    assert len(table._lengths) == 501
    monkeypatch.setitem(table.__dict__, "_all_cells", rows_of)
    table._samples(table._groups[30])
    assert looked == [500]


# --- HDF5 ---


def _hdf5(path: Path, change: Callable[[Any], None]) -> Path:
    h5py = pytest.importorskip("h5py")
    with h5py.File(path, "w") as file:
        file["time"] = np.arange(20) * 1e-3
        file["position"] = np.sin(np.arange(20))
        file["torque"] = np.cos(np.arange(20))
        change(file)
    return path


def test_long_paths(tmp_path: Path) -> None:
    """Of a group's name of 60 kB, each object below has its own copy, several times."""
    message = refused(_hdf5(tmp_path / "a.h5", lambda file: file.create_group("a" * 1001)))
    assert "the path of an object has 1001 characters; at most 1000 are read" in message


def test_columns_of_a_shared_type_are_not_all_made(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    made = 0
    real = datasets.Vector

    def vector(**fields: Any) -> Any:
        nonlocal made
        made += 1
        return real(**fields)

    monkeypatch.setattr(datasets, "Vector", vector)
    kind = np.dtype([(f"f{k}", "f8", (256,)) for k in range(20)])

    def change(file: Any) -> None:
        for k in range(20):
            file.create_dataset(f"d{k}", (2,), kind)

    assert "the file has more than 10000 columns" in refused(_hdf5(tmp_path / "a.h5", change))
    assert made <= 10_001


def test_filters_that_believe_the_file_are_not_used(tmp_path: Path) -> None:
    """A false count in a scale-offset filter ended the process."""

    def change(file: Any) -> None:
        del file["torque"]
        file.create_dataset("torque", data=np.arange(20), chunks=(20,), scaleoffset=8)

    message = refused(_hdf5(tmp_path / "a.h5", change))
    assert (
        "/torque is packed by scale-offset, which jointid cannot read; save the dataset with gzip"
        in message
    )


def test_attributes_of_many_texts(tmp_path: Path) -> None:
    h5py = pytest.importorskip("h5py")

    def change(file: Any) -> None:
        del file["position"]
        file["position"] = np.arange(400.0).reshape(20, 20)
        file["position"].attrs["units"] = ["deg"] * 20  # one for each column
        file["torque"].attrs["units"] = h5py.Empty("S10")
        file["time"].attrs["MATLAB_class"] = h5py.Empty("S10")

    path = _hdf5(tmp_path / "a.h5", change)
    found = jid.load(path, columns={"position": "position(:,2)"})
    assert found.position[0] == np.deg2rad(1.0)

    def many(file: Any) -> None:
        file["torque"].attrs["units"] = ["Nm"] * 257

    message = refused(_hdf5(tmp_path / "b.h5", many))
    assert "the attribute 'units' of /torque holds 257 texts; one text is expected" in message

    def alike(file: Any) -> None:
        file["torque"].attrs.create("units", ["N" * 50_000] * 100, dtype=h5py.string_dtype())

    assert "holds 100 texts" in refused(_hdf5(tmp_path / "c.h5", alike))


def test_many_chunks_are_looked_through_at_once(tmp_path: Path) -> None:
    """Each is looked for among all where its place is asked for."""
    h5py = pytest.importorskip("h5py")
    path = tmp_path / "a.h5"
    time = np.arange(20_000) * 1e-3
    with h5py.File(path, "w") as file:
        for name in ("time", "position", "torque"):
            file.create_dataset(name, data=time, chunks=(1,), compression="gzip")
    asked: list[Any] = []
    real = h5py.h5d.DatasetID.get_chunk_info_by_coord

    class Counting:
        def __init__(self, dataset: Any) -> None:
            self._dataset = dataset

        def __getattr__(self, name: str) -> Any:
            return getattr(self._dataset, name)

        @property
        def id(self) -> Any:
            return Identifier(self._dataset.id)

    class Identifier:
        def __init__(self, identifier: Any) -> None:
            self._identifier = identifier

        def __getattr__(self, name: str) -> Any:
            return getattr(self._identifier, name)

        def get_chunk_info_by_coord(self, place: Any) -> Any:
            asked.append(place)
            return real(self._identifier, place)

    with h5py.File(path) as file:
        hdf5_chunks.take(Counting(file["time"]), unpacking.Room(path))
    assert not asked


def test_names_of_a_block_are_counted(tmp_path: Path) -> None:
    """A dataset that is not stored may be of any size: one text of 100 MB is."""

    def change(file: Any) -> None:
        file.create_dataset("block0_values", data=np.zeros((20, 2)))
        file.create_dataset("block0_items", shape=(2,), dtype="S100000000", chunks=(1,))

    assert "unpacked file is larger than" in refused(_hdf5(tmp_path / "a.h5", change))


def test_matrices_of_many_columns(tmp_path: Path) -> None:
    def change(file: Any) -> None:
        for number in range(40):
            file.create_dataset(f"m{number}", shape=(1000, 256), dtype="f4")

    message = refused(_hdf5(tmp_path / "a.h5", change))
    assert "the file has more than 10000 columns; at most 10000 are read" in message
