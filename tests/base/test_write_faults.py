"""A full disk, a bad one and a power loss at each call that writes: no torn file, nothing acknowledged lost."""

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

_TESTS = Path(__file__).resolve().parents[1]
_COMPILER = shutil.which("cc") or shutil.which("gcc")
# Faults of each scenario, at least: three at each call.
_SCENARIOS = {"recording": 12, "joint": 12, "design": 12, "estimate": 12, "run": 18, "sweep": 300}


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
    done = subprocess.run(
        [sys.executable, str(_TESTS / "write_faults" / "driver.py"), name, str(library)],
        capture_output=True,
        text=True,
        timeout=300,
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
    assert not wrong, "\n".join(wrong[:20])
    assert int(count.split()[0]) >= _SCENARIOS[name]
