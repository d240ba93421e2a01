"""A session's frame log, read again: the recording that its frames hold."""

from __future__ import annotations

import math
import os
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from jointid.base.errors import InputError
from jointid.hardware.can.frame_log import logged_frames
from jointid.hardware.elmo.logged_cycles import CycleReader, LoggedCycle
from jointid.hardware.elmo.options import ElmoOptions
from jointid.hardware.elmo.timing import command_latency
from jointid.hardware.session.cycle import held_torque, target_at
from jointid.hardware.session.metadata import elmo_options_of
from jointid.joint.joint import Joint
from jointid.recording.readers.loading import load
from jointid.recording.recording import Recording
from jointid.simulation.trajectory import Trajectory

FloatArray = npt.NDArray[np.float64]
_LEAST = 8  # samples of a recording


def replay(
    log: str | os.PathLike[str],
    joint: Joint,
    options: ElmoOptions | None = None,
    *,
    recording: str | os.PathLike[str] | Recording | None = None,
    period: float | None = None,
    cycles_before: int | None = None,
    stamped: bool | None = None,
    trajectory: Trajectory | None = None,
) -> Recording:
    """Return what the frames of a session say, by the same decoder that the session used.

    With the session's own options it is the session's recording to within the log's rounding (1 ns).
    Other options may be tried: the scaling of a sensor, or a position offset that was wrong.

    Parameters
    ----------
    log : path-like
        The session's ``.log``, or one of another program's: candump's, ``.asc`` or ``.blf``; from
        before the first motion until the end.
    joint : Joint
        With torque constant.
    options : ElmoOptions, optional
        How the drive was wired. Default: what the recording says; without one `ElmoOptions()`.
    recording : path-like or Recording, optional
        The session's, whole or torn: it says period, reference, which cycles are the run, and
        how samples are stamped. Default: the ``.csv`` beside the log; none if there is none.
    period : float, optional
        Of the session [s]. Default: the recording's.
    cycles_before : int, optional
        Cycles that were commanded on the way to the start. Default: the recording's; without one 0, and the way
        to the start is in what is returned.
    stamped : bool, optional
        Frames bear the time of their arrival to the microsecond, as SocketCAN's do. Default: the
        recording's; without one True.
    trajectory : Trajectory, optional
        Gives the reference. Default: the recording's reference, and no more samples than it has.

    Returns
    -------
    Recording
        time, position, sensor, torque; reference and current where they are known.

    Raises
    ------
    InputError
        The log cannot be read; frames are missing; the period is not known.
    """
    file = Path(log)
    if joint.torque_constant is None:
        raise InputError(
            f"{file}: the joint has no torque_constant, so its commands are no torques"
        )
    session = _session(file, recording)
    said: dict[str, Any] = {} if session is None else dict(session.metadata)
    wired = elmo_options_of(said, str(file)) if options is None else options
    drive = said["drive"] if isinstance(said.get("drive"), Mapping) else {}
    period = said.get("control_period") if period is None else period
    if not isinstance(period, int | float) or not 0.0 < period < math.inf:
        raise InputError(
            f"{file}: the session's period is {period}; give period=, or the session's .csv with recording="
        )
    before = said.get("cycles_before", 0) if cycles_before is None else cycles_before
    if not isinstance(before, int) or before < 0:
        raise InputError(f"{file}: cycles_before is {before!r}; 0 or a positive number is expected")
    reader = CycleReader(
        joint,
        wired,
        stamped=drive.get("stamped_frames", True) if stamped is None else stamped,
        rated_current=drive.get("continuous_current", math.nan),
    )
    try:
        reader.read(logged_frames(file))
    except InputError as error:
        sentence = str(error)
        named = sentence if str(file) in sentence else f"{file}: {sentence}"
        raise InputError(named) from error
    cycles = reader.cycles[before:]
    _check_count(file, len(cycles), before, session)
    if session is not None and (trajectory is None or "truncated" not in said):
        cycles = cycles[: len(session.time)]
    told = joint.torque_constant * joint.gear_ratio * _column(reader.cycles, "told")
    told = np.concatenate(([0.0], told))[before : before + len(cycles) + 1]
    taken, current = _column(cycles, "taken"), _column(cycles, "current")
    due = period * np.arange(len(cycles))
    shift = np.round(taken - taken[0] - due, 9)
    acted = _column(cycles, "acted") - taken + command_latency(wired)
    reference = None if session is None else session.reference
    if trajectory is not None:
        wanted = trajectory.sample(due)
        reference = target_at(*wanted, shift)
    return Recording(
        time=due + shift,
        position=_column(cycles, "position"),
        torque=held_torque(told[:-1], told[1:], acted, period),
        sensor=None if wired.torque is None else _column(cycles, "reading"),
        reference=reference,
        current=None if np.isnan(current).any() else current,
        torque_hold="zoh",
        name=file.stem,
        metadata={**said, "replayed": file.name},
    )


def _session(file: Path, recording: str | os.PathLike[str] | Recording | None) -> Recording | None:
    """What the session recorded, where that is known."""
    if isinstance(recording, Recording):
        return recording
    beside = file.with_suffix(".csv")
    if recording is None and not beside.exists():
        return None
    return load(beside if recording is None else recording)


def _check_count(file: Path, found: int, before: int, session: Recording | None) -> None:
    """See that the cycles of the run are all there."""
    if session is not None and found < len(session.time):
        raise InputError(
            f"{file}: {found} cycles of the run, the recording has {len(session.time)}; frames are missing "
            "from the log"
        )
    if found < _LEAST:
        raise InputError(
            f"{file}: {max(0, found)} cycles behind the first {before}; at least {_LEAST} are expected"
        )


def _column(cycles: Sequence[LoggedCycle], name: str) -> FloatArray:
    return np.array([getattr(cycle, name) for cycle in cycles], dtype=np.float64)
