"""The programs of a scenario, each a process of its own: `jointid emulate`, a session, a bridge.

They are forked from one that has loaded everything: in the guest that takes seconds.
"""

from __future__ import annotations

import json
import os
import select
import signal
import sys
import time
import traceback
from collections.abc import Callable
from pathlib import Path
from typing import Any

PATIENCE = 60.0  # [s] for what takes a fraction of one
_BEGINNINGS = 5  # of a session that its drive does not answer
_NO_REPLY = "not started: no reply to"


class Program:
    """A process; what it writes to its outputs goes into files.

    Parameters
    ----------
    name : str
        Of its files: NAME.out, NAME.err.
    folder : Path
    run : callable
        What it does; its result is the exit status.
    """

    def __init__(self, name: str, folder: Path, run: Callable[[], int]) -> None:
        self.name, self.folder = name, folder
        self.status: int | None = None
        sys.stdout.flush()
        sys.stderr.flush()
        self.pid = os.fork()
        if self.pid == 0:
            self._be(run)

    def _be(self, run: Callable[[], int]) -> None:
        status = 1
        try:
            signal.signal(signal.SIGINT, signal.default_int_handler)
            for descriptor, ending in ((1, "out"), (2, "err")):
                path = self.folder / f"{self.name}.{ending}"
                os.dup2(os.open(path, os.O_WRONLY | os.O_CREAT | os.O_TRUNC, 0o644), descriptor)
            status = run()
        except BaseException:
            traceback.print_exc()
        finally:
            sys.stdout.flush()
            sys.stderr.flush()
            os._exit(status)

    def signal(self, number: signal.Signals) -> None:
        """Send a signal."""
        if self.ended() is None:
            os.kill(self.pid, number)

    def ended(self) -> int | None:
        """Its exit status, negative that of a signal; None while it runs."""
        if self.status is None:
            found, status = os.waitpid(self.pid, os.WNOHANG)
            if found:
                self.status = os.waitstatus_to_exitcode(status)
        return self.status

    def wait(self, timeout: float = PATIENCE) -> int:
        """Its exit status, when it has ended."""
        until(lambda: self.ended() is not None, f"{self.name} does not end", timeout)
        assert self.status is not None
        return self.status

    def end(self) -> None:
        """Kill it, whatever it does."""
        self.signal(signal.SIGKILL)
        self.wait()


def until(done: Callable[[], object], otherwise: str, timeout: float = PATIENCE) -> None:
    """Look again and again, but not for ever.

    Raises
    ------
    TimeoutError
        It has not come true.
    """
    end = time.monotonic() + timeout
    while not done():
        if time.monotonic() > end:
            raise TimeoutError(otherwise)
        time.sleep(0.05)


class Emulator(Program):
    """`jointid emulate --json` on a channel."""

    def __init__(self, name: str, folder: Path, bench: Path, channel: str) -> None:
        from jointid.cli import main

        arguments = ("emulate", str(bench), "--channel", channel, "--json", "--rest", "0.005")
        super().__init__(name, folder, lambda: main(arguments))
        until(self.events, f"{name} does not begin")

    def events(self) -> list[dict[str, Any]]:
        """What has happened to the drive until now."""
        path = self.folder / f"{self.name}.out"
        text = path.read_text() if path.exists() else ""
        return [json.loads(line) for line in text[: text.rfind("\n") + 1].splitlines()]


class HostSession(Program):
    """A session on a channel; its recording is NAME.csv, how it ended NAME.json.

    Parameters
    ----------
    changes : callable, optional
        Makes another bench of the file's.
    """

    def __init__(
        self,
        name: str,
        folder: Path,
        bench: Path,
        channel: str,
        changes: Callable[[Any], Any] | None = None,
    ) -> None:
        self._reading, writing = os.pipe()
        self._phase, self._cycles, self._rest = "", 0, b""
        super().__init__(name, folder, lambda: self._run(bench, channel, changes, writing))
        os.close(writing)

    def reach(self, phase: str, cycles: int) -> None:
        """Return when so many cycles of a phase are done.

        Raises
        ------
        TimeoutError, RuntimeError
            It does not get there, or has ended before.
        """
        end = time.monotonic() + PATIENCE
        while not (self._phase == phase and self._cycles >= cycles):
            if time.monotonic() > end:
                raise TimeoutError(f"{self.name} does not get to {phase} {cycles}")
            if not select.select([self._reading], [], [], 0.1)[0]:
                continue
            block = os.read(self._reading, 65536)
            if not block:
                raise RuntimeError(f"{self.name} has ended before {phase} {cycles}")
            *lines, self._rest = (self._rest + block).split(b"\n")
            for line in lines:
                said = line.decode()
                self._cycles = self._cycles + 1 if said == self._phase else 1
                self._phase = said

    def end(self) -> None:
        """Kill it, whatever it does."""
        super().end()
        os.close(self._reading)

    def outcome(self) -> dict[str, Any] | None:
        """How it ended; None when it could not say."""
        path = self.folder / f"{self.name}.json"
        if not path.exists():
            return None
        found: dict[str, Any] = json.loads(path.read_text())
        return found

    def _run(
        self, path: Path, channel: str, changes: Callable[[Any], Any] | None, told: int
    ) -> int:
        from dataclasses import replace

        import jointid as jid
        from jointid.hardware import Session, SessionRefusedError, SessionStoppedError

        os.set_blocking(told, False)

        def tell(phase: str, *_: object) -> None:
            try:
                os.write(told, phase.encode() + b"\n")
            except BlockingIOError:
                return  # nobody reads: nobody wants to know

        bench = jid.hardware.Bench.load(path)
        bench = replace(bench, bus=replace(bench.bus, channel=channel))
        if changes is not None:
            bench = changes(bench)
        # The guest may stand still for longer than a session waits for its drive: as its user would, begin again.
        for _ in range(_BEGINNINGS):
            outcome: dict[str, Any] = {"ended": "done", "said": "", "stop": None}
            recording = None
            with jid.hardware.open_drive(bench) as drive:
                session = Session(
                    drive,
                    bench.controller,
                    bench.trajectory,
                    bench.limits,
                    options=bench.options,
                    output=self.folder / f"{self.name}.csv",
                    observer=tell,
                )
                try:
                    recording = session.run()
                except SessionRefusedError as error:
                    outcome |= {"ended": "refused", "said": str(error)}
                except SessionStoppedError as error:
                    outcome |= {
                        "ended": "stopped",
                        "said": str(error),
                        "stop": error.stop.to_dict(),
                    }
                    recording = error.recording
            if not outcome["said"].startswith(_NO_REPLY):
                break
        outcome["rows"] = 0 if recording is None else len(recording)
        if recording is not None:
            outcome["motor_off"] = recording.metadata["motor_off"]
            outcome["timing"] = recording.metadata["timing"]
        (self.folder / f"{self.name}.json").write_text(json.dumps(outcome, indent=1))
        return 0
