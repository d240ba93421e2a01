"""The voltage between rows: a log has the duty at its rows, and the position loop says how it moves in between.

A command that moves evenly between rows makes the duty do so, too. One that is held until the next row makes it jump
there, and is half a row late on average: the loop answers to where the command was. Which of the two a servo has, or
what lies between (a command that is refreshed several times a row, or a log whose stamps are not the loop's), the
torque balance tells, with the voltage as even + held · late.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from jointid.joint.voltage_drive import VoltageDrive
from jointid.servo.signals import ServoSignals

Array = NDArray[np.float64]

UNSATURATED = 0.98
"""A duty beyond this share of the saturation is limited: it does not tell the error of position."""


def voltages(
    run: ServoSignals, drive: VoltageDrive | None, times: Array, lead: float
) -> tuple[Array, Array]:
    """Return the voltage [V] of a command that moves evenly, and what a held one adds, at `times` [s].

    Without a drive that has a position loop, nothing is added. `lead` is how much older a row's position is than its
    duty [s].
    """
    # A row's duty was read after its position, so it belongs to a later time.
    stamps = run.time + lead
    driven = run.driven_at(times)
    even = np.interp(times, stamps, run.duty * run.supply) * driven
    loop = None if drive is None else drive.position_loop
    if loop is None or run.reference is None or not run.closed:
        return even, np.zeros(len(times))
    row = float(np.median(np.diff(run.time)))
    seen = stamps - loop.delay
    wanted = np.interp(seen, run.time, run.reference)
    error = run.gain * (wanted - np.interp(seen, run.time, run.position))
    beyond = np.abs(run.duty) >= UNSATURATED * loop.saturation
    # Where the duty is limited, the loop says by how much it is short of the limit's end.
    command = np.where(
        beyond, np.sign(run.duty) * np.maximum(np.abs(error), np.abs(run.duty)), run.duty
    )
    late = command + run.gain * (np.interp(seen - 0.5 * row, run.time, run.reference) - wanted)
    change = np.clip(late, -loop.saturation, loop.saturation) - np.clip(
        command, -loop.saturation, loop.saturation
    )
    return even, np.interp(times, stamps, change * run.supply) * driven
