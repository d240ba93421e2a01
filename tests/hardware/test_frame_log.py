"""Frame logs: what no bus can carry is refused, with the frame's number; BLF holds what python-can reads of it."""

import random
import struct
import tracemalloc
import zlib
from collections.abc import Callable
from pathlib import Path
from typing import Any

import can
import pytest
from fuzz.damage import damaged
from fuzz.seeds import seed_of

import jointid as jid
from jointid.hardware.can.blf_file import unpacked
from jointid.hardware.can.frame_log import LoggedFrame, logged_frames

_SOUND = "(1700000000.000000) can0 080#\n"


@pytest.mark.parametrize(
    ("line", "reason"),
    [
        ("(nan) can0 181#00\n", "frame 2 has a time stamp that is not a finite number"),
        ("(inf) can0 181#00\n", "frame 2 has a time stamp that is not a finite number"),
        ("(1e400) can0 181#00\n", "frame 2 has a time stamp that is not a finite number"),
        ("(1.0) can0 801#00\n", "frame 2 has the identifier 801h, above 7FFh"),
        ("(1.0) can0 FFF#00\n", "frame 2 has the identifier FFFh"),
        (f"(1.0) can0 181#{'00' * 65}\n", "frame 2 has 65 bytes, more than 64"),
        ("(1.0) can0\n", "the data after frame 1 do not form a frame"),
        ("(1.0) can0 zzz#00\n", "the data after frame 1 do not form a frame"),
    ],
)
def test_a_frame_that_no_bus_carries(line: str, reason: str, tmp_path: Path) -> None:
    path = tmp_path / "run.log"
    path.write_text(_SOUND + line, encoding="ascii")
    with pytest.raises(jid.InputError, match=f"^{reason}"):
        list(logged_frames(path))


@pytest.mark.parametrize(
    "line",
    [
        "(1.0) can0 181#R\n",  # a request without bytes
    ],
)
def test_frames_that_are_not_looked_at(line: str, tmp_path: Path) -> None:
    path = tmp_path / "run.log"
    path.write_text(_SOUND + line + _SOUND, encoding="ascii")
    assert [frame.identifier for frame in logged_frames(path)] == [0x080, 0x080]


@pytest.mark.parametrize("ending", [".log", ".asc", ".blf"])
def test_frames_of_29_bits_and_of_can_fd_are_kept(ending: str, tmp_path: Path) -> None:
    frames = [
        LoggedFrame(1.0, 0x181, b"\x01", sent=True),
        LoggedFrame(1.25, 0x8001, b"\x02", extended=True),
        LoggedFrame(1.5, 0x181, b"\x03", extended=True),  # no foreign frame: another identifier
        LoggedFrame(1.75, 0x8001, bytes(range(24)), extended=True, fd=True, sent=True),
        LoggedFrame(2.0, 0x101, bytes(12), fd=True),
    ]
    log = tmp_path / "run.log"
    log.write_text(
        "(1.0) can0 181#01 T\n"
        "(1.25) can0 00008001#02 R\n"
        "(1.5) can0 00000181#03 R\n"
        f"(1.75) can0 00008001##1{bytes(range(24)).hex()} T\n"
        f"(2.0) can0 101##0{'00' * 12}\n",
        encoding="ascii",
    )
    other = tmp_path / f"run{ending}"
    if other != log:
        with can.LogReader(str(log)) as read, can.Logger(str(other)) as written:
            for frame in read:
                frame.channel = 0
                written(frame)
    found = list(logged_frames(other))
    first = found[0].time - 1.0
    assert [each._replace(time=round(each.time - first, 6)) for each in found] == frames


def test_a_small_blf_file_that_holds_much_is_refused(tmp_path: Path) -> None:
    packed = zlib.compress(bytes(300_000_000), 9)
    size = 32 + len(packed)
    container = struct.pack("<4sHHLLH6xL4x", b"LOBJ", 16, 1, size, 10, 2, 300_000_000)
    path = tmp_path / "run.blf"
    path.write_bytes(seed_of("blf")[1][:144] + container + packed)
    tracemalloc.start()
    with pytest.raises(jid.InputError, match=r"^the unpacked file is larger than 64 MB"):
        list(logged_frames(path))
    _, most = tracemalloc.get_traced_memory()
    tracemalloc.stop()
    assert most < 150_000_000


def _frames(open_file: Callable[[], Any]) -> list[object]:
    """As far as python-can reads them, and whether the rest is refused."""
    found: list[object] = []
    try:
        with can.BLFReader(open_file()) as reader:
            found += [(each.timestamp, each.arbitration_id, bytes(each.data)) for each in reader]
    except Exception:
        found.append("refused")
    return found


def test_unpacked_files_hold_the_same_frames_and_faults(
    tmp_path: Path, caplog: pytest.LogCaptureFixture
) -> None:
    seed, path = seed_of("blf")[1], tmp_path / "run.blf"
    path.write_bytes(seed)
    assert len(_frames(lambda: unpacked(path))) == 12
    for case in range(2000):
        path.write_bytes(damaged(seed, random.Random(case)))
        caplog.clear()
        with path.open("rb") as file:
            expected = _frames(lambda file=file: file)  # type: ignore[misc]
        left_out = any("Unknown compression" in each for each in caplog.messages)
        assert _frames(lambda: unpacked(path)) == (["refused"] if left_out else expected), case


def _container(objects: bytes, method: int = 0) -> bytes:
    """A part of a file that says by which method it is packed; 0: it is not."""
    size = 32 + len(objects)
    head = struct.pack("<4sHHLLH6xL4x", b"LOBJ", 16, 1, size, 10, method, len(objects))
    return head + objects + bytes(size % 4)


def _object(size: int, kind: int = 99) -> bytes:
    return struct.pack("<4sHHLL32x", b"LOBJ", 16, 1, size, kind)


# The rest of an object, or of its header, is in the next container.
@pytest.mark.parametrize("first", range(41, 97))
@pytest.mark.parametrize("size", [0, 15, 2_000_000])
def test_an_object_of_an_impossible_size_is_refused(size: int, first: int, tmp_path: Path) -> None:
    path, start = tmp_path / "run.blf", seed_of("blf")[1][:144]
    sound, wrong = _object(48) + bytes(3), _object(size)
    content = sound + sound + wrong + sound
    path.write_bytes(start + _container(content[:first]) + _container(content[first:]))
    with pytest.raises(jid.InputError, match=f"^an object has {size} bytes"):
        list(logged_frames(path))


@pytest.mark.parametrize("largest", [97, 1001, 1002, 1003, 131_072])
@pytest.mark.parametrize("level", [-1, 0])
def test_containers_of_every_length_hold_the_same_frames(
    largest: int, level: int, tmp_path: Path
) -> None:
    path = tmp_path / "run.blf"
    for append in (False, True):  # also behind what another program has added
        with can.BLFWriter(path, append=append, compression_level=level) as log:
            log.max_container_size = largest
            log.log_event("xx")
            for number in range(100):
                data = bytes(number % 9)
                log(can.Message(timestamp=float(number), arbitration_id=0x181, data=data))
    expected = _frames(lambda: path)
    assert len(expected) == 200
    assert _frames(lambda: unpacked(path)) == expected


def test_a_part_that_is_packed_in_another_way_is_not_left_out(tmp_path: Path) -> None:
    path = tmp_path / "run.blf"
    path.write_bytes(seed_of("blf")[1][:144] + _container(bytes(64), method=7))
    with pytest.raises(jid.InputError, match=r"^a part has the compression method 7"):
        list(logged_frames(path))
