"""The text of a .csv or .csv.gz file: decompression and encoding."""

import gzip
import re
import zlib
from pathlib import Path

from jointid.base.errors import InputError

_GZIP = b"\x1f\x8b"
# What no text of rows holds: control signs (other than tab and line ends), in any encoding.
_CONTROL = re.compile(rb"[\x00-\x08\x0e-\x1f\x7f]")
_CONTROLS = bytes([*range(9), *range(14, 32), 127])
# Signs that Latin-1 and Windows-1252 agree on, and no others.
_LATIN = re.compile(rb"[\x09-\x0d\x20-\x7e\xa0-\xfe]*")


def text_of(path: Path) -> str:
    """Return what a file says: UTF-8, or Latin-1 if it holds nothing that speaks against it.

    Raises
    ------
    InputError
        The file is damaged, empty, or no text.
    """
    content = path.read_bytes()
    if path.name.lower().endswith(".gz"):
        content = _unzipped(path, content)
    elif content.startswith(_GZIP):
        raise InputError(f"{path}: the file is compressed by gzip; its name must end in .csv.gz")
    text = _decoded(path, content)
    if not text or text.isspace():
        raise InputError(f"{path}: the file is empty; a header and rows of numbers are expected")
    return text


def _decoded(path: Path, content: bytes) -> str:
    try:
        text = content.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        if _LATIN.fullmatch(content):  # older Windows programs write the degree sign so
            return content.decode("latin-1")
        line = content.count(b"\n", 0, error.start) + 1
        raise InputError(
            f"{path}, line {line}: the byte 0x{content[error.start]:02x} is no UTF-8 text; "
            "save the file as UTF-8"
        ) from None
    # Deleting them all is four times as fast as looking for the first.
    if len(content.translate(None, _CONTROLS)) != len(content):
        control = _CONTROL.search(content)
        assert control is not None
        line = content.count(b"\n", 0, control.start()) + 1
        what = "a zero byte" if control[0] == b"\0" else f"the byte 0x{control[0][0]:02x}"
        raise InputError(f"{path}, line {line}: {what} is no text; save the file as UTF-8")
    return text


def _unzipped(path: Path, content: bytes) -> bytes:
    if not content.startswith(_GZIP):
        raise InputError(
            f"{path}: the file is not compressed by gzip, as .gz says; name it .csv if it is text"
        )
    try:
        return gzip.decompress(content)
    except EOFError:
        raise InputError(
            f"{path}: the compressed file ends in the middle; copy or record it again"
        ) from None
    except (OSError, zlib.error) as error:
        raise InputError(f"{path}: the compressed file is damaged ({error})") from None
