"""Frame logs: what no bus can carry is refused, with the frame's number."""

import random
import struct
import tracemalloc
import zlib
from pathlib import Path
from typing import Any

import can
import pytest
from fuzz.damage import damaged
from fuzz.seeds import seed_of

import jointid as jid
from jointid.hardware.can.blf_file import unpacked
from jointid.hardware.can.frame_log import logged_frames

_SOUND = "(1700000000.000000) can0 080#\n"


@pytest.mark.parametrize(
    ("line", "reason"),
    [
        ("(nan) can0 181#00\n", "frame 2 has a stamp that is no number"),
        ("(inf) can0 181#00\n", "frame 2 has a stamp that is no number"),
        ("(1e400) can0 181#00\n", "frame 2 has a stamp that is no number"),
        ("(1.0) can0 801#00\n", "frame 2 has the identifier 801h, above 7FFh"),
        ("(1.0) can0 FFF#00\n", "frame 2 has the identifier FFFh"),
        (f"(1.0) can0 181#{'00' * 65}\n", "frame 2 has 65 bytes, more than 64"),
        ("(1.0) can0\n", "what follows frame 1 is no frame"),
        ("(1.0) can0 zzz#00\n", "what follows frame 1 is no frame"),
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
        "(1.0) can0 12345678#00\n",  # an extended identifier
        "(1.0) can0 181##100112233445566778899\n",  # CAN FD
        "(1.0) can0 181#R\n",  # a request without bytes
    ],
)
def test_frames_that_are_not_looked_at(line: str, tmp_path: Path) -> None:
    path = tmp_path / "run.log"
    path.write_text(_SOUND + line + _SOUND, encoding="ascii")
    assert [identifier for _, identifier, _ in logged_frames(path)] == [0x080, 0x080]


def test_a_small_blf_file_that_holds_much_is_refused(tmp_path: Path) -> None:
    packed = zlib.compress(bytes(300_000_000), 9)
    size = 32 + len(packed)
    container = struct.pack("<4sHHLLH6xL4x", b"LOBJ", 16, 1, size, 10, 2, 300_000_000)
    path = tmp_path / "run.blf"
    path.write_bytes(seed_of("blf")[1][:144] + container + packed)
    tracemalloc.start()
    with pytest.raises(jid.InputError, match=r"^unpacked it is larger than 64 MB"):
        list(logged_frames(path))
    _, most = tracemalloc.get_traced_memory()
    tracemalloc.stop()
    assert most < 150_000_000


def _frames(file: Any) -> list[object]:
    """As far as python-can reads them, and whether it refuses the rest."""
    found: list[object] = []
    try:
        reader = can.BLFReader(file)
        found += [(each.timestamp, each.arbitration_id, bytes(each.data)) for each in reader]
    except Exception:
        found.append("refused")
    return found


def test_unpacked_files_hold_the_same_frames_and_faults(tmp_path: Path) -> None:
    seed, path = seed_of("blf")[1], tmp_path / "run.blf"
    assert len(_frames(unpacked(_written(path, seed)))) == 12
    for case in range(2000):
        _written(path, damaged(seed, random.Random(case)))
        with path.open("rb") as file:
            assert _frames(unpacked(path)) == _frames(file), case


def _written(path: Path, content: bytes) -> Path:
    path.write_bytes(content)
    return path
