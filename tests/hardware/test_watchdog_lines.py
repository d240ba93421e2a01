"""Every line that arms the drive's watchdog is needed: without it the drive is not as safe, and this shows.

The lines are removed one after the other, by the program; what then happens must differ from what should.
"""

from __future__ import annotations

import ast
import copy
import inspect
import signal
import sys
import textwrap
from collections.abc import Callable, Iterator
from functools import partial
from typing import Any

import pytest
from _pytest.outcomes import Failed
from session_bench import JOINT, PERIOD, devices

from jointid.hardware import DriveFaultError
from jointid.hardware.elmo import setup
from jointid.hardware.elmo.drive import ElmoDrive
from jointid.hardware.elmo.emulated_drive import EmulatedElmo
from jointid.hardware.elmo.options import ElmoOptions
from jointid.hardware.elmo.switching import MotorSwitch
from jointid.hardware.emulated.bus import EmulatedBus

OPTIONS = ElmoOptions(listen=0.0)
AWAITED = OPTIONS.heartbeat
LOOK = 1.5e-3  # [s] between two looks of the drive's, and for the last heartbeat to arrive
OBJECTS = (0x1016, 0x1017, 0x6007, 0x1029, 0x2F21)


class KilledError(BaseException):
    """The host's program is gone."""


class Bench:
    """An emulated drive, which arms nothing by itself, and a host's drive."""

    def __init__(self) -> None:
        self.elmo, converter = devices()
        self.bus = EmulatedBus(self.elmo, converter)
        self.drive = ElmoDrive(self.bus, JOINT, OPTIONS)

    def run(self, cycles: int) -> None:
        """Control cycles, with a torque that turns the joint."""
        begin = self.bus.now()
        for k in range(cycles):
            self.bus.sleep_until(begin + (k + 1) * PERIOD)
            self.drive.read(0.75 * PERIOD)
            self.drive.command(60.0)

    def off_after_death(self) -> None:
        """From now on the host does nothing: on until the time is over, then off at once."""
        gone = self.bus.now()
        assert self.elmo.motor_on
        self.bus.sleep_until(gone + AWAITED - 5e-3)
        assert self.elmo.motor_on
        self.bus.sleep_until(gone + AWAITED + LOOK)
        assert not self.elmo.motor_on
        assert self.elmo.current == 0.0


# What must hold.


def host_dies_in_the_run() -> None:
    bench = Bench()
    bench.drive.connect(PERIOD)
    bench.drive.enable()
    bench.run(60)
    assert bench.elmo.torque_commands
    bench.off_after_death()


def host_that_comes_back_is_told() -> None:
    bench = Bench()
    bench.drive.connect(PERIOD)
    bench.drive.enable()
    bench.run(5)
    bench.bus.sleep_until(bench.bus.now() + 1.2 * AWAITED)
    with pytest.raises(DriveFaultError) as found:
        bench.drive.read(PERIOD)
    assert found.value.kind == "host_heartbeat_lost"
    end = bench.drive.disable()
    assert end.motor_off
    assert end.failure == "heartbeat lost"
    assert bench.elmo.state == "operational"


def host_dies_before_its_first_cycle() -> None:
    bench = Bench()
    bench.drive.connect(PERIOD)
    slow(bench.elmo, 0.012)
    bench.drive.enable()
    assert [current for _, current in bench.elmo.torque_commands] == [0.0]
    bench.off_after_death()


def host_dies_as_the_motor_comes_on() -> None:
    bench = Bench()
    bench.drive.connect(PERIOD)

    def kill(_when: float, _identifier: int, payload: bytes, _sent: bool) -> None:
        if payload[:2] == b"MO":
            raise KilledError

    bench.drive.tap = kill
    with pytest.raises(KilledError):
        bench.drive.enable()
    bench.bus.sleep_until(bench.bus.now() + 2e-3)
    assert bench.elmo.motor_on
    bench.bus.sleep_until(bench.bus.now() + AWAITED + LOOK)
    assert not bench.elmo.motor_on


def motor_takes_its_time() -> None:
    bench = Bench()
    bench.drive.connect(PERIOD)
    slow(bench.elmo, 0.12)
    status, asked = bench.elmo.status, list[float]()

    def late() -> int:
        asked.append(bench.bus.now())
        return status() & ~0x10 if len(asked) < 20 else status()

    bench.elmo.status = late  # type: ignore[method-assign]
    bench.drive.enable()
    assert bench.elmo.motor_on
    assert bench.elmo.failure == 0
    assert len(asked) == 20


def slow(elmo: EmulatedElmo, delay: float) -> None:
    """MO=1 and TC=0 are answered late [s]."""
    reply = elmo.reply

    def later(payload: bytes) -> None:
        if payload[:2] in (b"MO", b"TC"):
            elmo.bus.at(elmo.bus.now() + delay, lambda: reply(payload))
        else:
            reply(payload)

    elmo.reply = later  # type: ignore[method-assign]


def the_drive_beats() -> None:
    bench = Bench()
    heard: list[float] = []
    bench.drive.tap = lambda when, identifier, payload, _sent: (
        heard.append(when) if (identifier, payload) == (0x77F, b"\x05") else None
    )
    bench.drive.connect(PERIOD)
    bench.drive.enable()
    bench.run(60)
    assert len(heard) >= 5
    bench.elmo.silent_heartbeat = True
    with pytest.raises(DriveFaultError) as found:
        bench.run(60)
    assert found.value.kind == "heartbeat_lost"


def a_drive_that_does_not_take_an_object_is_refused() -> None:
    for index in OBJECTS:
        bench = Bench()
        write = bench.elmo.objects.write

        def some(
            at: int, subindex: int, given: bytes, index: int = index, write: Any = write
        ) -> None:
            if at != index:
                write(at, subindex, given)

        bench.elmo.objects.write = some  # type: ignore[method-assign,assignment]
        with pytest.raises(DriveFaultError, match=f"is not armed: object {index:04X}h"):
            bench.drive.connect(PERIOD)


def a_period_that_is_too_long_for_the_heartbeat_is_refused() -> None:
    with pytest.raises(DriveFaultError, match="is too long: each cycle sends the heartbeat"):
        Bench().drive.connect(0.4 * AWAITED)


PROMISES: tuple[Callable[[], None], ...] = (
    host_dies_in_the_run,
    host_that_comes_back_is_told,
    host_dies_before_its_first_cycle,
    host_dies_as_the_motor_comes_on,
    motor_takes_its_time,
    the_drive_beats,
    a_drive_that_does_not_take_an_object_is_refused,
    a_period_that_is_too_long_for_the_heartbeat_is_refused,
)


@pytest.mark.parametrize("promise", PROMISES, ids=lambda promise: promise.__name__)
def test_the_drive_is_watched(promise: Callable[[], None]) -> None:
    promise()


# Lines removed.

# Where the lines are, and which of them have nothing to do with the watchdog.
ARMING: tuple[tuple[Any, str, tuple[str, ...]], ...] = (
    (setup, "arm_watchdogs", ()),
    (setup, "watchdog_objects", ()),
    (MotorSwitch, "beat", ()),
    (MotorSwitch, "on", ("seen_off", "echoes", "does not switch on", "> end", "sleep_until")),
    (MotorSwitch, "_beat_in_time", ()),
    (ElmoDrive, "command", ("echoes", "return")),
    (ElmoDrive, "enable", ()),
)
# Of `connect` only these: the others bring the drive up.
CONNECTING = ("CYCLES", "arm_watchdogs")


def removals(tree: ast.AST) -> Iterator[tuple[str, Callable[[], ast.AST]]]:
    """Yield each statement, and each entry of a call or a tuple; and what makes the tree without it."""
    for place, node in enumerate(ast.walk(tree)):
        for name in ("body", "orelse", "args", "elts", "keywords"):
            entries = getattr(node, name, None)
            if not isinstance(entries, list):
                continue
            for number, entry in enumerate(entries):
                worth = isinstance(entry, ast.stmt) and not is_documentation(entry)
                worth = worth or (
                    name in ("args", "elts") and isinstance(entry, ast.Tuple | ast.Call)
                )
                worth = worth or (name == "keywords" and entry.arg == "meanwhile")
                if not worth:
                    continue
                text = ast.unparse(entry).splitlines()[0]
                yield text, partial(without, tree, place, name, number)


def without(tree: ast.AST, place: int, name: str, number: int) -> ast.AST:
    """The tree without an entry of a node's."""
    changed = copy.deepcopy(tree)
    inner = list(ast.walk(changed))[place]
    left = [other for k, other in enumerate(getattr(inner, name)) if k != number]
    setattr(inner, name, left or [ast.Pass()] if name == "body" else left)
    return ast.fix_missing_locations(changed)


def is_documentation(entry: ast.stmt) -> bool:
    return isinstance(entry, ast.Expr) and isinstance(entry.value, ast.Constant)


def lines() -> Iterator[Any]:
    """Yield each removal: whose member is replaced, by what, and the text that is missing then."""
    for owner, name, left_out in (*ARMING, (ElmoDrive, "connect", ())):
        function = getattr(owner, name)
        module = sys.modules[function.__module__]
        tree = ast.parse(textwrap.dedent(inspect.getsource(function)))
        for text, changed in removals(tree.body[0]):
            if name == "connect" and not any(word in text for word in CONNECTING):
                continue
            if any(word in text for word in left_out):
                continue
            yield pytest.param(owner, name, module, changed, id=f"{name}: {text}")


def broken_promise() -> str | None:
    """Name the first promise that is not held; an endless loop holds none."""

    def end(*_: object) -> None:
        raise TimeoutError

    before = signal.signal(signal.SIGVTALRM, end)
    try:
        for promise in PROMISES:
            signal.setitimer(signal.ITIMER_VIRTUAL, 2.0)  # [s] of computing; each takes 0.1 s
            try:
                promise()
            except (Exception, KilledError, Failed):
                return promise.__name__
    finally:
        signal.setitimer(signal.ITIMER_VIRTUAL, 0.0)
        signal.signal(signal.SIGVTALRM, before)
    return None


def test_with_all_lines_no_promise_is_broken() -> None:
    assert broken_promise() is None


@pytest.mark.parametrize(("owner", "name", "module", "changed"), [*lines()])
def test_each_line_of_the_arming_is_needed(
    owner: Any, name: str, module: Any, changed: Any, monkeypatch: pytest.MonkeyPatch
) -> None:
    names = dict(vars(module))
    body = ast.Module(body=[changed()], type_ignores=[])
    exec(compile(body, f"{name} without a line", "exec"), names)
    monkeypatch.setattr(owner, name, names[name])
    assert broken_promise() is not None


def test_all_lines_of_the_arming_are_tried() -> None:
    tried = [str(each.id) for each in lines()]
    assert sum(text.startswith("arm_watchdogs: (") for text in tried) == len(OBJECTS)
    assert sum(text.startswith("watchdog_objects: Reported(") for text in tried) == len(OBJECTS)
    assert any(text.startswith("on: self.beat()") for text in tried)
    assert any("self._switch.beat()" in text for text in tried)
