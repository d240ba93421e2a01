"""Whether a node number is one drive's: two with the same answer every question twice."""

from __future__ import annotations


class LoneNode:
    """Counts a node's boot-up messages and answers, from the reset of its communication.

    Parameters
    ----------
    node : int

    Attributes
    ----------
    booted : bool
        Its boot-up message has come.
    """

    def __init__(self, node: int) -> None:
        self._node = node
        self.begin()

    def begin(self) -> None:
        """Its communication is reset next, and no question is open."""
        self.booted, self._open = False, 0

    def asked(self) -> None:
        """It is asked for an object."""
        self._open += 1

    def answered(self) -> str:
        """Return what an answer tells; empty when it answers a question."""
        self._open -= 1
        return self._two("an object was answered twice") if self._open < 0 else ""

    def boots(self) -> str:
        """Return what a boot-up message tells; empty when it is the first."""
        again, self.booted = self.booted, True
        return self._two("the boot-up message came twice") if again else ""

    def _two(self, seen: str) -> str:
        return (
            f"two nodes answer as {self._node}: {seen} (or the drive restarts by itself); switch one of the drives "
            "off, and give it another node number"
        )
