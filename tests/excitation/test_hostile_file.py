"""No value anywhere in a design's file makes anything but a sentence, or a design that can be shown."""

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from dealt_places import dealt
from designs import designed
from hypothesis import given, settings
from hypothesis import strategies as st

import jointid as jid
from jointid.base.toml_text import toml_of
from jointid.simulation.motion_file import load_motion

DESIGN = designed(believed={"coulomb": (20.0, 30.0)})
DOCUMENT = DESIGN.to_dict()
# As TOML writes them; a date is a type that JSON does not have.
VALUES = (
    *("nan", "inf", "-inf", "1e400", "5e-324", "1e308", "-1e308", "-1.0", "0.0", "0", "-0.0"),
    *("9223372036854775808", "-9223372036854775809", "1" * 400, "true", "1979-05-27"),
    *('""', '"nan"', '"text"', '"60deg"', '"\\u0000"', f'"{"x" * 20_000}"'),
    *("[]", "[[]]", "[1.0]", "[nan, nan]", "[0.0, 5e-324]", "[-1e308, 1e308]", '["a", 1.0]'),
    *("{}", "{a = 1}", "{a = {a = {a = nan}}}", "[" * 30 + "]" * 30),
)
_MARK = "@here@"


def _places(table: Any, inside: tuple[Any, ...] = ()) -> Iterator[tuple[Any, ...]]:
    """Every table, key and item of a document."""
    items = table.items() if isinstance(table, dict) else enumerate(table)
    for key, value in items:
        yield (*inside, key)
        if isinstance(value, dict | list):
            yield from _places(value, (*inside, key))


# One parameter stands for the others, some settings for all; joint files have tests of their own.
PLACES = tuple(
    place
    for place in _places(DOCUMENT)
    if not {"static", "viscous", "sensor_gain", "sensor_offset"} & {*place[1:2]}
    and not (place[0] in ("controller", "sensors") and len(place[-1]) % 3)
    and not (place[0] == "joint" and len(place) > 2)
)


def _text(changes: dict[tuple[Any, ...], str]) -> str:
    """The file's text with some values replaced by TOML of another kind."""

    def changed(value: Any, here: tuple[Any, ...]) -> Any:
        if here in changes:
            return f"{_MARK}{[*changes].index(here)}@"
        if isinstance(value, dict):
            return {key: changed(each, (*here, key)) for key, each in value.items()}
        if isinstance(value, list):
            return [changed(each, (*here, number)) for number, each in enumerate(value)]
        return value

    # A table becomes a key, which stands before the tables.
    document: dict[str, Any] = changed(DOCUMENT, ())
    text = toml_of(document)
    for number, new in enumerate(changes.values()):
        text = text.replace(f'"{_MARK}{number}@"', new)
    return text


def _used(path: Path) -> None:
    """All that a user or a session may ask of a file; bad input is one sentence with its name."""
    for use in (_shown, _warned):
        try:
            use(path)
            said = path.name
        except jid.InputError as error:
            said = str(error)
        assert path.name in said
        assert "\n" not in said


def _shown(path: Path) -> None:
    found = jid.load_design(path)
    assert found.summary()
    assert found._repr_html_()
    found.save(path.with_name("again.toml"))
    assert jid.load_design(path.with_name("again.toml")) == found


def _warned(path: Path) -> None:
    motion = load_motion(path)
    if motion.designed_for is not None:
        motion.designed_for.warning(motion.trajectory, DESIGN.joint, DESIGN.controller, 1e-3)


@pytest.mark.parametrize("shares", [6, pytest.param(1, marks=pytest.mark.slow)])
@pytest.mark.parametrize("value", VALUES, ids=[value[:12] for value in VALUES])
def test_one_value_anywhere(value: str, shares: int, tmp_path: Path) -> None:
    path = tmp_path / "motion.toml"
    for place in dealt(PLACES, VALUES.index(value), shares):
        path.write_text(_text({place: value}), encoding="utf-8")
        _used(path)


@settings(max_examples=60, deadline=None)
@given(
    st.dictionaries(st.sampled_from(PLACES), st.sampled_from(VALUES), min_size=2, max_size=6),
    st.sampled_from(PLACES),
)
def test_some_values_together(
    tmp_path_factory: pytest.TempPathFactory,
    changes: dict[tuple[Any, ...], str],
    lost: tuple[Any, ...],
) -> None:
    path = tmp_path_factory.mktemp("hostile") / "motion.toml"
    path.write_text(_text(changes), encoding="utf-8")
    _used(path)
    gone = [line for line in _text({}).splitlines() if not line.startswith(f"{lost[-1]} = ")]
    path.write_text("\n".join(gone), encoding="utf-8")
    _used(path)


@pytest.mark.parametrize(
    "text",
    [
        "",
        "\ufeff",
        "[" * 100_000,
        "a = " + "[" * 100_000 + "]" * 100_000,
        "a = " + "{a = " * 20_000 + "1" + "}" * 20_000,
        "a" + ".a" * 2_000 + " = 1",
        "[trajectory]\n" * 2,
        "\x00" * 1000,
        "trajectory = 1",
        "[trajectory]\nform = 'sines'\namplitude = [" + "1e308," * 10_001 + "]",
    ],
    ids=lambda text: text[:12],
)
def test_texts_that_are_no_design(text: str, tmp_path: Path) -> None:
    path = tmp_path / "motion.toml"
    path.write_text(text, encoding="utf-8")
    for load in (jid.load_design, load_motion):
        with pytest.raises(jid.InputError, match=r"motion\.toml") as refused:
            load(path)
        assert "\n" not in str(refused.value)
        assert len(str(refused.value)) < 400
