"""Trials of mutants one by one in forked processes, each with the tests that should notice it."""

from __future__ import annotations

import datetime
import importlib
import os
import re
import shutil
import signal
import subprocess
import sys
import time
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path

from mutants.catalogue import REPOSITORY, Mutant, MutantError

# Imported once, before the forks: modules that tests use and no mutant changes.
_BEFORE = ["numpy", "pytest", "pandas", "scipy.optimize", "scipy.stats", "tomlkit", "can"]
_PATIENCE = 8.0  # times the duration without a mutant
_LEAST = 60.0  # [s]: the shortest limit on the time of a trial
_NO_TEST, _HIDDEN = 5, 70
_FIRST = re.compile(r"^(?:FAILED|ERROR) ([^\s]+)|^FAILED +[\d.]+ s +(.*)$", re.MULTILINE)
_POLL = 0.02  # [s]


@dataclass(frozen=True, kw_only=True)
class Verdict:
    """Outcome of one mutant.

    Attributes
    ----------
    mutant : Mutant
    killed : bool
        Whether a check or a test failed, or did not end.
    by : str
        The first test that failed.
    seconds : float
        Duration of the trial [s].
    date : str
        Day of the trial.
    """

    mutant: Mutant
    killed: bool
    by: str
    seconds: float
    date: str


@dataclass(frozen=True, kw_only=True)
class _Task:
    mutant: Mutant | None
    checks: tuple[str, ...]
    tests: tuple[str, ...]
    limit: float


@dataclass(kw_only=True)
class _Running:
    task: _Task
    child: int
    package: Path
    log: Path
    began: float


class Trials:
    """Workers with one package each, in which one file at a time is changed.

    Parameters
    ----------
    packages : sequence of Path
        One per parallel process; each holds `jointid`.
    core_check : Path or None
        The program of the core's checks, with all mutants in it.
    logs : Path
        Folder for the output of each trial.
    quick : bool, default False
        Skip tests that are marked slow.
    """

    def __init__(
        self, packages: Sequence[Path], core_check: Path | None, logs: Path, quick: bool = False
    ) -> None:
        self._free = list(packages)
        self._core_check = core_check
        self._quick = quick
        self._logs = logs
        logs.mkdir(parents=True, exist_ok=True)
        os.environ |= {"OPENBLAS_NUM_THREADS": "1", "HYPOTHESIS_STORAGE_DIRECTORY": str(logs)}
        for name in _BEFORE:
            importlib.import_module(name)

    def all_of(
        self,
        mutants: Sequence[Mutant],
        told: Callable[[str], object] = print,
        ended: Callable[[Verdict], object] = lambda _: None,
    ) -> list[Verdict]:
        """Try the unchanged program, then every mutant; `ended` gets each verdict at once.

        Raises
        ------
        MutantError
            If a test fails without a mutant, or none is found.
        """
        alone = {
            (kind, each): 0.0
            for mutant in mutants
            for kind, names in (("check", mutant.checks), ("test", mutant.tests))
            for each in names
        }
        told(f"{len(alone)} groups of tests without a mutant")
        unchanged = [
            _Task(
                mutant=None,
                checks=(name,) if kind == "check" else (),
                tests=(name,) if kind == "test" else (),
                limit=3600.0,
            )
            for kind, name in alone
        ]
        wrong = []
        for task, code, seconds, log in self._each(unchanged):
            for kind, names in (("check", task.checks), ("test", task.tests)):
                alone |= {(kind, name): seconds for name in names}
            if code and not self._is_without_test(code):
                wrong.append(f"{task.checks or task.tests}: {_said(code, log)}; {log}")
        if wrong:
            raise MutantError("\n".join(("without a mutant, this does not pass:", *wrong)))
        tasks = [
            _Task(
                mutant=each,
                checks=each.checks,
                tests=each.tests,
                limit=_LEAST
                + _PATIENCE
                * (
                    sum(alone["check", name] for name in each.checks)
                    + sum(alone["test", name] for name in each.tests)
                ),
            )
            for each in mutants
        ]
        verdicts = []
        for task, code, seconds, log in self._each(tasks):
            assert task.mutant is not None
            if self._is_without_test(code):
                code = 0
            if code in (_NO_TEST, _HIDDEN):
                raise MutantError(f"{task.mutant}: {_said(code, log)}")
            by = _said(code, log) if code else ""
            today = datetime.date.today().isoformat()
            verdicts.append(
                Verdict(mutant=task.mutant, killed=bool(code), by=by, seconds=seconds, date=today)
            )
            ended(verdicts[-1])
            state = "killed" if code else "justified" if task.mutant.justified else "SURVIVED"
            told(f"{len(verdicts):4} of {len(tasks)} {state:9} {seconds:6.1f} s  {task.mutant}")
        return sorted(verdicts, key=lambda each: each.mutant.number)

    def _is_without_test(self, code: int) -> bool:
        return self._quick and code == _NO_TEST

    def _each(self, tasks: Iterable[_Task]) -> Iterator[tuple[_Task, int, float, Path]]:
        """Yield each task's exit code, seconds and log as it ends; 0 is passed, negative a signal."""
        waiting, running = list(tasks)[::-1], dict[int, _Running]()
        try:
            while waiting or running:
                while waiting and self._free:
                    begun = self._begin(waiting.pop(), self._free.pop())
                    running[begun.child] = begun
                child, status = os.waitpid(-1, os.WNOHANG)
                if child in running:
                    ended = running.pop(child)
                    yield self._end(ended, os.waitstatus_to_exitcode(status))
                    continue
                for each in running.values():
                    if time.monotonic() - each.began > each.task.limit:
                        os.killpg(each.child, signal.SIGKILL)
                time.sleep(_POLL)
        finally:
            for each in running.values():
                os.killpg(each.child, signal.SIGKILL)

    def _begin(self, task: _Task, package: Path) -> _Running:
        name = str(task.mutant.number) if task.mutant else "_".join((*task.checks, *task.tests))
        log = self._logs / f"{re.sub('[^A-Za-z0-9_.]', '_', name)}.txt"
        if task.mutant is not None and task.mutant.is_python:
            _change(task.mutant, package)
        sys.stdout.flush()
        began = time.monotonic()
        child = os.fork()
        if child == 0:
            os._exit(_in_the_child(task, package, self._core_check, log, self._quick))
        return _Running(task=task, child=child, package=package, log=log, began=began)

    def _end(self, ended: _Running, code: int) -> tuple[_Task, int, float, Path]:
        seconds = time.monotonic() - ended.began
        # A process that a test started and did not end must not meet the next mutant.
        with suppress(ProcessLookupError):
            os.killpg(ended.child, signal.SIGKILL)
        mutant = ended.task.mutant
        if mutant is not None and mutant.is_python:
            shutil.copy2(REPOSITORY / mutant.path, _changed(mutant, ended.package))
        self._free.append(ended.package)
        return ended.task, code, seconds, ended.log


def _changed(mutant: Mutant, package: Path) -> Path:
    return package / Path(mutant.path).relative_to("python")


def _change(mutant: Mutant, package: Path) -> None:
    """Replace the file by the mutant, with a date that no compiled module has."""
    path = _changed(mutant, package)
    text = (REPOSITORY / mutant.path).read_text(encoding="utf-8")
    path.write_text(mutant.applied(text), encoding="utf-8")
    os.utime(path, (1e9 + mutant.number, 1e9 + mutant.number))


def _in_the_child(
    task: _Task, package: Path, core_check: Path | None, log: Path, quick: bool
) -> int:
    try:
        os.setpgid(
            0, 0
        )  # no session of its own: that would leave the scheduling group of a background job
        with log.open("w") as stream:
            os.dup2(stream.fileno(), 1)
            os.dup2(stream.fileno(), 2)
        inside = "" if task.mutant is None or task.mutant.is_python else str(task.mutant.number)
        os.environ |= {"JOINTID_MUTANT": inside, "PYTHONPATH": str(package)}
        for part in task.checks:
            assert core_check is not None
            if subprocess.run([core_check, part], check=False).returncode:
                return 1
        return _tested(task.tests, package, quick) if task.tests else 0
    except BaseException as error:  # the parent's code must not continue here
        os.write(2, repr(error).encode())
        return 1


def _tested(tests: tuple[str, ...], package: Path, quick: bool) -> int:
    import pytest

    os.chdir(REPOSITORY)
    sys.path.insert(0, str(package))
    try:
        import jointid
    except Exception as error:
        os.write(1, f"FAILED import: {error!r}\n".encode())
        return 1
    if package not in Path(jointid.__file__).parents:
        return _HIDDEN
    options = ["-x", "-q", "--no-header", "--tb=short", "-p", "no:cacheprovider", "-p", "no:xdist"]
    if quick:
        options += ["-m", "not slow"]
    return int(pytest.main([*options, *tests]))


def _said(code: int, log: Path) -> str:
    """Return the first test that failed, or the reason why none did."""
    if code == -signal.SIGKILL:
        return "did not end"
    if code == _NO_TEST:
        return "no test was found"
    if code == _HIDDEN:
        return "another jointid hides the changed one: an editable install? `make clean` removes it"
    found = _FIRST.search(log.read_text(encoding="utf-8", errors="replace"))
    name = (found[1] or found[2]) if found else ""
    return name or (f"signal {-code}" if code < 0 else f"exit code {code}")
