"""What may go wrong at a call that writes."""

import errno
from dataclasses import dataclass

_PART = -1  # as in failing.c


@dataclass(frozen=True, kw_only=True)
class Fault:
    """One of them.

    Attributes
    ----------
    name : str
    number : int
        Of the error. 0: the power fails; -1: a part is written, which is no error.
    lasting : bool
        Whether later calls fail as well. Default: that one alone.
    harmless : bool
        Whether the program has to go on as if nothing had happened. Default: it ends, in a sentence.
    """

    name: str
    number: int
    lasting: bool = False
    harmless: bool = False


POWER = Fault(name="power", number=0)
NONE = Fault(name="none", number=0)
FAULTS = (
    POWER,
    Fault(name="ENOSPC", number=errno.ENOSPC),
    Fault(name="full disk", number=errno.ENOSPC, lasting=True),
    Fault(name="EDQUOT", number=errno.EDQUOT),
    Fault(name="EIO", number=errno.EIO),
    Fault(name="bad disk", number=errno.EIO, lasting=True),
    Fault(name="EINTR", number=errno.EINTR, harmless=True),
    Fault(name="part", number=_PART, harmless=True),
)


def faults_at(call: int, *, all_of_them: bool) -> list[Fault]:
    """The faults that are tried at a call: all, or the power's and half of the others, in turn."""
    return [
        fault
        for number, fault in enumerate(FAULTS)
        if all_of_them or fault is POWER or (number + call) % 2 == 0
    ]
