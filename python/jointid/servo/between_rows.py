"""Voltage between rows: a log has the duty at its rows, and the position loop gives its course between them.

If a command is interpolated between rows, so is the duty. If a command is held until the next row, the duty jumps
there. A held command is half a row late on average, because the loop responds to the previous command. A servo may also
be between these cases: its command is refreshed several times per row, or the stamps of the log are not those of the
loop. The torque balance decides between them, with the voltage as even + held · late.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from jointid.joint.voltage_drive import VoltageDrive
from jointid.servo.signals import ServoSignals

Array = NDArray[np.float64]

UNSATURATED = 0.98
"""A duty above this share of the saturation counts as limited. Then it does not show the position error."""


def voltages(
    run: ServoSignals, drive: VoltageDrive | None, times: Array, lead: float
) -> tuple[Array, Array]:
    """Return the voltage [V] of an interpolated command, and the addition for a held one, at `times` [s].

    Without a drive that has a position loop, the addition is 0. `lead` is the time by which a row's position is older
    than its duty [s].
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
    # If the duty is limited, the loop gives its distance from the limit.
    command = np.where(
        beyond, np.sign(run.duty) * np.maximum(np.abs(error), np.abs(run.duty)), run.duty
    )
    late = command + run.gain * (np.interp(seen - 0.5 * row, run.time, run.reference) - wanted)
    change = np.clip(late, -loop.saturation, loop.saturation) - np.clip(
        command, -loop.saturation, loop.saturation
    )
    return even, np.interp(times, stamps, change * run.supply) * driven
