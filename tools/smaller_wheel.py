"""Deflates the files of a wheel anew, as small as deflate can: the same files, the same RECORD, for any zip reader.

Entries of folders, which auditwheel adds and no installer needs, are left out.

    python tools/smaller_wheel.py dist/wheels/jointid-*.whl

The standard library's zipfile writes only what its own compressor made: here the few records of a zip file are written
out. Names are ASCII, and files far below 4 GB.
"""

import struct
import sys
import zipfile
import zlib
from pathlib import Path

import zopfli.zlib

_DEFLATED = 8
_VERSION = 20  # 2.0: what deflate needs
_UNIX = 3 << 8  # who made it: the rights of files are Unix's


def deflated(content: bytes) -> bytes:
    """Return the smallest deflate stream of the content that zopfli finds."""
    as_many_as_pay = 0  # blocks; 15 at most by default
    whole: bytes = zopfli.zlib.compress(content, blocksplittingmax=as_many_as_pay)
    return whole[2:-4]  # without zlib's header and checksum


def make_smaller(wheel: Path) -> None:
    """Write the wheel anew in its place; its files keep their order, time and rights."""
    made, listed = bytearray(), bytearray()
    with zipfile.ZipFile(wheel) as given:
        files = [(file, given.read(file)) for file in given.infolist() if not file.is_dir()]
    for file, content in files:
        name, body = file.filename.encode("ascii"), deflated(content)
        year, month, day, hour, minute, second = file.date_time
        common = struct.pack(
            "<5H3L2H",
            *(_VERSION, 0, _DEFLATED),
            *(hour << 11 | minute << 5 | second // 2, (year - 1980) << 9 | month << 5 | day),
            *(zlib.crc32(content), len(body), len(content), len(name), 0),
        )
        place = (0, 0, 0, file.external_attr, len(made))  # no comment, one disk, no inner rights
        listed += b"PK\1\2" + struct.pack("<H", _UNIX | _VERSION) + common
        listed += struct.pack("<3H2L", *place) + name
        made += b"PK\3\4" + common + name + body
    end = struct.pack("<4H2LH", 0, 0, len(files), len(files), len(listed), len(made), 0)
    smaller = wheel.with_suffix(".smaller")
    smaller.write_bytes(made + listed + b"PK\5\6" + end)
    with zipfile.ZipFile(smaller) as again:
        if [(file.filename, again.read(file)) for file in again.infolist()] != [
            (file.filename, content) for file, content in files
        ]:
            raise SystemExit(f"{wheel.name}: the smaller wheel holds something else")
    smaller.replace(wheel)


if __name__ == "__main__":
    for path in sys.argv[1:]:
        make_smaller(Path(path))
