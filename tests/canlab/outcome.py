"""What a scenario left in its folder, and what it must show; read outside the guest.

Times are the emulated drive's own stamps, or numbers of cycles: a machine that stands still changes neither.
"""

from __future__ import annotations

import json
import math
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise
from pathlib import Path
from typing import Any

import jointid as jid

PERIOD, HEARTBEAT = 0.03, 1.0  # [s], of bench.toml
MASTER = 0x701  # heartbeat of the session's node
LOOK = 0.5e-3  # [s] between two looks of the drive's watchdog
_MISSING = math.floor(0.05 / PERIOD) + 1  # cycles of a killed session, not older than 50 ms
_APPROACH = 15  # at most: cycles before the run
_COMMAND, _SYNC = "37F", "080"
_OPENING = "# jointid run "
_SHORTEST = 8  # rows of a recording that can be loaded


@dataclass(frozen=True)
class Outcome:
    """Of a scenario.

    Parameters
    ----------
    folder : Path
        Holds the files of its programs.
    """

    folder: Path

    @cached_property
    def _result(self) -> dict[str, Any]:
        path = self.folder / "result.json"
        assert path.is_file(), "the scenario was not played to its end"
        found: dict[str, Any] = json.loads(path.read_text())
        return found

    @property
    def error(self) -> str:
        """Why it could not be played; empty when it could."""
        said: str = self._result["error"]
        return said

    @property
    def notes(self) -> dict[str, Any]:
        """What the scenario noted."""
        found: dict[str, Any] = self._result["notes"]
        return found

    def session(self, name: str = "session") -> dict[str, Any]:
        """How a session ended."""
        path = self.folder / f"{name}.json"
        assert path.is_file(), f"{name} did not say how it ended"
        found: dict[str, Any] = json.loads(path.read_text())
        return found

    def events(self, name: str = "drive") -> list[dict[str, Any]]:
        """What happened to an emulated drive."""
        return [json.loads(line) for line in (self.folder / f"{name}.out").read_text().splitlines()]

    def recording(self) -> jid.Recording:
        """The session's."""
        return jid.load(self.folder / "session.csv")

    def said(self) -> str:
        """What its programs wrote, for whoever must find out why a check failed."""
        texts = []
        for path in sorted(self.folder.iterdir()):
            if path.suffix in (".json", ".out", ".err"):
                text = path.read_text(errors="replace")
                texts.append(f"--- {path.name}\n{text[-4000:]}")
        return "\n".join(texts)

    def switched_off(self) -> dict[str, Any]:
        """The event in which the drive's motor, which was on, first went off; it is off at the end."""
        events = self.events()
        assert not events[-1]["motor_on"], "the motor is on"
        offs = [
            later
            for earlier, later in pairwise(events)
            if earlier["motor_on"] and not later["motor_on"]
        ]
        assert offs, "the motor was never on"
        assert offs[0]["current"] == 0.0
        return offs[0]

    def off_in_time(self) -> dict[str, Any]:
        """Torque is zero within the heartbeat's time after the last heartbeat."""
        off = self.switched_off()
        silent = off["time"] - off["heard"][f"{MASTER:03X}"]
        assert silent <= HEARTBEAT + LOOK, f"on for {silent:.4f} s after the last heartbeat"
        return off

    def off_by_the_watchdog(self) -> None:
        """The drive has stopped by itself, and in time."""
        off = self.off_in_time()
        assert off["failure"] != 0, "it was switched off, and has not stopped by itself"
        assert off["time"] - off["heard"][f"{MASTER:03X}"] >= HEARTBEAT

    def off_by_the_session(self) -> None:
        """The motor was switched off by a command."""
        assert self.off_in_time()["failure"] == 0, "the drive has stopped by itself"

    def stopped(self, *limits: str, seen_off: bool | None) -> dict[str, Any]:
        """The session was stopped by one of some limits; its recording says so.

        `seen_off` is what the session must say about the motor; None: either.
        """
        session = self.session()
        assert session["ended"] == "stopped", session
        stop: dict[str, Any] = session["stop"]
        assert stop["limit"] in limits, stop
        assert stop["phase"] == "run"
        assert seen_off is None or stop["motor_off"] is seen_off, stop
        assert ("THE DRIVE DID NOT CONFIRM THAT THE MOTOR IS OFF" in stop["message"]) is not stop[
            "motor_off"
        ]
        recording = self.recording()
        assert recording.metadata["stopped"] == stop
        assert len(recording) == session["rows"] >= _SHORTEST
        return stop

    def cycles_after(self, identifier: int, payload: bytes) -> int:
        """Number of cycles that the session began after it had received a frame, by its log."""
        foreign = f"{identifier:03X}#{payload.hex().upper()}", "R"
        frames = [tuple(line.split()[2:]) for line in self._log()]
        assert foreign in frames, "the frame is not in the log"
        later = frames[frames.index(foreign) :]
        return sum(frame[0].startswith(_SYNC) and frame[1] == "T" for frame in later)

    def left_by_a_killed_session(self) -> int:
        """Rows of a killed session's recording: readable, and at most 50 ms of cycles are missing."""
        commanded = self.switched_off()["commands"] - 1  # one when the motor was switched on
        logged = sum(line.split()[2].startswith(f"{_COMMAND}#5443") for line in self._log()) - 1
        assert commanded - logged <= _MISSING
        opening, rows = self._rows()
        if not opening:
            assert commanded <= _APPROACH + _MISSING
            return 0
        missing = commanded - opening["cycles_before"] - rows
        assert missing <= _MISSING, f"{missing} cycles are missing"
        if rows >= _SHORTEST:
            recording = self.recording()
            assert recording.metadata["truncated"] is True
            assert len(recording) == rows
        return rows

    def _rows(self) -> tuple[dict[str, Any], int]:
        """What a recording's file says of the run's begin, and the number of its whole rows."""
        text = (self.folder / "session.csv").read_text()
        _, _columns, *lines = text[: text.rfind("\n") + 1].splitlines()
        if not lines:
            return {}, 0
        assert lines[0].startswith(_OPENING)
        opening: dict[str, Any] = json.loads(lines[0].removeprefix(_OPENING))
        return opening, len(lines) - 1

    def _log(self) -> list[str]:
        """The frame log's whole lines."""
        text = (self.folder / "session.log").read_text()
        return text[: text.rfind("\n") + 1].splitlines()
