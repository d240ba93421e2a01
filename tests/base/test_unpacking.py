"""Files of several gzip members: the same bytes as the library's, in a time that grows with the file."""

import gzip
import zlib
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from jointid.base import unpacking
from jointid.base.unpacking import Room

_MEMBERS = st.lists(
    st.tuples(st.binary(max_size=600), st.integers(0, 3)).map(
        lambda each: gzip.compress(each[0] * 3, 1, mtime=0) + bytes(each[1])
    ),
    min_size=1,
    max_size=6,
)


@given(_MEMBERS, st.integers(0, 4000))
def test_members_are_joined(members: list[bytes], end: int) -> None:
    content = b"".join(members)
    room = Room(Path("a.gz"), len(content), least=10**9)
    assert room.gunzip(content) == gzip.decompress(content)
    cut = content[:end]
    try:
        expected = gzip.decompress(cut)
    except (EOFError, zlib.error, gzip.BadGzipFile):
        with pytest.raises((EOFError, zlib.error)):
            room.gunzip(cut)
    else:
        assert room.gunzip(cut) == expected


def test_what_is_behind_a_member_is_not_read_for_each(monkeypatch: pytest.MonkeyPatch) -> None:
    fed = 0

    class Member:
        def __init__(self, bits: int) -> None:
            self._member = zlib.decompressobj(bits)

        def decompress(self, piece: bytes, most: int) -> bytes:
            nonlocal fed
            fed += len(piece)
            return self._member.decompress(piece, most)

        def __getattr__(self, name: str) -> Any:
            return getattr(self._member, name)

    class Library:
        MAX_WBITS = zlib.MAX_WBITS
        decompressobj = Member

    monkeypatch.setattr(unpacking, "zlib", Library)
    content = gzip.compress(b"a") * 20_000
    assert Room(Path("a.gz"), len(content)).gunzip(content) == b"a" * 20_000
    assert fed < 20 * len(content)
