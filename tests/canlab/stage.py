"""Where a scenario is played, in the guest: a vcan of its own, an emulated drive on it, a session that moves it."""

from __future__ import annotations

import json
import subprocess
import time
import traceback
from collections.abc import Callable
from pathlib import Path
from typing import Any

from canlab.programs import Emulator, HostSession, Program, until

BENCH = Path(__file__).with_name("bench.toml")


class Stage:
    """A vcan with an emulated drive; everything that it starts is ended with it.

    Parameters
    ----------
    folder : Path
        For the files of its programs.
    channel : str
        Name of the vcan, to be made.
    """

    def __init__(self, folder: Path, channel: str) -> None:
        folder.mkdir()
        self.folder, self.channel = folder, channel
        self._channels = [channel]
        self.programs: list[Program] = []
        self.notes: dict[str, Any] = {}
        _ip("link", "add", "dev", channel, "type", "vcan")
        self.link("up")

    def link(self, state: str) -> None:
        """Bring the network up or down."""
        _ip("link", "set", self.channel, state)

    def emulator(self, name: str = "drive", channel: str | None = None) -> Emulator:
        """An emulated drive, which is there when this returns."""
        found = Emulator(name, self.folder, BENCH, channel or self.channel)
        self.programs.append(found)
        return found

    def session(
        self, name: str = "session", changes: Callable[[Any], Any] | None = None
    ) -> HostSession:
        """A session, which begins."""
        found = HostSession(name, self.folder, BENCH, self.channel, changes)
        self.programs.append(found)
        return found

    def another_channel(self) -> str:
        """Make a second network, which nothing connects with the first."""
        name = f"{self.channel}b"
        _ip("link", "add", "dev", name, "type", "vcan")
        _ip("link", "set", name, "up")
        self._channels.append(name)
        return name

    def beat(self, identifier: int) -> None:
        """Let another node send heartbeats from now on."""
        first = self.folder / "beat.first"

        def run() -> int:
            while True:
                self.send((identifier, b"\x05"))
                first.touch()
                time.sleep(0.05)

        self.programs.append(Program("beat", self.folder, run))
        self.until(first.exists, "the other node does not beat")

    @staticmethod
    def until(done: Callable[[], object], otherwise: str) -> None:
        """Look again and again, but not for ever."""
        until(done, otherwise)

    def send(self, *frames: tuple[int, bytes], error: bool = False) -> None:
        """Send frames as another node on the bus."""
        import can

        with can.Bus(self.channel, interface="socketcan") as bus:
            for identifier, payload in frames:
                bus.send(
                    can.Message(
                        arbitration_id=identifier,
                        data=payload,
                        is_extended_id=False,
                        is_error_frame=error,
                    )
                )

    def close(self) -> None:
        """End what still runs."""
        for program in self.programs:
            program.end()
        for channel in self._channels:
            _ip("link", "delete", "dev", channel)


def switched_off(emulator: Emulator) -> bool:
    """Whether the drive's motor has been on, and is off."""
    seen = [event["motor_on"] for event in emulator.events()]
    return True in seen and not seen[-1]


def play(folder: Path, channel: str, act: Callable[[Stage], None]) -> None:
    """Play a scenario; what came of it is in the folder, also when it went wrong."""
    said = ""
    stage = Stage(folder, channel)
    try:
        act(stage)
    except Exception:
        said = traceback.format_exc()
    finally:
        stage.close()
        result = {"error": said, "notes": stage.notes}
        (folder / "result.json").write_text(json.dumps(result, indent=1))


def _ip(*arguments: str) -> None:
    subprocess.run(("ip", *arguments), check=True)
