"""A recording with some signals replaced."""

from collections.abc import Mapping
from typing import Self

import numpy as np
import numpy.typing as npt

from jointid.recording.extra import checked_extra, rows_of_extra
from jointid.recording.samples import Samples
from jointid.recording.signals import SIGNALS, check_signal_name


class Changes(Samples):
    """Methods that return a changed copy of a recording; the recording itself is read-only."""

    def with_velocity(self, velocity: npt.ArrayLike | None = None) -> Self:
        """Return the recording with this velocity [rad/s], marked as derived. Default: derived from the position."""
        return type(self)(
            **{**self._fields(), "velocity": velocity, "velocity_derived": velocity is not None}
        )

    def with_signals(
        self,
        *,
        rows: slice | npt.NDArray[np.generic] | None = None,
        extra: Mapping[str, npt.ArrayLike] | None = None,
        **signals: npt.ArrayLike | None,
    ) -> Self:
        """Return the recording with some signals replaced. All other signals and extra signals are unchanged.

        Parameters
        ----------
        rows : slice or ndarray, optional
            Samples to keep: a slice, a mask or indices. Default: all.
        extra : mapping of str to array_like, each of shape (n,), optional
            Extra signals to add or to replace. Default: none.
        **signals : array_like of shape (n,), or None
            New values of signals, by the argument names of `Recording`. None removes an optional signal.

        Returns
        -------
        Recording
            Recording without a simulation's true signals. A new velocity does not change `velocity_derived`.

        Raises
        ------
        InputError
            There is no such signal, or the values are invalid in a recording.

        Examples
        --------
        >>> slower = recording.with_signals(extra={"motor_6": recording.position * 2.0})
        """
        for name in signals:
            check_signal_name(name, "signals")
        fields = {**self._fields(), **signals, "extra": {**self.extra, **(extra or {})}}
        if rows is not None:
            present = [name for name in SIGNALS if fields[name] is not None]
            fields.update({name: np.asarray(fields[name])[rows] for name in present})
            fields["extra"] = rows_of_extra(checked_extra(fields["extra"]), rows)
        return type(self)(**fields)
