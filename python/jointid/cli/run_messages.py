"""Messages at the end of `run`: state of the motor and of the recording, in words or as JSON."""

from __future__ import annotations

import json
import sys
from pathlib import Path
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from jointid.commissioning import Commissioning

REFUSED, STOPPED, DONE = "refused", "stopped", "done"
_MOTOR = {
    True: "the drive confirmed that the motor is off",
    False: "THE DRIVE DID NOT CONFIRM THAT THE MOTOR IS OFF",
    None: "this drive does not report whether its motor is off",
}
_NEVER_ON = "the motor has not been on"


def motor_and_recording(motor_off: bool | None, output: Path | None) -> str:
    """Return the line at the end of every run in which the motor was on.

    Parameters
    ----------
    motor_off : bool or None
        As in a `Stop`.
    output : Path or None
        Folder of the recordings.
    """
    return f"{_MOTOR[motor_off]}; {_recorded(output)}"


def refused(command: str, reason: str, message: str, *, as_json: bool) -> None:
    """Print that a session was not started.

    Parameters
    ----------
    command : str
        Name of the command: "run", …
    reason : str
        Reason as a name for programs, e.g. "certificate".
    message : str
    as_json : bool
        Whether to also print JSON.
    """
    print(f"jointid {command}: {message}; {_NEVER_ON}", file=sys.stderr)
    if as_json:
        _print(REFUSED, reason, message, motor_off=None, output=None)


def stopped(
    reason: str, message: str, motor_off: bool | None, output: Path | None, *, as_json: bool
) -> None:
    """Print that a session was stopped: the reason, and the state of motor and recording.

    Parameters
    ----------
    reason : str
        Name of the limit, as in a `Stop`.
    message : str
    motor_off : bool or None
    output : Path or None
    as_json : bool
        Whether to also print JSON.
    """
    print(f"jointid run: {message}", file=sys.stderr)
    print(motor_and_recording(motor_off, output), file=sys.stderr)
    if as_json:
        _print(STOPPED, reason, message, motor_off=motor_off, output=output)


def document(result: Commissioning, output: Path | None) -> dict[str, Any]:
    """Return the outcome of a run that was not stopped, in JSON types."""
    recordings = result.recordings()
    found = result.to_dict()
    blocked = result.blocked
    return {
        "status": REFUSED if blocked else DONE,
        "reason": blocked.code if blocked else None,
        "message": blocked.cause if blocked else None,
        "motor_off": motor_off(result),
        "recording": _files(output),
        "output": None if output is None else str(output),
        **found,
        "motion_warning": result.motion_warning,
        "warnings": [
            {"code": each.code, "severity": each.severity, "message": each.message}
            for estimate in result.estimates[-1:]
            for each in estimate.warnings
        ],
        "timing": {name: each.metadata.get("timing") for name, each in recordings.items()},
    }


def motor_off(result: Commissioning) -> bool | None:
    """Return the drive's report on its motor after the last run."""
    *_, last = result.recordings().values()
    said: bool | None = last.metadata.get("motor_off")
    return said


def motor_off_before(error: BaseException) -> tuple[bool, bool | None]:
    """Return whether an exception of `commission` came after recorded runs, and the motor's state after the last one.

    Parameters
    ----------
    error : BaseException
    """
    recordings = vars(error).get("recordings") or {}
    last = [*recordings.values()][-1:]
    return bool(last), last[0].metadata.get("motor_off") if last else None


def _recorded(output: Path | None) -> str:
    if output is None:
        return "the recording was not kept: no --output was given"
    files = _files(output)
    return f"recorded: {', '.join(files)}" if files else f"nothing was recorded in {output}"


def _files(output: Path | None) -> list[str]:
    """Return the recordings of a folder, oldest first."""
    if output is None or not output.is_dir():
        return []
    found = sorted(output.glob("*.csv"), key=lambda path: path.stat().st_mtime_ns)
    return [str(path) for path in found]


def _print(
    status: str, reason: str, message: str, *, motor_off: bool | None, output: Path | None
) -> None:
    found = {
        "status": status,
        "reason": reason,
        "message": message,
        "motor_off": motor_off,
        "recording": _files(output),
    }
    print(json.dumps(found, indent=1, ensure_ascii=False))
