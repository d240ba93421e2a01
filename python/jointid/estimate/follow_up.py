"""Questions to an estimate that need the recordings it was made from."""

from __future__ import annotations

from typing import Protocol


class FollowUp(Protocol):
    """Answers such questions; `identify` leaves one in its estimate, a file does not hold it."""
