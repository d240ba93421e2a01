"""Groups of joints with a common clock: two publishers on one topic have two clocks."""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from jointid.base.advice import Action
from jointid.base.errors import InputError
from jointid.recording.signals import TORQUES

_SHOWN = 3  # clocks that a message proposes


def on_one_clock(
    names: Sequence[str], fields: Sequence[Mapping[str, Any]], place: str, *, named: bool
) -> tuple[list[int], dict[str, str]]:
    """Return the indices of the joints on one clock, and the reason why each other joint is left out.

    Parameters
    ----------
    names : sequence of str
    fields : sequence of mapping
        Each joint's signals.
    place : str
        For messages.
    named : bool
        Whether the user named the joints; then none is left out.

    Raises
    ------
    InputError
        The joints have several clocks, and either the user named them, or no clock has most of the torques.
    """
    clocks: list[list[int]] = []
    for joint, held in enumerate(fields):
        same = (c for c in clocks if np.array_equal(held["time"], fields[c[0]]["time"]))
        clock = next(same, None)
        if clock is None:
            clocks.append([joint])
        else:
            clock.append(joint)
    sizes = [(sum(_has_torque(fields[k]) for k in clock), len(clock)) for clock in clocks]
    best = max(sizes)
    if len(clocks) > 1 and (named or sizes.count(best) > 1):
        other = clocks[1][0]
        raise InputError(
            f"{names[other]} and {names[0]} were logged at different times",
            argument="joints",
            place=place,
            remedy=tuple(
                Action(
                    "call",
                    {"joints": [names[k] for k in clocks[at]]},
                    function="load_robot",
                    text="which were logged together" if len(clocks[at]) > 1 else "",
                )
                for at in sorted(range(len(clocks)), key=lambda k: sizes[k], reverse=True)[:_SHOWN]
            ),
        )
    kept = clocks[sizes.index(best)]
    rest = {names[k]: _why(fields[k]) for k in range(len(names)) if k not in kept}
    return kept, rest


def _has_torque(held: Mapping[str, Any]) -> bool:
    return any(held.get(signal) is not None for signal in TORQUES)


def _why(held: Mapping[str, Any]) -> str:
    period = float(np.median(np.diff(held["time"]))) if len(held["time"]) > 1 else 0.0
    rate = f", {1.0 / period:.3g} Hz" if period > 0.0 else ""
    return f"logged at other times{rate}{'' if _has_torque(held) else ', no torque'}"
