"""Default corrections of a recording before use: wrapped angles, and rows that repeat the previous row."""

from __future__ import annotations

from jointid.base.values import dataclass
from jointid.recording.held_rows import without_held_rows
from jointid.recording.recording import Recording
from jointid.recording.unwrapping import unwrapped


@dataclass(frozen=True, slots=True, kw_only=True)
class Mend:
    """One correction.

    Attributes
    ----------
    code : {"unwrapped", "held_rows", "held_torque"}
        Code of the finding.
    count : int
        Number of wraps, of rows left out, or of rows that hold the torque.
    size : float
        Size of a wrap [rad]; usual number of rows per sample for held rows; hold time [s] for a held torque.
    """

    code: str
    count: int
    size: float


def mended(run: Recording) -> tuple[Recording, tuple[Mend, ...]]:
    """Return the corrected recording and the corrections; without corrections the same recording."""
    mends = []
    found = unwrapped(run)
    if found is not None:
        position, count, size = found
        velocity = {"velocity": None} if run.velocity_derived else {}
        run = run.with_signals(position=position, **velocity)
        mends.append(Mend(code="unwrapped", count=count, size=size))
    held = without_held_rows(run)
    if held is not None:
        mends.append(Mend(code="held_rows", count=len(run) - len(held[0]), size=held[1]))
        run = held[0]
    return run, tuple(mends)
