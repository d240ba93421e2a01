"""A recording with some signals replaced."""

from collections.abc import Mapping
from typing import Self

import numpy as np
import numpy.typing as npt

from jointid.recording.extra import checked_extra, rows_of_extra
from jointid.recording.samples import Samples
from jointid.recording.signals import SIGNALS, check_signal_name


class Changes(Samples):
    """What a recording does instead of being changed: it returns another one, or refuses."""

    def with_velocity(self, velocity: npt.ArrayLike | None = None) -> Self:
        """Return the recording with another velocity [rad/s], which counts as derived; default: derive it."""
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
        """Return the recording with some signals replaced; what is not named stays, also extra ones.

        Parameters
        ----------
        rows : slice or ndarray, optional
            Samples to keep: a slice, a mask or indices. Default: all.
        extra : mapping of str to array_like, each of shape (n,), optional
            Extra signals to add or to replace. Default: none.
        **signals : array_like of shape (n,), or None
            By the names of the constructor's arguments; None takes an optional one away.

        Returns
        -------
        Recording
            As measured: true signals of a simulation are left out. A given velocity counts as before as
            derived or not.

        Raises
        ------
        InputError
            No such signal, or values that no recording can hold.

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
