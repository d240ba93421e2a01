"""Reading a file in a process of its own: what is said, and the memory that the whole program takes."""

import contextlib
import os
import resource
import subprocess
import sys
from pathlib import Path

import pytest

MOST = 500_000_000  # bytes of the whole program, for a file of a few megabytes
_RESERVED = 8_000_000_000  # bytes, so that a test that fails does not take the machine
_CODE = """
import sys
import jointid as jid
try:
    jid.load(sys.argv[1])
except jid.InputError as error:
    print(error)
peak = next(line for line in open("/proc/self/status") if line.startswith("VmHWM"))
print(int(peak.split()[1]) * 1024)  # of this program alone; ru_maxrss begins with the parent's
"""
on_linux = pytest.mark.skipif(
    sys.platform != "linux", reason="the peak is measured as Linux counts it"
)


def _limit() -> None:
    with contextlib.suppress(ValueError):  # it is lower already
        resource.setrlimit(resource.RLIMIT_AS, (_RESERVED, _RESERVED))


def refusal(path: Path) -> str:
    """Return what `load` says of a file that it refuses, in less memory than `MOST`."""
    done = subprocess.run(
        [sys.executable, "-c", _CODE, str(path)],
        capture_output=True,
        text=True,
        timeout=120,
        env=os.environ | {"OPENBLAS_NUM_THREADS": "1"},
        check=False,
        preexec_fn=_limit,
    )
    assert done.returncode == 0, done.stderr
    sentence, peak = done.stdout.splitlines()
    assert path.name in sentence
    assert int(peak) < MOST
    return sentence
