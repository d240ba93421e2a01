"""Replay of a session's frame log: the recording is computed from its frames."""

from __future__ import annotations

import math
import os
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from jointid.base.errors import InputError
from jointid.hardware.bench.bench import drive_type
from jointid.hardware.bench.drive_types import DEFAULT_TYPE
from jointid.hardware.bench.run_in_log import LoggedPositions
from jointid.hardware.can.frame_log import logged_frames
from jointid.hardware.session.cycle import LoggedCycle, capped, held_torque, target_at
from jointid.joint.joint import Joint
from jointid.recording.readers.loading import load
from jointid.recording.recording import Recording
from jointid.simulation.trajectory import Trajectory

FloatArray = npt.NDArray[np.float64]
_LEAST = 8  # fewest samples of a recording
_MOST = 10**9  # largest number of cycles before them


def replay(
    log: str | os.PathLike[str],
    joint: Joint,
    options: Any = None,
    *,
    drive: str | None = None,
    recording: str | os.PathLike[str] | Recording | None = None,
    period: float | None = None,
    cycles_before: int | None = None,
    stamped: bool | None = None,
    trajectory: Trajectory | None = None,
) -> Recording:
    """Decode the frames of a session into a recording.

    The frames are decoded as in the session. With the session's options, the result equals the session's recording,
    except for the log's rounding of times (1 ns). Use other options to correct a sensor's scale or a position offset.

    Parameters
    ----------
    log : path-like
        Name of the session's ``.log``, of a log of candump, or of an ``.asc`` or ``.blf`` file. The log begins before
        the first motion and contains the complete session.
    joint : Joint
        Joint of the session. Its torque constant is needed if the commands are currents.
    options : object, optional
        Options of the drive, as its drive type defines them. Default: the options in the recording.
    drive : str, optional
        Name of the drive's type. Default: the type in the recording; without a recording, the default type of a joint
        file.
    recording : path-like or Recording, optional
        The session's recording, complete or truncated. It contains the period, the reference, the cycles of the run,
        and the kind of time stamps. Default: the ``.csv`` with the log's name, if it exists.
    period : float, optional
        Period of the session [s]. Default: the recording's.
    cycles_before : int, optional
        Number of control cycles before the run. Default: the number that a comparison with the recording's positions
        gives. Without a recording it is 0, and the result includes the motion to the start.
    stamped : bool, optional
        Whether frames have arrival times in microseconds, as with SocketCAN. Default: as in the recording; True
        without a recording.
    trajectory : Trajectory, optional
        Trajectory of the reference. Default: the recording's reference; it also limits the number of samples.

    Returns
    -------
    Recording
        Recording of time, position and torque, and of sensor, reference and current if known.

    Raises
    ------
    InputError
        The log cannot be read, or frames are missing. The frames differ from the recording's positions. The period is
        not known, or the drive's type is not installed.

    Examples
    --------
    >>> bench = jid.hardware.Bench.load("joint.toml")
    >>> again = jid.hardware.replay("runs/initial.log", bench.joint)
    """
    file = Path(log)
    session = _session(file, recording)
    metadata: dict[str, Any] = {} if session is None else dict(session.metadata)
    try:
        name = drive if drive is not None else metadata.get("drive_type", DEFAULT_TYPE)
        adapter = drive_type(name)
        drive_options = adapter.recorded_options(metadata) if options is None else options
        period = _period(metadata.get("control_period") if period is None else period)
        before = metadata.get("cycles_before", 0) if cycles_before is None else cycles_before
        if not isinstance(before, int) or not 0 <= before <= _MOST:
            raise InputError("0 or more is expected", argument="cycles_before", value=before)
        recorded = metadata.get("drive")
        identity = dict(recorded) if isinstance(recorded, Mapping) else {}
        if stamped is not None:
            identity["stamped_frames"] = stamped
        every = adapter.decode(logged_frames(file), joint, drive_options, identity)
        positions = LoggedPositions(every)
        found: int | None = before
        if session is not None and cycles_before is None:
            found = positions.begin(before, session, scaled=options is not None)
        begin = before if found is None else found
        kept = positions.kept(begin)
        late = _late(every, kept, begin, session)
        _check_count(len(kept), begin, session)
        if session is not None and found is None:
            raise positions.difference(begin, session)
    except InputError as error:
        raise error.at(str(file)) from error
    if session is not None and (trajectory is None or "truncated" not in metadata):
        kept, late = kept[: len(session.time)], late[: len(session.time)]
    cycles = [every[k] for k in kept]
    torque = np.concatenate(([0.0], _column(every, "torque")))
    taken, current = _column(cycles, "taken"), _column(cycles, "current")
    due = period * (np.arange(len(cycles)) + np.cumsum(np.floor(late)))
    shift = np.round(taken - taken[0] - due + due[0], 9)
    acted = _column(cycles, "acted") - taken + adapter.command_latency(drive_options)
    sensor = _column(cycles, "reading")
    reference = None if session is None else session.reference
    if trajectory is not None:
        position, velocity, acceleration = trajectory.sample(due)
        reference = target_at(position, velocity, acceleration, capped(shift, period))
    fields = dict[str, Any](
        time=due + shift,
        position=_column(cycles, "position"),
        torque=held_torque(torque[kept], torque[kept + 1], acted, period),
        sensor=sensor if sensor.any() else None,  # all 0: there is no sensor
        reference=reference,
        current=None if np.isnan(current).any() else current,
        late=late if late.any() else None,
        torque_hold="zoh",
        name=file.stem,
        metadata={**metadata, "replayed": file.name},
    )
    try:
        return Recording(**fields)
    except InputError as error:  # e.g. for an impossible period
        raise error.at(str(file)) from None


def _session(file: Path, recording: str | os.PathLike[str] | Recording | None) -> Recording | None:
    """Return the recording of the session, if it is known."""
    if isinstance(recording, Recording):
        return recording
    beside = file.with_suffix(".csv")
    if recording is None and not beside.exists():
        return None
    return load(beside if recording is None else recording)


def _period(period: Any) -> float:
    if not isinstance(period, int | float) or not 0.0 < period < math.inf:
        raise InputError(
            "the session's period is not known; pass the period, or the session's recording",
            argument="period",
            value=period,
        )
    return period


def _check_count(found: int, before: int, session: Recording | None) -> None:
    """Check that all cycles of the run are in the log."""
    if session is not None and found < len(session.time):
        raise InputError(
            f"the log has {found} cycles of the run, but the recording has {len(session.time)}; frames "
            "are missing from the log"
        )
    if found < _LEAST:
        raise InputError(
            f"the log has {max(0, found)} cycles after the first {before}; at least {_LEAST} are expected"
        )


def _late(
    every: Sequence[LoggedCycle],
    kept: npt.NDArray[np.intp],
    before: int,
    session: Recording | None,
) -> FloatArray:
    """Return `late` of each row: as recorded; without a recording, the number of cycles without a sample."""
    late = np.diff(kept, prepend=before - 1).astype(np.float64) - 1.0
    if session is None:
        return late
    known = len(session.time)
    recorded = np.zeros(known) if session.late is None else session.late
    if (recorded < 0.0).any():
        row = int(np.argmax(recorded < 0.0))
        raise InputError(
            f"signal late is {recorded[row]:g} in row {row} of the recording; 0 or more is expected"
        )
    if late[:known].sum() > np.floor(recorded).sum():
        raise InputError(next(cycle.lost for cycle in every[before:] if cycle.lost))
    late[:known] = recorded[: len(late)]
    return late


def _column(cycles: Sequence[LoggedCycle], name: str) -> FloatArray:
    return np.array([getattr(cycle, name) for cycle in cycles], dtype=np.float64)
