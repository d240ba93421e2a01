"""Frames of CANopen, byte by byte, as CiA 301 writes them."""

import pytest

from jointid.hardware.can.canopen_frames import (
    SdoAbortError,
    SdoRequest,
    emergency_id,
    heartbeat_id,
    sdo_abort,
    sdo_answer,
    sdo_result,
)

READ = SdoRequest(index=0x6041, subindex=1)


def test_identifiers_of_a_node() -> None:
    assert (heartbeat_id(5), emergency_id(5)) == (0x705, 0x085)


@pytest.mark.parametrize(
    ("size", "value", "text"),
    [
        (1, 0x12, "2f 41 60 01 12 00 00 00"),
        (2, 0x1234, "2b 41 60 01 34 12 00 00"),
        (4, 0x12345678, "23 41 60 01 78 56 34 12"),
        (1, -1, "2f 41 60 01 ff 00 00 00"),  # its own bytes alone
    ],
)
def test_a_write_both_ways(size: int, value: int, text: str) -> None:
    request = SdoRequest(index=0x6041, subindex=1, value=value, size=size)
    assert request.payload() == bytes.fromhex(text)
    again = SdoRequest.of(request.payload())
    assert (again.size, again.value) == (size, value % 256**size)


def test_a_read_and_its_answers() -> None:
    assert READ.payload() == bytes.fromhex("40 41 60 01 00 00 00 00")
    assert SdoRequest.of(READ.payload()) == READ
    assert sdo_answer(READ, -2) == bytes.fromhex("43 41 60 01 fe ff ff ff")
    assert sdo_result(sdo_answer(READ, 7), READ) == 7
    assert sdo_result(bytes.fromhex("4b 41 60 01 34 12 56 78"), READ) == 0x1234
    assert sdo_result(bytes.fromhex("42 41 60 01 01 02 00 00"), READ) == 0x201  # no size is said
    assert sdo_result(sdo_answer(READ), READ) == 0


@pytest.mark.parametrize(
    "other", [SdoRequest(index=0x6041, subindex=2), SdoRequest(index=1, subindex=1)]
)
def test_the_answer_to_another_request_is_none(other: SdoRequest) -> None:
    assert sdo_result(sdo_answer(other, 7), READ) is None
    assert sdo_result(sdo_abort(other, 0x06020000), READ) is None


def test_what_is_no_answer_is_none() -> None:
    assert sdo_result(bytes.fromhex("81 41 60 01 00 00 02 06"), READ) is None
    assert sdo_result(bytes.fromhex("61 41 60 01 00 00 00 00"), READ) is None
    assert sdo_result(sdo_answer(READ, 7)[:7], READ) is None


def test_a_refusal_says_why() -> None:
    with pytest.raises(SdoAbortError, match="the object does not exist") as caught:
        sdo_result(sdo_abort(READ, 0x06020000), READ)
    assert caught.value.code == 0x06020000
