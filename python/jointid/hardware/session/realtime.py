"""Real-time settings of the operating system: requested, and restored afterwards."""

from __future__ import annotations

import ctypes
import gc
import math
import os
import sys
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Self

from jointid.base.errors import InputError

_LOCK_CURRENT, _LOCK_FUTURE = 1, 2  # MCL_*
_SET_TIMER_SLACK, _GET_TIMER_SLACK = 29, 30  # PR_*
_HIGHEST_PRIORITY = 99


@dataclass(frozen=True, slots=True, kw_only=True)
class RealTimeOptions:
    """Real-time settings of the operating system during a session; none by default.

    Attributes
    ----------
    priority : int, optional
        SCHED_FIFO priority, 1 to 99; usually 70 to 80. Needs CAP_SYS_NICE or `ulimit -r`.
    lock_memory : bool
        Whether to keep all memory out of swap. Needs CAP_IPC_LOCK or `ulimit -l unlimited`.
    cpus : tuple of int, optional
        Numbers of the processors on which the control loop may run.
    timer_slack : float, optional
        Largest delay at the end of a sleep [s]. Default: the system's value, 50e-6 on Linux.
    freeze_garbage : bool
        Whether to stop garbage collection during the session.
    """

    priority: int | None = None
    lock_memory: bool = False
    cpus: tuple[int, ...] | None = None
    timer_slack: float | None = None
    freeze_garbage: bool = False

    def __post_init__(self) -> None:
        if self.priority is not None and not 1 <= self.priority <= _HIGHEST_PRIORITY:
            raise InputError(
                f"1 to {_HIGHEST_PRIORITY} is expected", argument="priority", value=self.priority
            )
        if self.cpus is not None and (not self.cpus or min(self.cpus) < 0):
            raise InputError(
                "numbers of processors, 0 or more, are expected", argument="cpus", value=self.cpus
            )
        slack = self.timer_slack
        if slack is not None and not (math.isfinite(slack) and 1e-9 <= slack <= 1.0):
            raise InputError("1e-9 to 1 s is expected", argument="timer_slack", value=slack)


class RealTime:
    """Context that requests the options' settings and restores everything afterwards, for one thread.

    A setting that is not granted is no error: the session runs, and `notes` lists it. Threads that start in this
    context do not inherit the priority. They do inherit `cpus`, so start a writer before.

    Parameters
    ----------
    options : RealTimeOptions, optional
        Default: no settings.

    Attributes
    ----------
    notes : list of str
        Settings that were not granted, and the reasons.
    """

    def __init__(self, options: RealTimeOptions | None = None) -> None:
        self.options = options if options is not None else RealTimeOptions()
        self.notes: list[str] = []
        self._undo: list[Callable[[], object]] = []

    def __enter__(self) -> Self:
        self.notes.clear()
        options = self.options
        for name, asked, step in (
            ("priority", options.priority is not None, self._raise_priority),
            ("lock_memory", options.lock_memory, self._lock_memory),
            ("cpus", options.cpus is not None, self._bind),
            ("timer_slack", options.timer_slack is not None, self._sharpen_timer),
        ):
            if not asked:
                continue
            if not sys.platform.startswith("linux"):
                self.notes.append(
                    f"{name}: available only on Linux, but this system is {sys.platform}"
                )
                continue
            try:
                step()
            except OSError as error:
                self.notes.append(f"{name}: {_hint(name, error)}")
        if options.freeze_garbage:
            self._freeze_garbage()
        return self

    def __exit__(self, *_: object) -> None:
        while self._undo:
            try:
                self._undo.pop()()
            except OSError as error:
                self.notes.append(f"not restored: {error}")

    def _raise_priority(self) -> None:
        assert self.options.priority is not None
        policy, parameter = os.sched_getscheduler(0), os.sched_getparam(0)
        os.sched_setscheduler(
            0,
            os.SCHED_FIFO | os.SCHED_RESET_ON_FORK,
            os.sched_param(self.options.priority),
        )

        def restore() -> None:
            try:
                os.sched_setscheduler(0, policy, parameter)
            except PermissionError:  # a process that may set the flag may still not clear it
                os.sched_setscheduler(0, policy | os.SCHED_RESET_ON_FORK, parameter)

        self._undo.append(restore)

    def _lock_memory(self) -> None:
        import resource  # not on every platform

        # With a limit, later requests for memory would be refused, and the session would fail.
        allowed = resource.getrlimit(resource.RLIMIT_MEMLOCK)[0]
        if allowed != resource.RLIM_INFINITY and not _may_lock():
            raise PermissionError(0, f"the limit is {allowed // 1024} kB")
        before = _locked_memory()
        _checked(_libc().mlockall(_LOCK_CURRENT | _LOCK_FUTURE))
        if not before:
            self._undo.append(lambda: _checked(_libc().munlockall()))

    def _bind(self) -> None:
        assert self.options.cpus is not None
        before = os.sched_getaffinity(0)
        os.sched_setaffinity(0, self.options.cpus)
        self._undo.append(lambda: os.sched_setaffinity(0, before))

    def _sharpen_timer(self) -> None:
        assert self.options.timer_slack is not None
        before = _control(_GET_TIMER_SLACK, 0)
        _control(_SET_TIMER_SLACK, round(1e9 * self.options.timer_slack))
        self._undo.append(lambda: _control(_SET_TIMER_SLACK, before))

    def _freeze_garbage(self) -> None:
        enabled, frozen = gc.isenabled(), gc.get_freeze_count()
        gc.collect()
        gc.freeze()
        gc.disable()
        if enabled:
            self._undo.append(gc.enable)
        if not frozen:
            self._undo.append(gc.unfreeze)


def _libc() -> Any:
    return ctypes.CDLL(None, use_errno=True)


def _checked(result: int) -> int:
    if result < 0:
        code = ctypes.get_errno()
        raise OSError(code, os.strerror(code))
    return result


def _control(option: int, value: int) -> int:
    zero = ctypes.c_ulong(0)
    return _checked(_libc().prctl(option, ctypes.c_ulong(value), zero, zero, zero))


def _status(name: str) -> str:
    for line in Path("/proc/self/status").read_text().splitlines():
        if line.startswith(name + ":"):
            return line.split()[1]
    return "0"


def _locked_memory() -> int:
    """Return the locked memory of this process [kB]."""
    return int(_status("VmLck"))


def _may_lock() -> bool:
    lock_capability = 14  # CAP_IPC_LOCK
    return bool(int(_status("CapEff"), 16) >> lock_capability & 1)


def _hint(name: str, error: OSError) -> str:
    ways = {
        "priority": "a line `@realtime - rtprio 99` in /etc/security/limits.conf permits it",
        "lock_memory": "a line `@realtime - memlock unlimited` in /etc/security/limits.conf permits it",
        "cpus": f"this machine has processors {_spans(os.cpu_count() or 1)}",
        "timer_slack": "the kernel refused",
    }
    return f"not granted ({error.strerror or error}); {ways[name]}"


def _spans(count: int) -> str:
    return "0" if count == 1 else f"0 to {count - 1}"
