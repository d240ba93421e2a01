"""Questions to an estimate that need the recordings it was made from."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Protocol

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from jointid.estimate.bootstrap import Bootstrap
    from jointid.estimate.causes import Causes
    from jointid.estimate.estimate import Estimate
    from jointid.estimate.self_test import SelfTest


class FollowUp(Protocol):
    """Answers such questions; `identify` leaves one in its estimate, a file does not hold it."""

    def selftest(self, estimate: Estimate, trials: int, seed: int) -> SelfTest:
        """Answer `Estimate.selftest`."""
        ...

    def bootstrap(self, estimate: Estimate, n: int, seed: int) -> Bootstrap:
        """Answer `Estimate.bootstrap`."""
        ...

    def causes(self, estimate: Estimate, signals: Mapping[str, ArrayLike]) -> Causes:
        """Answer `Estimate.causes`."""
        ...
