"""Frames from a log file: of a session, of candump, or of another program with a format that python-can reads."""

from __future__ import annotations

import math
from collections.abc import Iterator
from io import StringIO
from pathlib import Path
from typing import Any, NamedTuple

import can

from jointid.base.error_text import reason_of
from jointid.base.errors import InputError
from jointid.base.unpacking import TooLargeError
from jointid.hardware.can.blf_file import unpacked

_HIGHEST, _HIGHEST_EXTENDED = 0x7FF, 0x1FFFFFFF  # identifiers of 11 and 29 bits
_LONGEST = 64  # bytes; a drive of another make may use long frames
ENDINGS = (".log", ".asc", ".blf")


class LoggedFrame(NamedTuple):
    """A frame of a frame log.

    Attributes
    ----------
    time : float
        Time on the log's clock [s].
    identifier : int
    payload : bytes
    extended : bool
        Whether the identifier has 29 bits. Default False: 11 bits.
    fd : bool
        Whether this is a CAN FD frame. Default False.
    sent : bool
        Whether the host sent the frame, if the log shows this. Default False.
    """

    time: float
    identifier: int
    payload: bytes
    extended: bool = False
    fd: bool = False
    sent: bool = False


def logged_frames(path: Path) -> Iterator[LoggedFrame]:
    """Yield the frames in the order of the file, without error frames and requests without bytes.

    A received frame with an identifier that the host also sends is from another master. It is left out, too, if the
    file marks the sent frames. An incomplete last line is ignored. Errors do not name the file; the caller adds it.

    Parameters
    ----------
    path : Path
        ``.log`` (candump), ``.asc`` or ``.blf``.

    Raises
    ------
    InputError
        The file cannot be read, or is much larger when unpacked. Or a frame is not possible on a bus: an identifier
        above 7FFh (1FFFFFFFh for 29 bits), more than 64 bytes, a time stamp that is not finite.
    """
    if path.suffix.lower() not in ENDINGS:
        raise InputError(
            f"the name of a frame log must end in {', '.join(ENDINGS)}",
            argument="log",
            value=path.name,
        )
    number, sent = 0, set[tuple[int, bool]]()
    try:
        for message in _messages(path):
            number += 1
            if message.is_error_frame or message.is_remote_frame:
                continue
            problem = _problem(message)
            if problem:
                raise InputError(f"frame {number} {problem}")
            key = message.arbitration_id, message.is_extended_id
            if not message.is_rx:
                sent.add(key)
            if not message.is_rx or key not in sent:
                yield LoggedFrame(
                    message.timestamp,
                    message.arbitration_id,
                    bytes(message.data),
                    extended=message.is_extended_id,
                    fd=message.is_fd,
                    sent=not message.is_rx,
                )
    except TooLargeError as error:  # its remedy belongs to `load`, and it names the file
        raise InputError(error.reason) from None
    except InputError:
        raise
    except FileNotFoundError:
        raise InputError("there is no such file") from None
    except OSError as error:
        raise InputError(f"the file cannot be read ({error.strerror})") from None
    except Exception as error:  # each reader of python-can raises its own errors
        raise InputError(
            f"the data after frame {number} do not form a frame ({reason_of(error)})"
        ) from error


def _problem(message: can.Message) -> str:
    """Return the reason why a message is not a valid frame; python-can's readers do not check this."""
    if not math.isfinite(message.timestamp):
        return "has a time stamp that is not a finite number"
    highest = _HIGHEST_EXTENDED if message.is_extended_id else _HIGHEST
    if not 0 <= message.arbitration_id <= highest:
        return f"has the identifier {message.arbitration_id:X}h, above {highest:X}h"
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
