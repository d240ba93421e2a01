"""Ctrl-C and SIGTERM, as real signals: the session stops between two cycles, and the motor is off."""

import json
import os
import signal
import subprocess
import sys
import threading
from pathlib import Path
from typing import Any

import pytest

from jointid.hardware.session.interruptions import Interruptions

CHILD = Path(__file__).parents[1] / "interrupted_session.py"
ZERO, OFF = "5443008000000000", "4d4f000000000000"
PERIOD = 2e-3
PHASES = ("check", "move", "settle", "run", "end")


def interrupted(phase: str, number: signal.Signals) -> dict[str, Any]:
    """How a session ended that was sent a signal in a phase."""
    with subprocess.Popen(
        [sys.executable, str(CHILD), phase],
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        text=True,
        env=os.environ | {"PYTHONUNBUFFERED": "1"},
    ) as child:
        assert child.stdin is not None
        assert child.stdout is not None
        assert child.stdout.readline() == "ready\n"
        child.send_signal(number)
        out, _ = child.communicate("go on\n", timeout=60.0)
        assert child.returncode == 0
    found: dict[str, Any] = json.loads(out)
    return found


@pytest.mark.parametrize(
    ("phase", "number"),
    [(phase, signal.SIGINT) for phase in PHASES]
    + [
        pytest.param(phase, signal.SIGTERM, marks=() if phase == "run" else pytest.mark.slow)
        for phase in PHASES
    ],
    ids=lambda each: getattr(each, "name", each),
)
def test_signal_stops_the_session(phase: str, number: signal.Signals) -> None:
    found = interrupted(phase, number)
    stop = found["stop"]
    assert stop["limit"] == "user"
    assert stop["message"] == f"stopped by {number.name}"
    assert stop["phase"] == ("run" if phase == "end" else phase)
    assert stop["motor_off"] is True
    assert found["last"] == [ZERO, OFF]
    if phase == "check":
        assert found["switchings"] == []
    else:
        (_, on), (when, off) = found["switchings"]
        assert (on, off) == (True, False)
        braked = found["braked"]["time"] if found["braked"] else 0.0
        assert braked <= 0.05
        assert when - stop["moment"] <= braked + 3 * PERIOD
    if phase == "run":
        assert stop["time"] <= 0.1 + 5 * PERIOD
        assert found["rows"] >= 50


def test_signals_are_given_back() -> None:
    before = [signal.getsignal(number) for number in (signal.SIGINT, signal.SIGTERM)]
    with Interruptions() as caught:
        signal.raise_signal(signal.SIGTERM)
        signal.raise_signal(signal.SIGINT)
    assert caught.reason == "stopped by SIGTERM"
    assert before == [signal.getsignal(number) for number in (signal.SIGINT, signal.SIGTERM)]


def test_ctrl_c_again_and_again_leaves_a_drive_that_does_not_come_back() -> None:
    with Interruptions() as caught:
        signal.raise_signal(signal.SIGINT)
        signal.raise_signal(signal.SIGINT)
        assert caught.reason == "stopped by SIGINT"
        with pytest.raises(KeyboardInterrupt):
            signal.raise_signal(signal.SIGINT)


def test_other_threads_are_left_alone() -> None:
    seen = []

    def enter() -> None:
        with Interruptions() as caught:
            seen.append((caught.reason, signal.getsignal(signal.SIGTERM)))

    thread = threading.Thread(target=enter)
    thread.start()
    thread.join()
    assert seen == [(None, signal.getsignal(signal.SIGTERM))]
