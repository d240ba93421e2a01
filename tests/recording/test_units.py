"""Units: names as people write them, and values in SI."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from jointid.base.errors import InputError
from jointid.recording.headers import understood
from jointid.recording.units import UNITS, find_unit, unit_named, unit_names


@pytest.mark.parametrize(
    ("name", "value", "si"),
    [
        ("rad", 1.25, 1.25),
        ("mrad", 1250.0, 1.25),
        ("deg", 180.0, math.pi),
        ("rev", 0.5, math.pi),
        ("m", 0.3, 0.3),
        ("cm", 30.0, 0.3),
        ("mm", 300.0, 0.3),
        ("um", 3e5, 0.3),
        ("s", 2.5, 2.5),
        ("ms", 2500.0, 2.5),
        ("us", 2.5e6, 2.5),
        ("ns", 2.5e9, 2.5),
        ("min", 0.5, 30.0),
        ("rad_s", 3.0, 3.0),
        ("mrad_s", 3000.0, 3.0),
        ("deg_s", 90.0, math.pi / 2),
        ("rev_s", 1.0, 2 * math.pi),
        ("rpm", 60.0, 2 * math.pi),
        ("m_s", 0.1, 0.1),
        ("cm_s", 10.0, 0.1),
        ("mm_s", 100.0, 0.1),
        ("Nm", 7.0, 7.0),
        ("mNm", 7000.0, 7.0),
        ("kNm", 0.007, 7.0),
        ("Ncm", 700.0, 7.0),
        ("Nmm", 7000.0, 7.0),
        ("kgfm", 1.0, 9.80665),
        ("kgfcm", 100.0, 9.80665),
        ("ozfin", 1.0, 0.00706155181422604),
        ("lbfin", 1.0, 0.1129848290276167),
        ("lbfft", 1.0, 1.3558179483314004),
        ("N", 12.0, 12.0),
        ("mN", 12000.0, 12.0),
        ("kN", 0.012, 12.0),
        ("kgf", 2.0, 19.6133),
        ("lbf", 1.0, 4.4482216152605),
        ("A", 8.0, 8.0),
        ("mA", 8000.0, 8.0),
        ("degC", 28.0, 28.0),
        ("K", 301.15, 28.0),
        ("V", 1.5, 1.5),
        ("mV", 1500.0, 1.5),
        ("raw", 2048.0, 2048.0),
        ("lerobot", 2048.0, 2048.0),
    ],
)
def test_values_become_si(name: str, value: float, si: float) -> None:
    assert UNITS[name].to_si(np.array([value]))[0] == pytest.approx(si, rel=1e-14)


def test_every_unit_is_tested_above() -> None:
    marks = test_values_become_si.pytestmark  # type: ignore[attr-defined]
    assert {case[0] for case in marks[0].args[1]} == set(UNITS)


@pytest.mark.parametrize(
    ("text", "name"),
    [
        ("rad/s", "rad_s"),
        ("RAD_S", "rad_s"),
        ("deg/s", "deg_s"),
        ("°/s", "deg_s"),
        ("°", "deg"),
        ("°C", "degC"),
        ("N·m", "Nm"),
        ("N m", "Nm"),
        ("N*m", "Nm"),
        ("N_m", "Nm"),
        ("NM", "Nm"),
        ("μs", "us"),
        ("µs", "us"),
        (" ms ", "ms"),
        ("ma", "mA"),
        ("m/s", "m_s"),
        ("1", "raw"),
        ("1/min", "rpm"),
        ("degrees", "deg"),
        ("rad_per_s", "rad_s"),
        ("rad·s⁻¹", "rad_s"),
        ("rad s^-1", "rad_s"),
        ("m.s-1", "m_s"),
        ("min⁻¹", "rpm"),
        ("U/min", "rpm"),
        ("º", "deg"),
        ("turns", "rev"),
        ("N-m", "Nm"),
        ("N.mm", "Nmm"),
        ("kgf·cm", "kgfcm"),
        ("kg-cm", "kgfcm"),
        ("kgf*m", "kgfm"),
        ("oz-in", "ozfin"),
        ("ozf·in", "ozfin"),
        ("in-lb", "lbfin"),
        ("ft·lbf", "lbfft"),
        ("counts", "raw"),
        ("ticks", "raw"),
    ],
)
def test_spellings(text: str, name: str) -> None:
    assert find_unit(text) is UNITS[name]


@pytest.mark.parametrize(
    "text", ["", "furlong", "rad_rad", "Nms", "__", "m/s^2", "s⁻¹", "rad/s²", "-1"]
)
def test_what_is_no_unit(text: str) -> None:
    assert find_unit(text) is None


def test_unknown_unit_lists_the_known_ones() -> None:
    with pytest.raises(
        InputError, match=r"^run\.csv: unit is 'furlong': unknown unit; choose one of m, cm"
    ):
        unit_named("furlong", dimensions=("length",), place="run.csv")


@pytest.mark.parametrize(("text", "meant"), [("degs", "deg"), (" Rads", "rad")])
def test_a_plural_is_not_taken_for_a_velocity(text: str, meant: str) -> None:
    with pytest.raises(InputError, match=f"not a known unit; did you mean {meant}\\?"):
        unit_named(text, dimensions=("angle", "length"))
    assert unit_named(text, dimensions=("angular velocity",)).name == f"{meant}_s"


@pytest.mark.parametrize(
    ("text", "name"),
    [
        *((text, "ms") for text in ("msec", "Milliseconds", "Msec", "mS")),
        *(("usec", "us"), ("nsec", "ns"), ("sec", "s"), ("minutes", "min")),
    ],
)
def test_usual_spellings_of_times(text: str, name: str) -> None:
    assert find_unit(text) is UNITS[name]


def test_the_least_value_is_not_in_minutes() -> None:
    assert understood("position_min").meaning is None
    assert understood("time [min]").unit is UNITS["min"]


@pytest.mark.parametrize("text", ["MNm", "MN·m", "Mrad", "MRad", "Mrad/s", "MN m"])
def test_mega_is_not_milli(text: str) -> None:
    assert find_unit(text) is None
    if find_unit(f"m{text[1:]}"):
        with pytest.raises(InputError, match=f"the prefix M means mega; milli is m{text[1:]}"):
            unit_named(text)


@pytest.mark.parametrize(
    ("text", "name"), [("MNM", "mNm"), ("MRAD", "mrad"), ("MS", "ms"), ("mnm", "mNm")]
)
def test_capitals_alone_are_no_prefix(text: str, name: str) -> None:
    assert find_unit(text) is UNITS[name]


def test_names_by_dimension() -> None:
    assert unit_names(("current",)) == ("A", "mA")
    assert unit_names() == tuple(UNITS)


def test_milliseconds_are_the_decimal_second() -> None:
    """9 ms is the number that 0.009 s reads as, and not its neighbour."""
    stamps = np.arange(100_000.0)
    seconds = UNITS["ms"].to_si(stamps)
    assert all(second == float(f"{int(k)}e-3") for k, second in zip(stamps, seconds, strict=True))


@given(st.lists(st.floats(allow_nan=False), min_size=1))
def test_si_values_keep_their_bits(values: list[float]) -> None:
    array = np.array(values)
    for name in ("rad", "m", "s", "Nm", "N", "A", "degC", "raw"):
        assert UNITS[name].to_si(array).tobytes() == array.tobytes()


@pytest.mark.parametrize(("text", "name"), [("r_min", "rpm"), ("r/min", "rpm"), ("Mm", "mm")])
def test_more_spellings(text: str, name: str) -> None:
    """Of two letters the first may be a capital by habit."""
    unit = find_unit(text)
    assert unit is not None
    assert unit.name == name
