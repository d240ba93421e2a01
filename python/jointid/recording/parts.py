"""Parts of a recording: a time interval, consecutive parts, or one signal by name."""

from collections.abc import Sequence
from typing import Any, Self, overload

import numpy as np

from jointid.base.errors import InputError
from jointid.recording.changes import Changes
from jointid.recording.extra import rows_of_extra
from jointid.recording.signals import FloatArray, closest


class Parts(Changes):
    """Methods that return a part of a recording."""

    __iter__ = None  # `for` over a recording is ambiguous: samples or names

    @overload
    def __getitem__(self, wanted: str) -> FloatArray: ...

    @overload
    def __getitem__(self, wanted: slice) -> Self: ...

    def __getitem__(self, wanted: str | slice) -> Self | FloatArray:
        """Return a signal by its name, or the samples between two times [s], both included.

        Examples
        --------
        >>> later = recording[2.0:]
        >>> later.duration < recording.duration
        True
        >>> recording["torque"].shape == recording.time.shape
        True
        """
        if isinstance(wanted, slice):
            if wanted.step is not None:
                raise InputError(
                    "a slice of times has no step: write [start:stop]; `resample` changes the sample period",
                    argument="step",
                    value=wanted.step,
                )
            return self.crop(wanted.start, wanted.stop)
        if not isinstance(wanted, str):
            raise InputError(
                "a signal's name or times [s] are expected",
                argument="recording[...]",
                value=wanted,
                remedy=('recording["torque"]', "recording[1.0:2.0]"),
            )
        present = {**{name: getattr(self, name) for name in self.signals}, **self.extra}
        if wanted not in present:
            close = closest(wanted, present)
            raise InputError(
                "the recording has no such signal; "
                + (f"did you mean {close!r}?" if close else f"it has {', '.join(present)}"),
                argument="recording[...]",
                value=wanted,
            )
        return np.asarray(present[wanted])

    def crop(self, start: float | None = None, stop: float | None = None) -> Self:
        """Return the samples from one time to another.

        Parameters
        ----------
        start, stop : float, optional
            First and last time on the recording's clock [s], both included. Default: the first and last sample.

        Returns
        -------
        Recording
            Recording of these samples. Time stamps and velocities are unchanged, derived velocities too.

        Raises
        ------
        InputError
            The interval contains fewer than 8 samples, or `start` or `stop` is not a number.
        """
        from jointid.recording.slicing import slice_between

        return self._part(slice_between(self.time, start, stop))

    def split(
        self, parts: int | None = None, *, at: Sequence[float] | None = None
    ) -> tuple[Self, ...]:
        """Return the recording in consecutive parts that share no sample.

        Parameters
        ----------
        parts : int, optional
            Number of parts. The lengths of the parts differ by at most one sample.
        at : sequence of float, optional
            Increasing times at which a new part begins, on the recording's clock [s]; instead of `parts`. A sample
            at such a time belongs to the new part.

        Returns
        -------
        tuple of Recording
            Parts with the names ``"NAME 1/3"``, ... Time stamps and velocities are unchanged, derived velocities
            too.

        Raises
        ------
        InputError
            Neither or both arguments are set, a time is outside the recording, or a part would have fewer
            than 8 samples.
        """
        from jointid.recording.slicing import slices_of

        slices = slices_of(self.time, parts, at)
        return tuple(
            self._part(part, name=f"{self.name} {number}/{len(slices)}".lstrip())
            for number, part in enumerate(slices, start=1)
        )

    def _part(self, kept: slice, **changes: Any) -> Self:
        fields = self._fields()
        fields.update({signal: fields[signal][kept] for signal in self.signals}, **changes)
        fields["extra"] = rows_of_extra(self.extra, kept)
        return type(self)(**fields)
