"""Damage to bytes: what disks, editors, cut-off transfers and malice do to a file."""

import random

_WORDS = (
    *(b"nan", b"-inf", b"1e400", b"1e308", b"-1", b"0", b"", b"null", b"true", b"{}", b"[]", b'"'),
    *(b"\x00", b"\xff", b"\xff\xff\xff\xff", b"\x7f\xff\xff\xff", b"\r", b"\n", b",", b";", b"\t"),
    *(b"\xef\xbb\xbf", b"1" * 400, b"[" * 2000, b"\x00" * 64, b"<script>", b"\xed\xa0\x80"),
)


def damaged(seed: bytes, chance: random.Random) -> bytes:
    """Return a copy of a file with one to eight changes.

    Parameters
    ----------
    seed : bytes
        A valid file.
    chance : random.Random
    """
    data = bytearray(seed)
    for _ in range(chance.choice((1, 1, 1, 2, 4, 8))):
        place = chance.randrange(len(data) + 1)
        length = min(chance.choice((1, 1, 2, 4, 8, 64, 512)), len(data) - place)
        kind = chance.randrange(7)
        if kind == 0:
            data[place : place + length] = chance.randbytes(length)
        elif kind == 1:
            del data[place : place + length]
        elif kind == 2:
            data[place:place] = chance.choice(_WORDS)
        elif kind == 3:
            data[place : place + length] = chance.choice(_WORDS)
        elif kind == 4:  # a piece of it once more, elsewhere
            other = chance.randrange(len(data) + 1)
            data[other:other] = data[place : place + length]
        elif kind == 5 and place < len(data):
            data[place] ^= 1 << chance.randrange(8)
        elif chance.random() < 0.2:
            del data[place:]
    return bytes(data)
