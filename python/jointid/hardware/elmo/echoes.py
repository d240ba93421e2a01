"""Compare the replies to torque commands with the commands sent, to detect lost or foreign commands."""

from __future__ import annotations

import math
from collections import deque

from jointid.hardware.session.drive import DriveFaultError

_MOST_MISSING = 5  # commands in a row without their echo
_ROUNDING = 1e-6  # relative, of a 32-bit float; also absolute [A]


class CommandEchoes:
    """Compare the drive's replies to TC with the commands. Each reply repeats the commanded value.

    Attributes
    ----------
    lost : int
        Lost single echoes or commands: a later command was answered.
    """

    def __init__(self) -> None:
        self._waiting: deque[float] = deque()
        self._last: float | None = None
        self._compares = False
        self.lost = 0

    def begin(self) -> None:
        """Start: the motor is on at zero torque, and commands follow."""
        self._waiting.clear()
        self._last, self._compares, self.lost = 0.0, True, 0

    def end(self) -> None:
        """Stop: the motor is being switched off."""
        self._compares = False

    def sent(self, current: float) -> None:
        """Note a sent command [A]."""
        if self._compares:
            self._waiting.append(current)

    @property
    def confirmed(self) -> bool:
        """Whether every command has been answered. The last answer is due by the next sample."""
        return not self._waiting

    def came(self, current: float) -> str:
        """Compare an echo [A] with the commands. Return the problem; empty when there is none."""
        if not self._compares:
            return ""
        for place, wanted in enumerate(self._waiting):
            if math.isclose(current, wanted, rel_tol=_ROUNDING, abs_tol=_ROUNDING):
                for _ in range(place + 1):
                    self._last = self._waiting.popleft()
                self.lost += place
                return "" if place < _MOST_MISSING else self._unanswered(place)
        if self._last is not None and current == self._last:
            return ""  # duplicate frame
        wanted_text = f", but {self._waiting[0]:.6g} A was sent" if self._waiting else ""
        return (
            f"the drive acknowledges TC = {current:.6g} A{wanted_text}: a command was changed in transmission, or "
            "another program commands the drive"
        )

    def check(self) -> None:
        """Check that echoes arrive.

        Raises
        ------
        DriveFaultError
            "command_echo": five commands in a row were not answered.
        """
        missing = len(self._waiting) - 1  # the echo of the newest command may not have arrived yet
        if missing >= _MOST_MISSING:
            raise DriveFaultError(
                "command_echo",
                self._unanswered(missing),
                measured=missing,
                allowed=_MOST_MISSING - 1,
            )

    def _unanswered(self, count: int) -> str:
        return (
            f"the drive has not acknowledged {count} torque commands in a row, more than {_MOST_MISSING - 1}: "
            "its torque differs from the command"
        )
