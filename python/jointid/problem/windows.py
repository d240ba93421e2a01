"""The windows of integration that a call requests, as options of the core."""

from __future__ import annotations

import numbers
from collections.abc import Sequence

from jointid import _core
from jointid.base.errors import InputError
from jointid.joint.checks import finite_number
from jointid.recording.recording import Recording

Windows = int | float | str | _core.WindowOptions | None

_WINDOWS_EXPECTED = (
    "a number of windows (a whole number), their duration in seconds, or cumulative is expected"
)

_LARGEST = 1e15  # number or duration of windows that the core can represent


def checked_windows(windows: Windows) -> Windows:
    """Return the argument `windows` of a call; refuse values that are invalid for every recording."""
    if windows is None or isinstance(windows, _core.WindowOptions) or windows == "cumulative":
        return windows
    if isinstance(windows, bool) or not isinstance(windows, numbers.Real):
        raise InputError(_WINDOWS_EXPECTED, argument="windows", value=windows)
    if not 0.0 < finite_number("", "windows", windows) < _LARGEST:
        raise InputError(
            f"a value above 0 and below {_LARGEST:g} is expected", argument="windows", value=windows
        )
    return windows


def window_options(windows: Windows, recordings: Sequence[Recording]) -> _core.WindowOptions:
    """Convert windows from `checked_windows` to options of the core.

    Parameters
    ----------
    windows : int, float, "cumulative", WindowOptions or None
        An int is the number of windows, a float their duration [s].
    recordings : sequence of Recording
        Their shortest sample period is the duration of cumulative windows.
    """
    if windows is None:
        return _core.WindowOptions()
    if isinstance(windows, _core.WindowOptions):
        return windows
    if isinstance(windows, str):
        period = min(recording.sample_period for recording in recordings)
        return _core.WindowOptions(duration=period, cumulative=True)
    if isinstance(windows, numbers.Integral):
        return _core.WindowOptions(count=int(windows))
    return _core.WindowOptions(duration=float(windows))
