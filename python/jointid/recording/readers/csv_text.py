"""The text of a .csv or .csv.gz file: decompression and encoding."""

import re
import zlib
from pathlib import Path

from jointid import _core
from jointid.base.error_text import reason_of
from jointid.base.errors import InputError
from jointid.base.unpacking import Room

_GZIP = b"\x1f\x8b"
_BOM = b"\xef\xbb\xbf"
_LEAST = 100_000_000  # bytes that the numbers of any packed text may use, however small the file is
# The same for lines and cells as Python texts; a larger file may use this multiple of its additional size.
_LEAST_AS_TEXTS, _USUAL, _TIMES_AS_TEXTS = 250_000_000, 3_000_000, 200
_LINE, _CELL = 110, 64  # bytes of each Python text, in addition to a line's characters
# Characters on which Latin-1 and Windows-1252 agree.
# A text with one of these characters uses 4 or 2 bytes for every character.
_ANY_OF_FOUR, _ANY_OF_TWO = rb"[\xf0-\xf4][\x80-\xbf]{3}", rb"[\xc4-\xef][\x80-\xbf]"
_LATIN = rb"[\x09-\x0d\x20-\x7e\xa0-\xfe]*"


def text_of(path: Path) -> str:
    """Return the text of a file: UTF-8, or Latin-1 if the bytes are clearly Latin-1.

    Raises
    ------
    InputError
        The file is damaged, empty, or not text.
    """
    content = path.read_bytes()
    if path.name.lower().endswith(".gz"):
        content = _unzipped(path, content)
    elif content.startswith(_GZIP):
        raise InputError(
            "the file is compressed by gzip; its name must end in .csv.gz", place=str(path)
        )
    text = _decoded(path, content)
    if not text or text.isspace():
        raise InputError(
            "the file is empty; a header and rows of numbers are expected", place=str(path)
        )
    return text


class Texts:
    """Memory limit for the lines of a packed file as separate texts; plain files have no limit.

    Parameters
    ----------
    path : Path
    """

    def __init__(self, path: Path) -> None:
        self._room: Room | None = None
        if path.name.lower().endswith(".gz"):
            more = max(0, path.stat().st_size - _USUAL) * _TIMES_AS_TEXTS
            self._room = Room(path, least=_LEAST_AS_TEXTS + more)

    def count(self, text: str, cells: int = 0) -> None:
        """Count the memory of a text that is split into lines, and of its cells if they also become separate texts.

        Raises
        ------
        InputError
            The file exceeds the memory limit.
        """
        if self._room is None:
            return
        pairs = text.count("\r\n")
        lines = text.count("\n") + text.count("\r") - pairs
        copied = 1 + ("\r" in text) + (cells > 0)  # normalized text, lines, cells
        self._room.again()
        self._room.take(copied * len(text) + _LINE * lines + _CELL * cells)


def _decoded(path: Path, content: bytes) -> str:
    try:
        text = (content[len(_BOM) :] if content.startswith(_BOM) else content).decode("utf-8")
    except UnicodeDecodeError as error:
        if re.fullmatch(_LATIN, content):  # older Windows programs write the degree sign in Latin-1
            return content.decode("latin-1")
        line = content.count(b"\n", 0, error.start) + 1
        raise InputError(
            f"the byte 0x{content[error.start]:02x} is not UTF-8 text",
            place=f"{path}, line {line}",
            remedy="save the file as UTF-8",
        ) from None
    control = _core.find_control_character(content)
    if control >= 0:
        line = content.count(b"\n", 0, control) + 1
        what = "a zero byte" if content[control] == 0 else f"the byte 0x{content[control]:02x}"
        raise InputError(
            f"{what} is not text", place=f"{path}, line {line}", remedy="save the file as UTF-8"
        )
    return text


def _count(content: bytes, room: Room) -> None:
    """Count the memory of a packed text in addition to its bytes: its numbers, and wide characters."""
    blanks = content.count(b" ") - content.count(b"  ")  # of several adjacent blanks, some count
    separators = max(blanks, *map(content.count, (b",", b";", b"\t")))
    cells = separators + content.count(b"\n")
    wide = re.search(_ANY_OF_FOUR, content) or re.search(_ANY_OF_TWO, content)
    width = 0 if wide is None else 4 if wide[0][0] >= 0xF0 else 2
    room.take(8 * cells + width * len(content))


def _unzipped(path: Path, content: bytes) -> bytes:
    if not content.startswith(_GZIP):
        raise InputError(
            "the file is not compressed by gzip, although its name ends in .gz",
            place=str(path),
            remedy="rename the file to .csv if it is plain text",
        )
    try:
        text = Room(path, len(content)).gunzip(content)
        _count(text, Room(path, len(content), least=_LEAST))
        return text
    except EOFError:
        raise InputError(
            "the compressed file is truncated",
            place=str(path),
            remedy="copy or record the file again",
        ) from None
    except zlib.error as error:
        reason = "CRC check failed" if "data check" in str(error) else reason_of(error)
        raise InputError(f"the compressed file is damaged ({reason})", place=str(path)) from None
