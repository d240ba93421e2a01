"""Small files that hold gigabytes: refused in one sentence, long before they fill the memory."""

import bz2
import gzip
import io
import sqlite3
import struct
import zipfile
import zlib
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from lanes import slow_but
from measured_reading import on_linux, refusal

import jointid as jid
from jointid.base import unpacking

_HELD = 800_000_000  # bytes, of nothing but zeros


def _zeros(write: Callable[[bytes], object], first: bytes, line: bytes) -> None:
    write(first)
    block = line * (10_000_000 // len(line))
    for _ in range(_HELD // len(block)):
        write(block)


def csv_gz(path: Path) -> None:
    with gzip.open(path, "wb", 9) as file:
        _zeros(file.write, b"time,position,torque\n", b"0,0,0\n")


def npz(path: Path) -> None:
    head = io.BytesIO()
    np.lib.format.write_array_header_1_0(
        head, {"descr": "<f8", "fortran_order": False, "shape": (_HELD // 8,)}
    )
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as archive:
        with archive.open("time.npy", "w", force_zip64=True) as member:
            _zeros(member.write, head.getvalue(), bytes(8))
        for name in ("position.npy", "torque.npy"):
            archive.writestr(name, head.getvalue())


def mat(path: Path) -> None:
    count = _HELD // 8
    name = b"time" + bytes(4)
    body = struct.pack("<IIII", 6, 8, 6, 0) + struct.pack("<IIii", 5, 8, count, 1)
    body += struct.pack("<II", 1, 4) + name + struct.pack("<II", 9, _HELD)
    packer = zlib.compressobj(9)
    packed: list[bytes] = []
    _zeros(
        lambda part: packed.append(packer.compress(part)),
        struct.pack("<II", 14, len(body) + _HELD) + body,
        bytes(8),
    )
    packed.append(packer.flush())
    content = b"".join(packed)
    header = b"MATLAB 5.0 MAT-file".ljust(124) + struct.pack("<H", 0x0100) + b"IM"
    path.write_bytes(header + struct.pack("<II", 15, len(content)) + content)


def h5(path: Path) -> None:
    h5py = pytest.importorskip("h5py")
    block = 10_000_000
    with h5py.File(path, "w") as file:
        for name in ("time", "position", "torque"):
            file.create_dataset(
                name, (_HELD // 8,), "f8", chunks=(block,), compression="gzip", fillvalue=0.0
            )
            file[name][:block] = 0.0  # its other chunks are not even stored


def mcap(path: Path) -> None:
    records = pytest.importorskip("mcap.records")
    zstandard = pytest.importorskip("zstandard")
    builder = pytest.importorskip("mcap.data_stream")
    packer = zstandard.ZstdCompressor(level=3).compressobj()
    packed: list[bytes] = []
    _zeros(lambda part: packed.append(packer.compress(part)), b"", bytes(10_000))
    data = b"".join([*packed, packer.flush()])
    with path.open("wb") as file:
        stream = builder.RecordBuilder()
        magic = b"\x89MCAP0\r\n"
        records.Header(profile="", library="").write(stream)
        records.Chunk(
            compression="zstd",
            data=data,
            message_start_time=0,
            message_end_time=0,
            uncompressed_crc=0,
            uncompressed_size=_HELD,
        ).write(stream)
        file.write(magic + stream.end() + magic)


def bag(path: Path) -> None:
    packer = bz2.BZ2Compressor(9)
    packed: list[bytes] = []
    _zeros(lambda part: packed.append(packer.compress(part)), b"", bytes(10_000))
    data = b"".join([*packed, packer.flush()])

    def field(name: bytes, value: bytes) -> bytes:
        return struct.pack("<I", len(name) + 1 + len(value)) + name + b"=" + value

    header = field(b"op", b"\x05") + field(b"compression", b"bz2")
    record = struct.pack("<I", len(header)) + header + struct.pack("<I", len(data)) + data
    path.write_bytes(b"#ROSBAG V2.0\n" + record)


def db3(path: Path) -> None:
    zstandard = pytest.importorskip("zstandard")
    packer = zstandard.ZstdCompressor(level=3).compressobj()
    packed: list[bytes] = []
    _zeros(lambda part: packed.append(packer.compress(part)), b"", bytes(10_000))
    data = b"".join([*packed, packer.flush()])
    connection = sqlite3.connect(path)
    connection.execute("CREATE TABLE topics(id, name, type, serialization_format)")
    connection.execute("CREATE TABLE messages(topic_id, timestamp, data)")
    connection.execute(
        "INSERT INTO topics VALUES (1, '/joint_states', 'sensor_msgs/msg/JointState', 'cdr')"
    )
    connection.execute("INSERT INTO messages VALUES (1, 0, ?)", (data,))
    connection.commit()
    connection.close()


def parquet(path: Path) -> None:
    pyarrow = pytest.importorskip("pyarrow")
    writer = pytest.importorskip("pyarrow.parquet")
    names = ["time", "position", "torque"]
    block = pyarrow.table({name: np.zeros(10_000_000) for name in names})
    with writer.ParquetWriter(path, block.schema, compression="zstd") as file:
        for _ in range(10):
            file.write_table(block)


BOMBS = {
    ".csv.gz": csv_gz,
    ".npz": npz,
    ".mat": mat,
    ".h5": h5,
    ".mcap": mcap,
    ".bag": bag,
    ".db3": db3,
    ".parquet": parquet,
}


@on_linux
@pytest.mark.parametrize("ending", slow_but(BOMBS, ".csv.gz", ".h5"))
def test_a_bomb_is_refused_in_little_memory(ending: str, tmp_path: Path) -> None:
    path = tmp_path / f"bomb{ending}"
    BOMBS[ending](path)
    assert path.stat().st_size < 8_000_000
    sentence = refusal(path)
    assert "unpacked file is larger than" in sentence
    assert "load with unpacked=..." in sentence


_NAMES = b"time,position,torque\n"
TEXTS = {  # just below what may be unpacked, or just below what may become texts
    "short lines": (b"1\n", 18_000_000, "unpacked file is larger than"),
    "time stamps": (b"2025-11-01 12:26:40.5,0,1.000000\n", 4_000_000, "unpacked file is larger"),
    "quoted": (b'"0","0","0"\n', 2_000_000, "time stamps must strictly increase"),
    "a word": (b"0,0.00000000,word\n", 6_000_000, "unpacked file is larger than"),
    "long": (b'"0",0,' + b"1" * 4000 + b"\n", 35_000, "torque is inf"),
}


@on_linux
@pytest.mark.parametrize("name", slow_but(TEXTS, "short lines"))
def test_a_packed_text_is_cut_in_little_memory(name: str, tmp_path: Path) -> None:
    line, count, expected = TEXTS[name]
    path = tmp_path / "a.csv.gz"
    path.write_bytes(gzip.compress(_NAMES + line * count) + gzip.compress(b"") * 135_000)
    assert 2_700_000 < path.stat().st_size < 3_500_000
    assert expected in refusal(path)


@pytest.mark.parametrize("ending", [".csv.gz", ".npz"])
def test_the_limit_can_be_raised(
    ending: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A recording of a joint that hardly moves is packed like a bomb."""
    monkeypatch.setattr(unpacking, "LEAST", 1000)
    monkeypatch.setattr(unpacking, "TIMES", 2)
    time = np.arange(2000) * 1e-3
    run = jid.Recording(time=time, position=np.zeros(2000), torque=np.zeros(2000))
    path = tmp_path / f"still{ending}"
    run.save(path)
    with pytest.raises(jid.InputError, match="the limit for this packed size"):
        jid.load(path)
    assert jid.load(path, unpacked=200_000).fingerprint == run.fingerprint
    with pytest.raises(jid.InputError, match=r"unpacked is -1: a number of bytes"):
        jid.load(path, unpacked=-1)


def test_several_members_are_counted_together(tmp_path: Path) -> None:
    run = b"time_s,position,torque\n" + b"".join(b"%d,0,1\n" % k for k in range(20))
    path = tmp_path / "a.csv.gz"
    path.write_bytes(gzip.compress(run[:40]) + gzip.compress(run[40:]) + bytes(100))
    assert len(jid.load(path).time) == 20
    room = unpacking.Room(path)
    room.left = len(run) - 1
    with pytest.raises(jid.InputError, match="unpacked file is larger"):
        room.gunzip(path.read_bytes())
