"""Watchdog of a drive: its time, the host's sign of life, and the drive's reaction."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Literal, get_args

from jointid.base.argument_checks import require_kind
from jointid.base.errors import InputError
from jointid.joint.checks import check_choice, is_number

Feed = Literal["heartbeat", "command", "any frame to the node", "any frame from the master"]
Reaction = Literal["off", "damped", "held", "braked", "nothing"]

_OWNER = "watchdog"


@dataclass(frozen=True, slots=True, kw_only=True)
class Watchdog:
    """Watchdog that a drive declares: how the drive stops its motor when the host fails.

    Attributes
    ----------
    time : float
        Time from the host's last sign of life until the drive reacts [s].
    fed_by : str
        Sign of life: "heartbeat", "command", "any frame to the node", "any frame from the master".
    then : str
        Reaction: "off", "damped", "held", "braked", "nothing".
    read_back : bool
        Whether the drive has confirmed these settings. If False, only a test with the motor on proves them.

    Raises
    ------
    InputError
        A value has the wrong type or is unknown.

    Examples
    --------
    >>> print(Watchdog(time=0.05, fed_by="heartbeat", then="off", read_back=True))
    off after 50 ms without heartbeat
    """

    time: float
    fed_by: Feed
    then: Reaction
    read_back: bool

    def __post_init__(self) -> None:
        if not (is_number(self.time) and 0.0 < self.time < math.inf):
            raise InputError(
                "more than 0 s is expected", argument="time", value=self.time, place=_OWNER
            )
        check_choice(_OWNER, "fed_by", self.fed_by, get_args(Feed))
        check_choice(_OWNER, "then", self.then, get_args(Reaction))
        if not isinstance(self.read_back, bool):
            raise InputError(
                "true or false is expected",
                argument="read_back",
                value=self.read_back,
                place=_OWNER,
            )

    def __str__(self) -> str:
        return f"{self.then} after {1e3 * self.time:g} ms without {self.fed_by}"


def watchdog_of(drive: object) -> Watchdog | None:
    """Return the value of a drive's attribute `watchdog`; None without it.

    Raises
    ------
    InputError
        The attribute is not a Watchdog.
    """
    found = getattr(drive, "watchdog", None)
    if found is not None:
        require_kind("watchdog", found, Watchdog)
    return found
