"""A page that is served by a process of its own, as `jointid app` does it."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from importlib.util import find_spec
from urllib.parse import urlsplit

import pytest

LARGEST = 3_000_000


@dataclass(frozen=True, kw_only=True)
class Served:
    """A running server."""

    address: str
    process: subprocess.Popen[str]

    @property
    def port(self) -> int:
        """Where it listens."""
        port = urlsplit(self.address).port
        assert port is not None
        return port


def require_nicegui() -> None:
    """Skip the test where the extra `app` is not installed."""
    if find_spec("nicegui") is None:
        pytest.skip("the package nicegui is not installed")


@contextmanager
def served() -> Iterator[Served]:
    """Start a server, and end it as Ctrl-C does."""
    command = [sys.executable, "-m", "jointid", "app", "--no-browser"]
    # NiceGUI behaves differently where it believes to be under pytest.
    environment = {name: value for name, value in os.environ.items() if "PYTEST" not in name}
    process = subprocess.Popen(
        [*command, "--largest", str(LARGEST / 1e6)],
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
        env=environment | {"PYTHONUNBUFFERED": "1"},
    )
    assert process.stdout is not None
    said = []
    try:
        for line in process.stdout:
            said.append(line)
            if line.startswith("http://"):
                break
        else:
            pytest.fail(f"no address was printed: {''.join(said)}")
        yield Served(address=said[-1].strip(), process=process)
    finally:
        process.send_signal(signal.SIGINT)
        process.wait(timeout=20)
        process.stdout.close()
