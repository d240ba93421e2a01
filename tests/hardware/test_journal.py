"""The emulated drive tells what happens to it; an emulator that rests does everything at its time all the same."""

from __future__ import annotations

import io
import itertools
import json
import threading
import uuid
from pathlib import Path
from typing import Any

import can
import pytest
from session_bench import devices

from jointid.cli import main
from jointid.hardware.bench import opened_drive
from jointid.hardware.can import canopen_frames as canopen
from jointid.hardware.emulated.bus import EmulatedBus
from jointid.hardware.emulated.device import DeviceBus
from jointid.hardware.emulated.journal import Journal
from jointid.hardware.emulated.thread import EmulatorThread


def test_a_line_for_each_change_and_none_without_one() -> None:
    elmo, _ = devices()
    told = io.StringIO()
    journal = Journal(elmo, told)
    with EmulatedBus(elmo, journal) as bus:
        for payload in (canopen.network(canopen.START, 127), canopen.network(canopen.STOP, 127)):
            journal(bus.now())
            journal(bus.now())
            bus.send(can.Message(arbitration_id=0, data=payload, is_extended_id=False))
            bus.sleep_until(bus.now() + 0.01)
        journal(bus.now())
    lines: list[dict[str, Any]] = [json.loads(line) for line in told.getvalue().splitlines()]
    assert [line["state"] for line in lines] == ["pre-operational", "operational", "stopped"]
    assert [line["time"] for line in lines] == [0.0, 0.01, 0.02]
    assert "000" not in lines[0]["heard"]
    assert 0.01 < lines[2]["heard"]["000"] < 0.011
    assert {line["motor_on"] for line in lines} == {False}


class Periodic:
    """Does something every millisecond."""

    def __init__(self) -> None:
        self.times: list[float] = []
        self.done = threading.Event()

    def attach(self, bus: DeviceBus) -> None:
        self.bus = bus
        self.act()

    def receive(self, message: can.Message) -> None:
        del message

    def act(self) -> None:
        self.times.append(self.bus.now())
        if len(self.times) == 50:
            self.done.set()
        self.bus.at(self.times[-1] + 1e-3, self.act)


@pytest.mark.parametrize("rest", [0.0, 0.01])
def test_what_is_due_happens_at_its_time(rest: float) -> None:
    device, seen = Periodic(), list[float]()
    with (
        can.Bus(uuid.uuid4().hex, interface="virtual") as bus,
        EmulatorThread(bus, device, rest=rest, watch=seen.append),
    ):
        assert device.done.wait(30.0)
    times = device.times[:50]
    assert [b - a for a, b in itertools.pairwise(times)] == pytest.approx([1e-3] * 49)
    assert seen[:49] == times[1:50]


JOINT = Path(__file__).resolve().parents[1] / "canlab" / "bench.toml"


@pytest.mark.parametrize(
    ("options", "complaint"),
    [
        (("--rest", "0.5"), "--rest"),
        (("--json",), "reports no events"),
    ],
)
def test_bad_input_of_emulate_is_refused(
    options: tuple[str, ...],
    complaint: str,
    capsys: pytest.CaptureFixture[str],
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(opened_drive, "emulated_devices", lambda *_: (object(),))
    assert main(["emulate", str(JOINT), *options]) == 2
    assert complaint in capsys.readouterr().err
