"""What is asked of the operating system is granted or reported, and restored; clocks keep absolute deadlines."""

import ctypes
import gc
import os
import sys
import threading
from typing import Any

import pytest
from session_bench import devices, session

from jointid.base.errors import InputError
from jointid.hardware.emulated.bus import EmulatedBus
from jointid.hardware.session import realtime
from jointid.hardware.session.clock import MonotonicClock
from jointid.hardware.session.realtime import RealTime, RealTimeOptions

linux = pytest.mark.skipif(not sys.platform.startswith("linux"), reason="only on Linux")


def state() -> tuple[Any, ...]:
    """All that could have been changed."""
    return (
        os.sched_getscheduler(0) & ~os.SCHED_RESET_ON_FORK,
        os.sched_getparam(0).sched_priority,
        os.sched_getaffinity(0),
        ctypes.CDLL(None).prctl(30, 0, 0, 0, 0),
        realtime._locked_memory(),
        gc.isenabled(),
        gc.get_freeze_count(),
    )


@linux
def test_all_is_granted_or_reported_and_restored() -> None:
    before = state()
    options = RealTimeOptions(
        priority=1,
        lock_memory=True,
        cpus=(min(os.sched_getaffinity(0)),),
        timer_slack=1e-6,
        freeze_garbage=True,
    )
    with RealTime(options) as asked:
        wording = {note.partition(":")[0] for note in asked.notes}
        priority, locked = os.sched_getparam(0).sched_priority, realtime._locked_memory()
        assert (priority == 1) != ("priority" in wording)
        assert (locked > 0) != ("lock_memory" in wording)
        assert os.sched_getaffinity(0) == set(options.cpus or ())
        # With a real-time priority newer kernels have no slack at all.
        assert ctypes.CDLL(None).prctl(30, 0, 0, 0, 0) in (0, 1000)
        assert not gc.isenabled()
        assert gc.get_freeze_count() > 0
        assert wording <= {"priority", "lock_memory"}
    assert state() == before


@linux
def test_threads_begun_meanwhile_do_not_inherit_the_priority() -> None:
    with RealTime(RealTimeOptions(priority=1)) as asked:
        if asked.notes:
            pytest.skip(asked.notes[0])
        found: list[int] = []
        thread = threading.Thread(target=lambda: found.append(os.sched_getscheduler(0)))
        thread.start()
        thread.join()
    assert found == [os.SCHED_OTHER]


@linux
def test_a_refusal_is_reported_and_the_rest_granted(monkeypatch: pytest.MonkeyPatch) -> None:
    def refuse(*_: object) -> None:
        raise PermissionError(1, "Operation not permitted")

    before = state()
    monkeypatch.setattr(os, "sched_setscheduler", refuse)
    monkeypatch.setattr(realtime, "_may_lock", lambda: False)
    import resource

    monkeypatch.setattr(resource, "getrlimit", lambda _: (65536, 65536))
    options = RealTimeOptions(
        priority=80, lock_memory=True, cpus=(100_000,), timer_slack=1e-6, freeze_garbage=True
    )
    with RealTime(options) as asked:
        assert not gc.isenabled()
        assert ctypes.CDLL(None).prctl(30, 0, 0, 0, 0) == 1000
    priority, memory, cpus = asked.notes
    assert priority.startswith("priority: not granted (Operation not permitted); a line `@realtime")
    assert memory.startswith("lock_memory: not granted (the limit is 64 kB); a line `@realtime")
    assert cpus.startswith("cpus: not granted (Invalid argument); this machine has processors 0")
    assert state() == before


def test_garbage_that_was_not_searched_for_before_is_not_afterwards() -> None:
    gc.disable()
    try:
        with RealTime(RealTimeOptions(freeze_garbage=True)):
            assert not gc.isenabled()
        assert not gc.isenabled()
    finally:
        gc.enable()


def test_elsewhere_than_on_linux_it_says_so(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sys, "platform", "win32")
    options = RealTimeOptions(priority=10, lock_memory=True, cpus=(0,), timer_slack=1e-6)
    with RealTime(options) as asked:
        assert asked.notes == [
            f"{name}: available only on Linux, but this system is win32"
            for name in ("priority", "lock_memory", "cpus", "timer_slack")
        ]


@pytest.mark.parametrize(
    ("wrong", "wording"),
    [
        ({"priority": 0}, "priority is 0: 1 to 99 is expected"),
        ({"priority": 100}, "priority is 100"),
        ({"cpus": ()}, r"cpus is \(\): numbers of processors"),
        ({"cpus": (0, -1)}, "cpus is"),
        ({"timer_slack": 0.0}, "timer_slack is 0.0: 1e-9 to 1 s"),
        ({"timer_slack": float("nan")}, "timer_slack is nan"),
    ],
)
def test_senseless_options_are_refused(wrong: dict[str, Any], wording: str) -> None:
    with pytest.raises(InputError, match=wording):
        RealTimeOptions(**wrong)


@linux
def test_a_sessions_recording_tells_what_was_not_granted() -> None:
    before = state()
    options = RealTimeOptions(cpus=(100_000,), freeze_garbage=True)
    seen: list[bool] = []
    bus = EmulatedBus(*devices())
    recording = session(
        bus, 1.0, real_time=options, observer=lambda *_: seen.append(gc.isenabled())
    ).run()
    bus.shutdown()
    assert recording is not None
    (note,) = recording.metadata["real_time"]
    assert note.startswith("cpus: not granted")
    assert set(seen) == {False}
    assert state() == before


class Machine:
    """A clock whose sleeps end late and whose looks at the time take some."""

    def __init__(self, overshoot: float) -> None:
        self.time, self.overshoot = 100.0, overshoot
        self.slept: list[float] = []

    def now(self) -> float:
        self.time += 1e-6
        return self.time

    def sleep(self, duration: float) -> None:
        self.slept.append(duration)
        self.time += max(0.0, duration + self.overshoot)


def test_late_sleeps_do_not_add_up() -> None:
    machine = Machine(overshoot=1e-4)
    clock = MonotonicClock(now=machine.now, sleep=machine.sleep)
    begin = clock.now()
    for k in range(1, 1001):
        clock.sleep_until(begin + k * 2e-3)
        assert 0.0 <= machine.time - (begin + k * 2e-3) < 1.1e-4


def test_a_sleep_that_ends_early_is_slept_on() -> None:
    machine = Machine(overshoot=-3e-4)
    clock = MonotonicClock(now=machine.now, sleep=machine.sleep)
    deadline = machine.time + 2e-3
    clock.sleep_until(deadline)
    assert machine.time >= deadline
    assert len(machine.slept) > 1


def test_the_last_bit_is_waited_for_busily() -> None:
    machine = Machine(overshoot=1e-4)
    clock = MonotonicClock(spin=3e-4, now=machine.now, sleep=machine.sleep)
    deadline = machine.time + 2e-3
    clock.sleep_until(deadline)
    assert 0.0 <= machine.time - deadline < 3e-6
    assert sum(machine.slept) < 1.7e-3
    machine.slept.clear()
    clock.sleep_until(deadline)  # it has passed
    assert not machine.slept


def test_a_senseless_spin_is_refused() -> None:
    with pytest.raises(InputError, match="spin is -1"):
        MonotonicClock(spin=-1.0)
