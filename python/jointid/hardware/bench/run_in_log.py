"""Search for a session's run in a frame log: its positions must be those of the recording."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import numpy.typing as npt

from jointid.base.errors import InputError
from jointid.hardware.session.cycle import LoggedCycle
from jointid.recording.recording import Recording

_FARTHEST = 1000  # largest difference from the expected start, in cycles
_SHARE = 1e-6  # share of the motion by which positions may differ
_LEAST = 1e-9  # [rad]

FloatArray = npt.NDArray[np.float64]


class LoggedPositions:
    """Positions of all cycles in a frame log.

    Parameters
    ----------
    every : sequence of LoggedCycle
    """

    def __init__(self, every: Sequence[LoggedCycle]) -> None:
        self._lost = np.array([bool(cycle.lost) for cycle in every], dtype=np.bool_)
        self._position = np.array([cycle.position for cycle in every], dtype=np.float64)

    def kept(self, before: int) -> npt.NDArray[np.intp]:
        """Return the cycles that a session keeps: those with a sample, except the first after a cycle without one."""
        waited = np.concatenate([[False], self._lost[:-1]])
        waited[before : before + 1] = False
        return np.flatnonzero(~self._lost[before:] & ~waited[before:]) + before

    def begin(self, counted: int, session: Recording, *, scaled: bool) -> int | None:
        """Return the number of cycles before the run. If several fit, it is the nearest to the session's number.

        A drive type may decode a command that the session did not count, such as a zero torque of `enable`.

        Parameters
        ----------
        counted : int
        session : Recording
        scaled : bool
            Whether positions may also be shifted and scaled, because the options differ from the session's.

        Returns
        -------
        int or None
            None if no cycles have the positions of the recording.
        """
        lowest = max(0, counted - _FARTHEST)
        near = sorted(range(lowest, counted + _FARTHEST + 1), key=lambda n: abs(n - counted))
        for fit in (_same, _same_when_scaled) if scaled else (_same,):
            for before in near:
                found = self._position[self.kept(before)[: len(session.position)]]
                if len(found) == len(session.position) and fit(found, session.position):
                    return before
        return None

    def difference(self, before: int, session: Recording) -> InputError:
        """Return the error for a log with positions that differ from the recording's."""
        found = self._position[self.kept(before)[: len(session.position)]]
        row = int(np.argmax(~(np.abs(found - session.position) <= _tolerance(session.position))))
        return InputError(
            f"no first cycle of the log fits the recording: row {row} has the position "
            f"{session.position[row]:.9g} rad, but the frames have {found[row]:.9g} rad; is "
            "this the log of this session and joint?",
            remedy=f"state cycles_before={before} to use the frames without this comparison",
        )


def _same(found: FloatArray, recorded: FloatArray) -> bool:
    return bool((np.abs(found - recorded) <= _tolerance(recorded)).all())


def _same_when_scaled(found: FloatArray, recorded: FloatArray) -> bool:
    moved, wanted = found - found.mean(), recorded - recorded.mean()
    size = moved @ moved
    scale = moved @ wanted / size if size > 0.0 else 0.0
    return bool((np.abs(scale * moved - wanted) <= _tolerance(recorded)).all())


def _tolerance(recorded: FloatArray) -> float:
    return _LEAST + _SHARE * float(np.ptp(recorded))
