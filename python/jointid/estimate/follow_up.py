"""Questions to an estimate that need the recordings it was made from."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Protocol

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from jointid.estimate.causes import Causes
    from jointid.estimate.estimate import Estimate


class FollowUp(Protocol):
    """Answers such questions; `identify` leaves one in its estimate, a file does not hold it."""

    def causes(self, estimate: Estimate, signals: Mapping[str, ArrayLike] | None) -> Causes:
        """Attribute the misfit of the estimate."""
