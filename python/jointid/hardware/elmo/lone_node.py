"""Check that only one drive has a node number: two drives answer every question twice."""

from __future__ import annotations


class LoneNode:
    """Count a node's boot-up messages and answers after the reset of its communication.

    Parameters
    ----------
    node : int

    Attributes
    ----------
    booted : bool
        Whether the boot-up message has arrived.
    """

    def __init__(self, node: int) -> None:
        self._node = node
        self.begin()

    def begin(self) -> None:
        """Start: the communication is reset next, and no question is open."""
        self.booted, self._open = False, 0

    def asked(self) -> None:
        """Note a question for an object."""
        self._open += 1

    def answered(self) -> str:
        """Return the problem that an answer shows; empty when it answers a question."""
        self._open -= 1
        return self._two("an object was answered twice") if self._open < 0 else ""

    def boots(self) -> str:
        """Return the problem that a boot-up message shows; empty when it is the first."""
        again, self.booted = self.booted, True
        return self._two("the boot-up message came twice") if again else ""

    def _two(self, seen: str) -> str:
        return (
            f"two drives answer as node {self._node}: {seen} (or the drive has restarted); switch one drive "
            "off, and change the node number of the other"
        )
