"""Frame logs: what no bus can carry is refused, with the frame's number."""

from pathlib import Path

import pytest

import jointid as jid
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
