"""Elmo's interpreter frames: the manual's vectors both ways, and no crash on any bytes."""

import math
from typing import Any

import pytest
from hypothesis import example, given
from hypothesis import strategies as st

import jointid as jid
from jointid.hardware.elmo.codec import Command, DriveError, Reply, refusal
from jointid.hardware.elmo.errors import DriveStatus, Emergency, error_meaning, failure_meaning

COMMANDS = [
    ("54 43 00 80 00 00 80 3F", Command(letters="TC", value=1.0)),
    ("43 4C 01 80 00 00 80 3F", Command(letters="CL", index=1, value=1.0)),
    ("41 43 00 00 F0 49 02 00", Command(letters="AC", value=150000)),
    ("41 43 00 00", Command(letters="AC")),
    ("43 41 12 00 00 10 00 00", Command(letters="CA", index=18, value=4096)),
    ("42 47 00 00", Command(letters="BG")),
    ("4D 4F 00 00 01 00 00 00", Command(letters="MO", value=1)),
    ("4D 4F 00 00 00 00 00 00", Command(letters="MO", value=0)),
    ("55 4D 00 00 01 00 00 00", Command(letters="UM", value=1)),
    ("52 4D 00 00 00 00 00 00", Command(letters="RM", value=0)),
    ("53 54 00 00", Command(letters="ST")),
    ("50 58 00 00", Command(letters="PX")),
    ("56 58 00 00", Command(letters="VX")),
    ("49 51 00 00", Command(letters="IQ")),
    ("53 52 00 00", Command(letters="SR")),
    ("4D 46 00 00", Command(letters="MF")),
    ("45 43 00 00", Command(letters="EC")),
]
REPLIES = [
    ("41 43 00 00 F0 49 02 00", Reply(letters="AC", index=0, value=150000)),
    ("45 54 E0 03 79 7D 00 00", Reply(letters="ET", index=992, value=32121)),
    ("42 47 00 00 00 00 00 00", Reply(letters="BG", index=0, value=0)),
    ("54 43 00 80 00 00 80 3F", Reply(letters="TC", index=0, value=1.0)),
]


@pytest.mark.parametrize(("text", "command"), COMMANDS, ids=lambda each: str(each)[:20])
def test_commands_of_the_manual_both_ways(text: str, command: Command) -> None:
    assert command.payload() == bytes.fromhex(text)
    assert Command.of(bytes.fromhex(text)) == command


@pytest.mark.parametrize(
    ("text", "command"),
    [
        ("41 43 00 40 00 00 00 00", Command(letters="AC")),
        ("45 54 E0 43 00 00 00 00", Command(letters="ET", index=992)),
    ],
)
def test_queries_of_eight_bytes_are_understood_but_never_sent(text: str, command: Command) -> None:
    assert Command.of(bytes.fromhex(text)) == command
    assert len(command.payload()) == 4


@pytest.mark.parametrize(("text", "reply"), REPLIES, ids=lambda each: str(each)[:20])
def test_replies_of_the_manual_both_ways(text: str, reply: Reply) -> None:
    assert reply.payload() == bytes.fromhex(text)
    assert Reply.of(bytes.fromhex(text)) == reply
    assert type(Reply.of(bytes.fromhex(text)).value) is type(reply.value)


@pytest.mark.parametrize(
    ("text", "letters", "index", "code", "meaning"),
    [
        ("43 41 01 40 15 00 00 00", "CA", 1, 21, "out of range"),
        ("42 47 00 40 3A 00 00 00", "BG", 0, 58, "motor must be on"),
    ],
)
def test_refusals_of_the_manual_both_ways(
    text: str, letters: str, index: int, code: int, meaning: str
) -> None:
    assert refusal(letters, index, code) == bytes.fromhex(text)
    with pytest.raises(DriveError, match=meaning) as wording:
        Reply.of(bytes.fromhex(text))
    assert (wording.value.letters, wording.value.index, wording.value.code) == (
        letters,
        index,
        code,
    )


@given(
    st.binary(max_size=8)
    | st.builds(bytes.__add__, st.sampled_from((b"TC", b"AA", b"PX")), st.binary(max_size=6))
)
def test_any_bytes_are_a_value_or_a_named_error(payload: bytes) -> None:
    for decode in (Command.of, Reply.of):
        found, refused, unusable = _decoded(decode, payload)
        if refused is not None:
            assert payload[3] & 0x40
            assert refused.code == int.from_bytes(payload[4:8], "little")
        elif unusable is not None:
            assert str(unusable)
        else:
            assert len(payload) in (4, 8)
            assert decode == Command.of or not payload[3] & 0x40
            assert found.value is None or math.isfinite(found.value)


def _decoded(decode: Any, payload: bytes) -> tuple[Any, DriveError | None, Exception | None]:
    try:
        return decode(payload), None, None
    except jid.InputError as error:
        return None, None, error
    except DriveError as error:
        return None, error, None


@given(
    letters=st.text("ABCDEFGHIJKLMNOPQRSTUVWXYZ", min_size=2, max_size=2),
    index=st.integers(0, 0x3FFF),
    value=st.none()
    | st.integers(-(2**31), 2**31 - 1)
    | st.floats(width=32, allow_nan=False, allow_infinity=False),
)
@example(letters="TC", index=0, value=3.4028234663852886e38)
def test_every_command_comes_back(letters: str, index: int, value: int | float | None) -> None:
    command = Command(letters=letters, index=index, value=value)
    assert Command.of(command.payload()) == command
    if value is not None:
        assert Reply.of(command.payload()).value == value


@pytest.mark.parametrize(
    ("fields", "wording"),
    [
        ({"letters": "tc"}, "two capital letters"),
        ({"letters": "TCX"}, "two capital letters"),
        ({"letters": "TC", "index": -1}, "0 to 16383"),
        ({"letters": "TC", "index": 16384}, "0 to 16383"),
        ({"letters": "TC", "value": math.nan}, "finite"),
        ({"letters": "TC", "value": math.inf}, "finite"),
        ({"letters": "TC", "value": 1e300}, "finite 32-bit float"),
        ({"letters": "MO", "value": 2**31}, "32-bit integer"),
        ({"letters": "MO", "value": True}, "an int or a float"),
    ],
)
def test_what_no_frame_can_hold_is_refused(fields: dict[str, object], wording: str) -> None:
    with pytest.raises(jid.InputError, match=wording):
        Command(**fields)  # type: ignore[arg-type]


def test_registers_speak() -> None:
    assert error_meaning(57) == "the motor must be off"
    assert error_meaning(9999) == "not listed"
    assert failure_meaning(0) == ""
    assert failure_meaning(0x800) == "heartbeat lost"
    assert failure_meaning(0x1000 | 0xC000 | 0x8) == "peak current exceeded, over-temperature"
    assert "unknown" in failure_meaning(0x80000000)
    status = DriveStatus.of(0x10 | 0x40 | (1 << 7) | 0x2000 | 0x1 | (6 << 1))
    assert (status.motor_on, status.failure, status.unit_mode) == (True, True, 1)
    assert (status.current_limited, status.problem) == (True, "over-temperature")
    assert DriveStatus.of(0).problem == ""
    emergency = Emergency.of(bytes.fromhex("30 81 11 00 00 00 00 00"))
    assert emergency is not None
    assert (emergency.code, emergency.meaning) == (0x8130, "heartbeat lost")
    failed = Emergency.of(bytes.fromhex("00 63 00 3A 00 00 00 00"))
    assert failed is not None
    assert "the motor must be on (EC 58)" in failed.meaning
    assert Emergency.of(b"\x00") is None


def test_the_least_integer_fits_and_the_next_does_not() -> None:
    least = Command(letters="PX", value=-(2**31))
    assert Command.of(least.payload()) == least
    with pytest.raises(jid.InputError, match="32-bit"):
        Command(letters="PX", value=-(2**31) - 1)


def test_a_truth_value_is_no_index() -> None:
    with pytest.raises(jid.InputError, match="a whole number is expected"):
        Command(letters="CL", index=True)
