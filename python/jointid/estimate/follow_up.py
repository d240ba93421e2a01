"""Questions to an estimate that need the recordings it was made from."""

from __future__ import annotations

from typing import TYPE_CHECKING, Protocol

if TYPE_CHECKING:
    from jointid.estimate.bootstrap import Bootstrap
    from jointid.estimate.estimate import Estimate


class FollowUp(Protocol):
    """Answers such questions; `identify` leaves one in its estimate, a file does not hold it."""

    def bootstrap(self, estimate: Estimate, n: int, seed: int) -> Bootstrap:
        """Answer `Estimate.bootstrap`."""
        ...
