"""Outcome of a session: reason of the stop, state at the end, and recording."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import numpy as np

from jointid.hardware.session.control_loop import Follower
from jointid.hardware.session.drive import DriveEnd, DriveFaultError
from jointid.hardware.session.stop import LimitError, Stop
from jointid.recording.recording import Recording

_FEWEST = 8  # samples of a recording


def stop_of(
    cause: Exception | KeyboardInterrupt,
    moment: float,
    follower: Follower | None,
    end: DriveEnd | None,
) -> Stop:
    """Return the stop that an exception stands for.

    Parameters
    ----------
    cause : Exception or KeyboardInterrupt
    moment : float
        Time on the drive's clock [s].
    follower : Follower or None
        Follower, which knows the phase; None if the session did not get beyond its checks.
    end : DriveEnd or None
        Report of the drive when it was switched off.
    """
    limit, message = "error", f"{type(cause).__name__}: {cause}"
    if isinstance(cause, LimitError):
        limit, message = cause.limit, str(cause)
    elif isinstance(cause, DriveFaultError):
        limit, message = cause.kind, str(cause)
    elif isinstance(cause, KeyboardInterrupt):
        limit, message = "user", "interrupted from the keyboard"
    end = end if end is not None else DriveEnd()
    if end.failure:
        message = f"{message}; the drive reports: {end.failure}"
    if end.motor_off is False:
        message = f"{message}; THE DRIVE DID NOT CONFIRM THAT THE MOTOR IS OFF"
    return Stop(
        limit=limit,
        phase="check" if follower is None else follower.phase,
        time=0.0 if follower is None else moment - follower.began,
        moment=moment,
        message=message,
        measured=_finite(getattr(cause, "measured", None)),
        allowed=_finite(getattr(cause, "allowed", None)),
        motor_off=end.motor_off,
    )


def ending_of(
    follower: Follower | None, end: DriveEnd | None, stop: Stop | None, not_granted: Sequence[str]
) -> dict[str, Any]:
    """Return the metadata that is known at the end of a session, in JSON types."""
    late = np.array(() if follower is None else follower.late)
    timing = None
    if follower is not None and len(late):
        lateness = follower.lateness
        timing = {
            "cycles": len(late),
            "missed": int((late > 0.0).sum()),
            "slack_least": float(-late.max()),
            "slack_median": float(-np.median(late)),
            "lost": lateness.lost,
            "skipped": lateness.skipped,
            "most_in_row": lateness.most_in_row,
            "woke_late_median": float(np.median(follower.woke)),
            "woke_late_most": float(max(follower.woke)),
        }
    measured = follower is not None and follower.velocity_measured
    return {
        **({"velocity_measured": True} if measured else {}),
        "cycles_before": 0 if follower is None else follower.cycles_before,
        "stop": None if stop is None else str(stop),
        "stopped": None if stop is None else stop.to_dict(),
        "real_time": list(not_granted),
        "motor_off": None if end is None else end.motor_off,
        "timing": timing,
    }


def recording_of(
    follower: Follower | None, name: str, metadata: dict[str, Any]
) -> Recording | None:
    """Return the recording of the run; None if there are too few samples."""
    if follower is None or len(follower.rows) < _FEWEST:
        return None
    time, position, torque, sensor, reference, current, late = map(
        np.array, zip(*follower.rows, strict=True)
    )
    return Recording(
        time=time,
        position=position,
        torque=torque,
        sensor=sensor if sensor.any() else None,  # all 0: there is no sensor
        reference=reference,
        current=None if np.isnan(current).any() else current,
        late=late if late.any() else None,  # all 0: no sample was late
        torque_hold="zoh",
        name=name,
        metadata=metadata,
    )


def _finite(value: Any) -> float | None:
    """Return a number that a recording can keep; None if it is not finite. The message contains it then."""
    number = math.nan if value is None else float(value)
    return number if math.isfinite(number) else None
