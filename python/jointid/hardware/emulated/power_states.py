"""States of CiA 402 from a drive that is off to a drive with its motor on."""

from __future__ import annotations

from collections.abc import Callable

from jointid.hardware.emulated.object_dictionary import WRONG_STATE, AccessError

# 6041h's bits: 1 ready to switch on, 2 switched on, 4 operation enabled, 8 fault, 10h voltage, 20h no
# quick stop, 40h switch on disabled.
_WORDS = {"disabled": 0x250, "ready": 0x231, "switched on": 0x233, "enabled": 0x237, "fault": 0x218}


class PowerStates:
    """Controlword and statusword of a drive.

    Parameters
    ----------
    motor_on, failed : callable
        Whether the motor is on; whether a failure switched it off.
    switch : callable
        Switches the motor; raises `AccessError` if it cannot be switched on.
    acknowledge : callable
        Clears the failure.
    """

    def __init__(
        self,
        motor_on: Callable[[], bool],
        failed: Callable[[], bool],
        switch: Callable[[bool], None],
        acknowledge: Callable[[], None],
    ) -> None:
        self._motor_on, self._failed = motor_on, failed
        self._switch, self._acknowledge = switch, acknowledge
        self._resting = "disabled"  # while the motor is off
        self.word = 0

    @property
    def state(self) -> str:
        """One of "disabled", "ready", "switched on", "enabled", "fault"."""
        if self._failed() and not self._motor_on():
            return "fault"
        return "enabled" if self._motor_on() else self._resting

    def status(self) -> int:
        """Return the statusword."""
        return _WORDS[self.state]

    def forget(self) -> None:
        """Restore the state after power-up."""
        self._resting, self.word = "disabled", 0

    def control(self, word: int) -> None:
        """Execute a controlword.

        Raises
        ------
        AccessError
            The motor cannot be switched on.
        """
        rising, self.word = word & ~self.word, word
        if self.state == "fault":
            if rising & 0x80:
                self._acknowledge()
                self._resting = "disabled"
            return
        if not word & 0x02 or not word & 0x04:  # disable voltage, quick stop
            self._off("disabled")
        elif not word & 0x01:  # shutdown
            self._off("ready")
        elif not word & 0x08:  # switch on, or disable operation
            if self.state == "disabled":
                raise AccessError(WRONG_STATE)
            self._off("switched on")
        elif self.state == "disabled":
            raise AccessError(WRONG_STATE)
        elif self.state != "enabled":
            self._switch(True)

    def _off(self, resting: str) -> None:
        self._resting = resting
        if self._motor_on():
            self._switch(False)
