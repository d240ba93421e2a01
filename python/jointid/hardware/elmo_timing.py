"""When an Elmo drive samples and when it acts on a command, reckoned from its frames."""

from __future__ import annotations

from jointid.hardware.canopen_frames import bits_on_wire
from jointid.hardware.elmo_options import ElmoOptions

POSITION_LENGTH = 6
"""Bytes of the position's frame, as `elmo_setup.map_position` has it."""


def sampled_at(bitrate: float, sent: float, came: float | None, *, asked: bool) -> float:
    """When drive and converter sampled [s]: when the SYNC had arrived, which other frames may hold up.

    Parameters
    ----------
    bitrate : float
        [bit/s]
    sent : float
        When the SYNC was sent [s].
    came : float or None
        When the position came [s]; None where the bus does not tell it to the microsecond.
    asked : bool
        The analog input was asked for; the question went before the position.
    """
    if came is None:
        return sent + bits_on_wire(0) / bitrate
    behind = bits_on_wire(POSITION_LENGTH) + (bits_on_wire(4) if asked else 0)
    return came - behind / bitrate


def command_latency(options: ElmoOptions) -> float:
    """From sending a command until the drive acts on it [s]."""
    return bits_on_wire(8) / options.bitrate + options.execution_delay
