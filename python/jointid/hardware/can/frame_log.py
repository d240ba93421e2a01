"""Frames out of a log file: what a session wrote, candump, or any program whose format python-can reads."""

from __future__ import annotations

import math
from collections.abc import Iterator
from io import StringIO
from pathlib import Path
from typing import Any

import can

from jointid.base.error_text import reason_of
from jointid.base.errors import InputError
from jointid.base.unpacking import TooLargeError
from jointid.hardware.can.blf_file import unpacked

_HIGHEST = 0x7FF  # identifier of 11 bits
_LONGEST = 64  # bytes: a drive of another make may use long frames
ENDINGS = (".log", ".asc", ".blf")

LoggedFrame = tuple[float, int, bytes]  # time [s], identifier, payload


def logged_frames(path: Path) -> Iterator[LoggedFrame]:
    """Yield the frames with 11-bit identifiers, in the file's order; error frames are left out.

    Frames that were received although the host sends frames with their identifier are another master's,
    and are left out too, where the file says which were sent. A last line that is cut off is no frame.
    Frames of CAN FD are left out, too. Errors do not name the file: the caller does.

    Parameters
    ----------
    path : Path
        ``.log`` (candump), ``.asc`` or ``.blf``.

    Raises
    ------
    InputError
        The file cannot be read, or a frame is none that a bus can carry: an identifier above 7FFh, more than 64 bytes,
        a stamp that is not finite; or it is much larger when it is unpacked.
    """
    if path.suffix.lower() not in ENDINGS:
        raise InputError(
            f"the name of a frame log ends in {', '.join(ENDINGS)}",
            argument="log",
            value=path.name,
        )
    number, sent = 0, set[int]()
    try:
        for message in _messages(path):
            number += 1
            if message.is_error_frame or message.is_remote_frame or message.is_extended_id:
                continue
            if message.is_fd:  # no drive's: CANopen sends classic frames
                continue
            problem = _problem(message)
            if problem:
                raise InputError(f"frame {number} {problem}")
            if not message.is_rx:
                sent.add(message.arbitration_id)
            if not message.is_rx or message.arbitration_id not in sent:
                yield message.timestamp, message.arbitration_id, bytes(message.data)
    except TooLargeError as error:  # its remedy is one of `load`, and it names the file
        raise InputError(error.reason) from None
    except InputError:
        raise
    except FileNotFoundError:
        raise InputError("there is no such file") from None
    except OSError as error:
        raise InputError(f"the file cannot be read ({error.strerror})") from None
    except Exception as error:  # each of python-can's readers has errors of its own
        raise InputError(f"what follows frame {number} is no frame ({reason_of(error)})") from error


def _problem(message: can.Message) -> str:
    """What no frame with an 11-bit identifier has; python-can's readers do not look."""
    if not math.isfinite(message.timestamp):
        return "has a stamp that is no number"
    if not 0 <= message.arbitration_id <= _HIGHEST:
        return f"has the identifier {message.arbitration_id:X}h, above {_HIGHEST:X}h"
    if len(message.data) > _LONGEST:
        return f"has {len(message.data)} bytes, more than {_LONGEST}"
    return ""


def _messages(path: Path) -> Iterator[can.Message]:
    if path.suffix.lower() == ".log":
        text = path.read_text(encoding="ascii", errors="replace")
        reader: Any = can.CanutilsLogReader(StringIO(text[: text.rfind("\n") + 1]))
    elif path.suffix.lower() == ".asc":
        reader = can.ASCReader(path)
    else:
        reader = can.BLFReader(unpacked(path))
    with reader:
        yield from reader
