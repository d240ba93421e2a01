"""A full disk, a bad one and a power loss at each call that writes: no torn file, nothing acknowledged lost.

`make write-faults` tries every call; here a part of the long scenarios is tried.
"""

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

_TESTS = Path(__file__).resolve().parents[1]
_COMPILER = shutil.which("cc") or shutil.which("gcc")
_ALL = os.environ.get("JOINTID_WRITE_FAULTS") == "all"  # `make write-faults`
# Calls that are tried of each scenario (0: all), and faults at least: four at each call, and one behind the end.
_SCENARIOS = {
    "recording": (0, 17),
    "joint": (0, 17),
    "design": (0, 17),
    "estimate": (0, 17),
    "report": (0, 17),
    "run": (0, 24),
    "sweep": (20, 81),
    "session": (4, 4),
    "command identify": (3, 13),
    "command report": (2, 9),
    "command sweep": (3, 13),
    "command design": (2, 9),
    "command simulate": (2, 9),
    "command export": (2, 9),
    "command run": (3, 13),
}
_counted: dict[str, int] = {}


@pytest.fixture(scope="module")
def library(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The layer between the program and the C library."""
    if sys.platform != "linux" or _COMPILER is None:
        pytest.skip("needs Linux and a C compiler")
    made = tmp_path_factory.mktemp("faults") / "failing.so"
    source = _TESTS / "write_faults" / "failing.c"
    options = ["-O1", "-Wall", "-Wextra", "-Werror", "-shared", "-fPIC"]
    subprocess.run([_COMPILER, *options, "-o", made, source, "-ldl"], check=True)
    return made


@pytest.mark.parametrize("name", _SCENARIOS)
def test_every_fault_at_every_call(name: str, library: Path) -> None:
    most, least = _SCENARIOS[name]
    driver = _TESTS / "write_faults" / "driver.py"
    done = subprocess.run(
        [sys.executable, str(driver), name, str(library), "0" if _ALL else str(most)],
        capture_output=True,
        text=True,
        timeout=3600 if _ALL else 600,
        env=os.environ
        | {
            "LD_PRELOAD": str(library),
            "OPENBLAS_NUM_THREADS": "1",
            "PYTHONPATH": os.pathsep.join([str(_TESTS), os.environ.get("PYTHONPATH", "")]),
        },
        check=False,
    )
    assert done.returncode == 0, done.stderr
    *wrong, count = done.stdout.splitlines()
    assert not wrong, "\n".join([*wrong[:20], done.stderr[-2000:]])
    _counted[name] = int(count.split()[0])
    assert _counted[name] >= least


@pytest.mark.skipif(not _ALL, reason="`make write-faults` injects them all")
def test_there_were_a_thousand() -> None:
    sys.stderr.write(f"\n{_counted}: {sum(_counted.values())} faults\n")
    assert sum(_counted.values()) >= 1000
