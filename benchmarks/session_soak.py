"""Repeated sessions on the virtual clock: nothing may grow, no sample may be lost."""

from __future__ import annotations

import gc
import tempfile
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from session_rig import PERIOD, devices, run

import jointid as jid
from jointid.hardware.emulated.bus import EmulatedBus

_MOST_GROWN = 20e6  # [bytes]


def resident() -> int:
    """Return the resident memory [bytes]."""
    pages = int(Path("/proc/self/statm").read_text().split()[1])
    return pages * 4096


def count(what: str) -> int:
    """Count the open entries of this process: threads ("task") or files ("fd")."""
    return len(list(Path(f"/proc/self/{what}").iterdir()))


@dataclass(frozen=True, kw_only=True)
class Soaked:
    """State after many sessions.

    Attributes
    ----------
    sessions, samples, lost : int
        `lost` counts samples and the drive's answers, in memory or on disk.
    grown : int
        Growth of the resident memory [bytes].
    threads, files : tuple of int
        Numbers before and after.
    """

    sessions: int
    samples: int
    lost: int
    grown: int
    threads: tuple[int, int]
    files: tuple[int, int]

    @property
    def sound(self) -> bool:
        """Whether nothing has grown and nothing is lost."""
        level = self.threads[0] == self.threads[1] and self.files[0] == self.files[1]
        return level and self.lost == 0 and self.grown <= _MOST_GROWN

    def __str__(self) -> str:
        return (
            f"{self.sessions} sessions: {self.samples} samples, {self.lost} lost, memory "
            f"{self.grown / 1e6:+.1f} MB, threads {self.threads[0]} -> {self.threads[1]}, files "
            f"{self.files[0]} -> {self.files[1]}"
        )


def one_session(path: Path, seconds: float, seed: int) -> tuple[int, int]:
    """Return the samples of a session that is kept on disk at `path`, and the number of lost ones."""
    recording = run(EmulatedBus(*devices(seed)), seconds, path)
    expected = round(seconds / PERIOD)
    on_disk = jid.load(path)
    lost = abs(expected - recording.time.size) + abs(expected - on_disk.time.size)
    if not lost:
        lost += int((np.round(np.diff(recording.time) / PERIOD) != 1.0).sum())
        lost += int((recording.position != on_disk.position).sum())
    frames = path.with_suffix(".log").read_bytes()
    asked, answered = frames.count(b" 080#"), frames.count(b" 4FF#")
    cycles = recording.metadata["timing"]["cycles"]
    lost += max(0, cycles - asked) + abs(asked - answered)
    return expected, lost


def soak_sessions(minutes: float, seconds: float = 12.0, settle: int = 10) -> Soaked:
    """Run sessions of this many seconds for this many emulated minutes, the first few to warm up."""
    samples = lost = 0
    before = (0, 0, 0)
    rounds = max(1, round(60.0 * minutes / seconds))
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "run.csv"
        for k in range(-settle, rounds):
            gc.collect()  # drive and bus reference each other, so only a collection frees them
            if k == 0:
                before = resident(), count("task"), count("fd")
            taken, missing = one_session(path, seconds, seed=k + settle)
            for each in path.parent.iterdir():
                each.unlink()
            if k >= 0:
                samples, lost = samples + taken, lost + missing
    gc.collect()
    after = resident(), count("task"), count("fd")
    return Soaked(
        sessions=rounds,
        samples=samples,
        lost=lost,
        grown=after[0] - before[0],
        threads=(before[1], after[1]),
        files=(before[2], after[2]),
    )
