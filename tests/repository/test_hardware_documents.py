"""docs/hardware.md names what a bench file takes, and its tables hold what the code computes."""

from dataclasses import fields, replace
from pathlib import Path
from typing import Any

import pytest

from jointid.hardware.bench.bench import Bench
from jointid.hardware.bench.bus_options import BusOptions
from jointid.hardware.bench.emulation import Emulation
from jointid.hardware.bench.first_motion_options import FirstMotionOptions
from jointid.hardware.elmo.drive import ElmoDrive
from jointid.hardware.elmo.emulated_bench import ElmoEmulation
from jointid.hardware.elmo.options import ElmoOptions
from jointid.hardware.elmo.torque_source import AnalogInput, SensorScaling, SyncedConverter
from jointid.hardware.emulated.bus import EmulatedBus
from jointid.hardware.session.limits import SessionLimits
from jointid.hardware.session.options import SessionOptions
from jointid.hardware.session.realtime import RealTimeOptions

ROOT = Path(__file__).resolve().parents[2]
TEXT = (ROOT / "docs" / "hardware.md").read_text(encoding="utf-8")
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


@pytest.mark.parametrize("table", TABLES)
def test_each_key_of_a_bench_file_is_explained(table: str) -> None:
    keys = _row(f"`{table}`")[1]
    for kind in TABLES[table]:
        made: Any = kind
        for field in fields(made):
            if field.name == "scaling" or ELSEWHERE.get(field.name) is kind:
                continue
            assert f"`{field.name}`" in keys, f"{table} {field.name}"


def test_each_limit_has_a_row_that_says_what_stops() -> None:
    text = (ROOT / "docs" / "hardware_limits.md").read_text(encoding="utf-8")
    for field in fields(SessionLimits):
        assert f"| `{field.name}` |" in text


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
    bench = Bench.load(ROOT / "examples" / "hardware" / "joint.toml")
    cycles = ((500e3, 2e-3), (1e6, 2e-3), (1e6, 1e-3), (500e3, 1e-3))
    for printed, (bitrate, period) in zip(_row(name)[1:], cycles, strict=True):
        options = replace(bench.drive, torque=source, bitrate=bitrate)
        with EmulatedBus() as bus:
            load = ElmoDrive(bus, bench.joint, options).bus_load(period)
        assert printed == f"{100.0 * load:.0f} %"
