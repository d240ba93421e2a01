"""Values of the drive's interpreter: a float that is none is refused, whichever it is."""

import struct

import pytest

import jointid as jid
from jointid.hardware.elmo.codec import _FLOAT, _value


@pytest.mark.parametrize("value", [float("inf"), -float("inf"), float("nan")])
def test_a_value_without_end_is_refused(value: float) -> None:
    with pytest.raises(jid.InputError, match="a finite value is expected"):
        _value(b"PX\x00\x80" + struct.pack("<f", value), _FLOAT)
    assert _value(b"PX\x00\x80" + struct.pack("<f", 1.5), _FLOAT) == 1.5
