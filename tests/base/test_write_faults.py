"""A full disk, a bad one and a power loss at each call that writes: no torn file, nothing acknowledged lost.

`make write-faults` tries every call with every fault; here some calls of the long scenarios are tried with some.
"""

import ast
import os
import shutil
import subprocess
import sys
from collections.abc import Iterator
from itertools import takewhile
from pathlib import Path
from threading import Timer

import pytest
from lanes import slow_but

import jointid as jid

_TESTS = Path(__file__).resolve().parents[1]
_PACKAGE = Path(jid.__file__).resolve().parent
_COMPILER = shutil.which("cc") or shutil.which("gcc")
_ALL = os.environ.get("JOINTID_WRITE_FAULTS") == "all"  # `make write-faults`
_REST = "`make write-faults` runs it"
_NEVER = -1
# Of each scenario: calls that are tried here (0: all) and by `make write-faults`, and faults at least here. A session
# writes the same hundreds of times: more of them show nothing new.
_SCENARIOS = {
    "recording": (0, 0, 25),
    "recording text": (2, 0, 7),
    "robot recording": (2, 0, 7),
    "joint": (0, 0, 25),
    "design": (0, 0, 25),
    "estimate": (0, 0, 25),
    "joints": (_NEVER, 0, 0),
    "robot": (_NEVER, 0, 0),
    "servo": (2, 0, 7),
    "certificate": (2, 0, 7),
    "study table": (2, 0, 7),
    "study": (2, 0, 7),
    "report": (0, 0, 25),
    "model": (2, 0, 7),
    "header": (2, 0, 7),
    "run": (0, 0, 32),
    "sweep": (20, 0, 60),
    "resumed sweep": (6, 0, 15),
    "session": (4, 0, 7),
    "command identify": (3, 0, 11),
    "command long identify": (_NEVER, 24, 0),
    "command identify servo": (_NEVER, 0, 0),
    "command compare": (_NEVER, 0, 0),
    "command report": (2, 0, 7),
    "command new": (2, 0, 7),
    "command demo": (2, 0, 7),
    "command sweep": (3, 21, 7),  # of 18 or 19 calls, as busy as the machine is: 10 to 14 faults
    "command sweep drawn": (_NEVER, 16, 0),
    "command design": (2, 0, 7),
    "command design drawn": (_NEVER, 12, 0),
    "command simulate": (2, 0, 7),
    "command export": (2, 0, 7),
    "command export into": (_NEVER, 0, 0),
    "command run": (3, 24, 4),
    "command run and identify": (_NEVER, 24, 0),
}
_counted: dict[str, int] = {}

# Which scenario shows a module that writes files.
_SHOWN = {
    "base.result": "robot",
    "cli.commands": "command demo",
    "cli.designs": "command design drawn",
    "cli.new_joint": "command new",
    "cli.outputs": "command report",
    "cli.session": "command run",
    "cli.study": "command sweep drawn",
    "commissioning.cycles": "command run",
    "estimate.estimate": "estimate",
    "excitation.design": "design",
    "exports.exporting": "model",
    "hardware.proof.certificate": "certificate",
    "hardware.session.recorder": "run",
    "identification.search.run": "command long identify",
    "joint.joint_file": "joint",
    "recording.saving": "recording",
    "recording.wide.robot_saving": "robot recording",
    "report.saving": "report",
    "servo.estimate": "servo",
    "study.study_file": "sweep",
    "study.tables": "study table",
}
_OTHERS = {
    "base.files": "what the others use",
    "base.pictures": "what the others use",
    "hardware.live.window": "a process of its own, for one picture through base.pictures: tests/hardware/test_live.py",
    "hardware.emulated.object_dictionary": "no file: an entry of an emulated drive",
    "recording.readers.open_files": "a copy that is read at once and removed",
    "recording.messages.ros2_source": "a copy that is read at once and removed",
}
_WRITERS = {"write_whole", "write_new", "write_picture", "make_folder", "open_locked", "new_beside"}
_WRITERS |= {"AppendedFile", "savefig", "mkdir", "makedirs", "write_text", "write_bytes", "touch"}


class Driver:
    """A process of `write_faults/driver.py`, which answers one scenario after the other."""

    def __init__(self, library: Path, errors: Path) -> None:
        self._errors = errors
        path = os.pathsep.join([str(_TESTS), os.environ.get("PYTHONPATH", "")])
        settings = {"LD_PRELOAD": str(library), "OPENBLAS_NUM_THREADS": "1", "PYTHONPATH": path}
        with errors.open("wb") as said:
            self._process = subprocess.Popen(
                [sys.executable, str(_TESTS / "write_faults" / "driver.py"), str(library)],
                stdin=subprocess.PIPE,
                stdout=subprocess.PIPE,
                stderr=said,
                text=True,
                env=os.environ | settings,
            )

    def answer(self, name: str, most: int) -> list[str]:
        """The lines about a scenario."""
        process = self._process
        assert process.stdin is not None
        assert process.stdout is not None
        process.stdin.write(f"{name}\t{most}\t{'all' if _ALL else 'some'}\n")
        process.stdin.flush()
        timer = Timer(7200.0 if _ALL else 600.0, process.kill)
        timer.start()
        try:
            lines = list(takewhile(lambda line: line != "\n", process.stdout))
        finally:
            timer.cancel()
        return [line.rstrip("\n") for line in lines]

    def errors(self) -> str:
        """The end of what it said beside its answers."""
        return self._errors.read_text(encoding="utf-8", errors="replace")[-3000:]

    def close(self) -> None:
        """End it."""
        self._process.communicate()


@pytest.fixture(scope="module")
def driver(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Driver]:
    """With the layer between the program and the C library."""
    if sys.platform != "linux" or _COMPILER is None:
        pytest.skip("needs Linux and a C compiler")
    folder = tmp_path_factory.mktemp("faults")
    made = folder / "failing.so"
    sources = [_TESTS / "write_faults" / name for name in ("failing.c", "disk.c")]
    options = ["-O1", "-Wall", "-Wextra", "-Werror", "-shared", "-fPIC"]
    subprocess.run([_COMPILER, *options, "-o", made, *sources, "-ldl"], check=True)
    running = Driver(made, folder / "errors")
    yield running
    running.close()


@pytest.mark.parametrize("name", slow_but(_SCENARIOS, "recording", "joint", "certificate"))
def test_every_fault_at_every_call(name: str, driver: Driver) -> None:
    few, most, least = _SCENARIOS[name]
    if few == _NEVER and not _ALL:
        pytest.skip(_REST)
    lines = driver.answer(name, most if _ALL else few)
    assert len(lines) >= 2, driver.errors()
    *wrong, writers, count = lines
    assert not wrong, "\n".join([*wrong[:20], driver.errors()])
    assert {module for module, shows in _SHOWN.items() if shows == name} <= set(writers.split())
    _counted[name] = int(count.split()[0])
    if _ALL:
        sys.stderr.write(f"\n{name}: {_counted[name]} faults\n")
    assert _counted[name] >= least


@pytest.mark.skipif(not _ALL, reason="`make write-faults` injects them all")
def test_there_were_a_thousand() -> None:
    """What grows counts for little: without studies and sessions there are more than a thousand as well."""
    growing = (
        "run",
        "sweep",
        "resumed sweep",
        "session",
        "command run",
        "command run and identify",
    )
    other = sum(count for name, count in _counted.items() if name not in growing)
    sys.stderr.write(
        f"\n{_counted}: {sum(_counted.values())} faults, {other} at what is replaced\n"
    )
    assert other >= 1000


def _writes(call: ast.Call) -> bool:
    name = call.func.attr if isinstance(call.func, ast.Attribute) else getattr(call.func, "id", "")
    if name != "open":
        return name in _WRITERS
    words = [*call.args, *(word.value for word in call.keywords)]
    return any(
        isinstance(each, ast.Constant)
        and isinstance(each.value, str)
        and each.value.strip("bt+") in ("w", "a", "x")
        for each in words
    )


def test_every_module_that_writes_is_shown() -> None:
    """Whoever writes files in a new place adds a scenario of it."""
    writing = {
        ".".join(path.relative_to(_PACKAGE).with_suffix("").parts)
        for path in _PACKAGE.rglob("*.py")
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8")))
        if isinstance(node, ast.Call) and _writes(node)
    }
    assert writing == _SHOWN.keys() | _OTHERS.keys()
    assert set(_SHOWN.values()) <= _SCENARIOS.keys()
