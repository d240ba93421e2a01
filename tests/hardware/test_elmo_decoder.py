"""The decoder of cyclic frames: what completes a SYNC, which bytes are what, and frames that are none of them."""

import struct

import pytest

import jointid as jid
from jointid.hardware.elmo.decoder import ElmoDecoder
from jointid.hardware.elmo.options import ElmoOptions
from jointid.hardware.elmo.torque_source import AnalogInput, SyncedConverter

_JOINT = jid.thesis_joint()
_OPTIONS = ElmoOptions(counts_per_turn=1000)
_CONVERTER = SyncedConverter().identifier


def decoder(options: ElmoOptions = _OPTIONS) -> ElmoDecoder:
    made = ElmoDecoder(_JOINT, options)
    made.rated_current = 10.0
    return made


def position(counts: int, current: int = 0) -> bytes:
    return struct.pack("<ih", counts, current)


def test_position_and_current_are_signed() -> None:
    read = decoder()
    assert read.take(_OPTIONS.position_id, position(-1000, -250))
    assert read.position == pytest.approx(-_OPTIONS.angle(1000, _JOINT))
    assert read.current == -2.5  # a thousandth of the rated current is one


@pytest.mark.parametrize("length", [4, 5])
def test_a_short_frame_has_no_current(length: int) -> None:
    read = decoder()
    read.current = 7.0
    assert read.take(_OPTIONS.position_id, position(5, 250)[:length].ljust(length, b"\1"))
    assert read.current == 7.0


def test_a_frame_too_short_for_a_position_is_none() -> None:
    assert not decoder().take(_OPTIONS.position_id, b"\1\2\3")
    assert not decoder().take(0x123, bytes(8))


def test_a_sync_is_complete_with_both_answers() -> None:
    read = decoder()
    read.begin()
    assert (read.complete, read.lacking) == (False, "position")
    read.take(_OPTIONS.position_id, position(1))
    assert (read.complete, read.lacking) == (False, "torque sensor's reading")
    read.take(_CONVERTER, struct.pack("<i", 0))
    assert (read.complete, read.lacking) == (True, "")


def test_another_sensor_is_not_waited_for() -> None:
    read = decoder(ElmoOptions(torque=AnalogInput()))
    read.begin()
    read.take(_OPTIONS.position_id, position(1))
    assert (read.complete, read.lacking) == (True, "")


def test_an_answer_too_many_completes_no_later_sync() -> None:
    """Two answers to one SYNC: the next SYNC still waits for its own."""
    read = decoder()
    read.begin()
    for _ in range(2):
        read.take(_OPTIONS.position_id, position(1))
        read.take(_CONVERTER, struct.pack("<i", 0))
    assert read.surplus == 1
    read.begin()
    assert read.lacking == "position"
    read.take(_OPTIONS.position_id, position(1))
    assert read.lacking == "torque sensor's reading"
    assert read.surplus == 1


def test_a_reading_at_the_end_of_the_range_is_clipped() -> None:
    read = decoder()
    source = SyncedConverter()
    top = source.conversions * (1 << source.bits) - 1
    for total, clipped in ((top, True), (top // 2, False), (0, True)):
        read.begin()
        assert not read.fresh
        read.take(_CONVERTER, struct.pack("<i", total))
        assert (read.fresh, read.clipped) == (True, clipped)
    assert read.readings == 3


def test_forgotten_answers_are_not_expected() -> None:
    read = decoder()
    read.begin()
    read.forget()
    assert read.complete
