"""The scenarios on vcan: what is done to drive, session and bus, inside the guest."""

from __future__ import annotations

import signal

from canlab.stage import Stage, switched_off, until


def plain(stage: Stage) -> None:
    """Nothing goes wrong."""
    drive = stage.emulator()
    session = stage.session()
    session.wait()
    until(lambda: switched_off(drive), "the motor stays on")
    drive.signal(signal.SIGINT)
    stage.notes["status"] = drive.wait()


SCENARIOS = {"plain": plain}
