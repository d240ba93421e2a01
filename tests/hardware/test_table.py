"""A table of a joint file read into a dataclass: each error names file, table, key and value."""

import math
from dataclasses import dataclass
from typing import Any

import pytest

import jointid as jid
from jointid.base.errors import NOT_GIVEN
from jointid.hardware.bench.table import Table


@dataclass(frozen=True, kw_only=True)
class Options:
    port: str
    speed: float = 1.0
    node: int | None = None
    window: tuple[float, float] = (0.0, 1.0)

    def __post_init__(self) -> None:
        if self.speed < 0.0:
            raise jid.InputError("at least 0 is expected", argument="speed", value=self.speed)


def table(**entries: Any) -> Table:
    return Table(entries, "session.drive", "joint.toml")


def test_keys_become_fields() -> None:
    made = table(port="a", speed="180deg", node=None, window=[1, 2]).make(Options)
    assert made == Options(port="a", speed=math.pi, window=(1, 2))
    assert table(speed=2).make(Options, port="fixed").port == "fixed"


@pytest.mark.parametrize(
    ("entries", "argument", "value", "reason"),
    [
        ({}, "port", NOT_GIVEN, "missing; it has no default"),
        ({"port": "a", "sped": 1.0}, "sped", NOT_GIVEN, "unknown key; did you mean 'speed'?"),
        ({"port": 3}, "port", 3, "a text is expected"),
        ({"port": "a", "speed": "fast"}, "speed", "fast", "a number is expected"),
        ({"port": "a", "speed": True}, "speed", True, "a number is expected"),
        ({"port": "a", "speed": -1.0}, "speed", -1.0, "at least 0 is expected"),
        ({"port": "a", "node": 1.5}, "node", 1.5, "a whole number is expected"),
        ({"port": "a", "window": 3}, "window", 3, "a list of two numbers is expected"),
    ],
)
def test_what_is_wrong_is_an_error_with_its_place(
    entries: dict[str, Any], argument: str, value: object, reason: str
) -> None:
    with pytest.raises(jid.InputError) as refused:
        table(**entries).make(Options)
    error = refused.value
    assert (error.argument, error.value, error.reason) == (argument, value, reason)
    assert error.place == "joint.toml: [session.drive]"


def test_a_bug_in_the_dataclass_stays_a_bug() -> None:
    @dataclass
    class Broken:
        port: str = ""

        def __post_init__(self) -> None:
            raise TypeError("a bug")

    with pytest.raises(TypeError, match="a bug"):
        table(port="a").make(Broken)


def test_what_is_no_table_is_refused() -> None:
    with pytest.raises(jid.InputError) as refused:
        table(torque=3).table("torque")
    assert refused.value.argument == "session.drive.torque"
    assert refused.value.reason == "a table [session.drive.torque] is expected"
