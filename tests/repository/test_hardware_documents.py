"""The pages on hardware have each key of a bench file and each limit, and the bus loads that the code computes."""

import re
import tomllib
from collections.abc import Iterator
from dataclasses import fields, replace
from pathlib import Path
from typing import Any

import pytest
from documentation.bench_file import bench_file_page

from jointid.hardware.bench import bench_file
from jointid.hardware.bench.bench import Bench
from jointid.hardware.bench.bus_options import BusOptions
from jointid.hardware.bench.emulation import Emulation
from jointid.hardware.bench.first_motion_options import FirstMotionOptions
from jointid.hardware.elmo.drive import ElmoDrive
from jointid.hardware.elmo.drive_type import ElmoType
from jointid.hardware.elmo.emulated_bench import ElmoEmulation
from jointid.hardware.elmo.options import ElmoOptions
from jointid.hardware.elmo.torque_source import AnalogInput, SensorScaling, SyncedConverter
from jointid.hardware.emulated.bus import EmulatedBus
from jointid.hardware.session.braking import BRAKED
from jointid.hardware.session.limits import SessionLimits
from jointid.hardware.session.options import SessionOptions
from jointid.hardware.session.realtime import RealTimeOptions

ROOT = Path(__file__).resolve().parents[2]
TEXT = (ROOT / "docs" / "hardware.md").read_text(encoding="utf-8")
EXAMPLE = ROOT / "examples" / "hardware" / "joint.toml"
# Given by another table, or tables themselves.
ELSEWHERE: dict[str, object] = {
    "torque": ElmoOptions,
    "bitrate": ElmoOptions,
    "resolution": SessionOptions,
}
ELSEWHERE |= {"drive": Emulation}
TABLES = {
    "[session]": (SessionOptions,),
    "[session.bus]": (BusOptions,),
    "[session.drive]": (ElmoOptions,),
    "[session.torque]": (SyncedConverter, AnalogInput, SensorScaling),
    "[session.limits]": (SessionLimits,),
    "[session.real_time]": (RealTimeOptions,),
    "[session.first_motion]": (FirstMotionOptions,),
    "[session.emulated]": (Emulation, ElmoEmulation),
}


def _row(start: str) -> list[str]:
    (found,) = (line for line in TEXT.splitlines() if line.startswith(f"| {start} |"))
    return [cell.strip() for cell in found.strip("|").split("|")]


def _section(table: str) -> str:
    """What the page of reference says of a table."""
    _, found, behind = bench_file_page().partition(f"\n## `{table}`\n")
    assert found, table
    return behind.partition("\n## ")[0]


@pytest.mark.parametrize("table", TABLES)
def test_each_key_of_a_bench_file_is_explained(table: str) -> None:
    section = _section(table)
    for kind in TABLES[table]:
        made: Any = kind
        for field in fields(made):
            if field.name in ("scaling", "truth", "sensors") or ELSEWHERE.get(field.name) is kind:
                continue
            assert re.search(rf"^`{field.name}` \(.+\)\n: \w", section, re.MULTILINE), field.name


def test_each_table_is_explained() -> None:
    for table in (*bench_file._TABLES, *ElmoType.tables):
        assert _section(f"[session.{table}]")
        assert f"\n| `[session.{table}]` |" in TEXT


def test_each_key_of_the_example_is_explained() -> None:
    for table, key in _keys(tomllib.loads(EXAMPLE.read_text(encoding="utf-8"))["session"]):
        section = _section(f"[{table}]")
        if table != "session.emulated.truth":  # parameters, by name
            assert f"`{key}`" in section, f"{table} {key}"


def _keys(table: dict[str, Any], name: str = "session") -> Iterator[tuple[str, str]]:
    for key, value in table.items():
        if isinstance(value, dict):
            yield from _keys(value, f"{name}.{key}")
        else:
            yield name, key


def test_each_limit_has_a_row_that_says_whether_it_brakes() -> None:
    text = (ROOT / "docs" / "safety.md").read_text(encoding="utf-8")
    table = text.partition("\n## Stops\n")[2].partition("\n## ")[0]
    rows = {row.split("`")[1]: row for row in table.splitlines() if row.startswith("| `")}
    assert {field.name for field in fields(SessionLimits)} <= rows.keys()
    assert {name for name, row in rows.items() if "*b* |" in row} == BRAKED


@pytest.mark.parametrize(
    ("name", "source"),
    [
        ("no torque sensor", None),
        ("converter", SyncedConverter()),
        ("AN every 4 cycles", AnalogInput(every=4)),
        ("AN every cycle", AnalogInput(every=1)),
    ],
)
def test_bus_loads_are_those_that_a_session_computes(
    name: str, source: SyncedConverter | AnalogInput | None
) -> None:
    bench = Bench.load(EXAMPLE)
    cycles = ((500e3, 2e-3), (1e6, 2e-3), (1e6, 1e-3), (500e3, 1e-3))
    for printed, (bitrate, period) in zip(_row(name)[1:], cycles, strict=True):
        options = replace(bench.drive, torque=source, bitrate=bitrate)
        with EmulatedBus() as bus:
            load = ElmoDrive(bus, bench.joint, options).bus_load(period)
        assert printed == f"{100.0 * load:.0f} %"
