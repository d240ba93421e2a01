"""A recording: the signals of one joint over time, measured or simulated."""

from __future__ import annotations  # so that `help` shows the name array_like

import functools
import os
from collections.abc import Collection, Mapping
from typing import TYPE_CHECKING, Any, Self

import numpy.typing as npt

from jointid.base.errors import InputError
from jointid.recording.attributes import check_attributes, json_mapping
from jointid.recording.extra import checked_extra
from jointid.recording.identity import fingerprint_of, line_of, same_fields
from jointid.recording.parts import Parts
from jointid.recording.signals import (
    SIGNALS,
    check_signals,
    signal_array,
)

if TYPE_CHECKING:
    import pandas as pd


class Recording(Parts):
    """The signals of one joint over time, in SI units, read-only.

    Values are on the output (link) side of the gear, except motor torque and current. For a prismatic joint,
    radians are metres, and newton metres are newtons.

    Parameters
    ----------
    time : array_like, shape (n,)
        Time stamps [s], strictly increasing, not necessarily uniform; n is at least 8.
    position : array_like, shape (n,)
        Joint angle [rad] or travel [m].
    velocity : array_like, shape (n,), optional
        Velocity [rad/s] or [m/s]. Default: derived from the position, never across a gap (`velocity_derived` is
        then True). The derivative is a second-order difference on the true time stamps. If its noise is too large,
        local cubics over 5 to 101 samples replace it. Noise and motion determine this number. A single sample
        between two gaps has the velocity 0; no window includes this sample.
    torque : array_like, shape (n,), optional
        Torque of the actuator at the output [N·m], or force [N]: the command, or the motor's measured torque.
    sensor : array_like, shape (n,), optional
        Raw reading of the joint's torque sensor.
    reference : array_like, shape (n,), optional
        Desired position [rad] or [m].
    link_position : array_like, shape (n,), optional
        Position behind the gear, from a second encoder [rad] or [m].
    temperature : array_like, shape (n,), optional
        Temperature [°C].
    motor_torque : array_like, shape (n,), optional
        Torque on the motor's side of the gear [N·m].
    current : array_like, shape (n,), optional
        Motor current [A].
    late : array_like, shape (n,), optional
        Number of session cycles without a sample before this row. A command that the drive does not confirm adds
        0.5. Identification leaves out intervals with a value above 0. Default: 0 throughout.
    extra : mapping of str to array_like, each of shape (n,), optional
        More signals by name, e.g. another joint's velocity or the torque of a model. ``Model.terms`` defines their
        effect. Between samples, extra signals are interpolated linearly. Default: none.
    kind : {"revolute", "prismatic"}
        Default ``"revolute"``.
    torque_hold : {"zoh", "linear"}, optional
        Torque between samples: held ("zoh") or linear ("linear"). Default: not known.
    velocity_derived : bool
        Whether `velocity` was derived from the position. Default False.
    name : str
        Default ``""``.
    metadata : mapping of str to JSON value, optional
        Default: empty.
    truth : mapping of str to JSON value, optional
        True parameters of a simulated recording. Default: not known.

    Raises
    ------
    InputError
        A signal is not one-dimensional, is not finite, or has a wrong length. Time does not strictly increase, or
        an option has an unknown value.

    Examples
    --------
    >>> time = np.arange(1000) / 500
    >>> run = jid.Recording(time=time, position=np.sin(time), torque=np.cos(time), name="bench")
    >>> len(run[0.5:1.0]), run.velocity_derived
    (251, True)
    """

    def __init__(
        self,
        *,
        time: npt.ArrayLike,
        position: npt.ArrayLike,
        velocity: npt.ArrayLike | None = None,
        torque: npt.ArrayLike | None = None,
        sensor: npt.ArrayLike | None = None,
        reference: npt.ArrayLike | None = None,
        link_position: npt.ArrayLike | None = None,
        temperature: npt.ArrayLike | None = None,
        motor_torque: npt.ArrayLike | None = None,
        current: npt.ArrayLike | None = None,
        late: npt.ArrayLike | None = None,
        extra: Mapping[str, npt.ArrayLike] | None = None,
        kind: str = "revolute",
        torque_hold: str | None = None,
        velocity_derived: bool = False,
        name: str = "",
        metadata: Mapping[str, Any] | None = None,
        truth: Mapping[str, Any] | None = None,
    ) -> None:
        check_attributes(kind, torque_hold, name, velocity_derived)
        given = (time, position, velocity, torque, sensor, reference, link_position)
        rest = (temperature, motor_torque, current, late)
        arguments = dict(zip(SIGNALS, (*given, *rest), strict=True))
        for needed in ("time", "position"):
            if arguments[needed] is None:
                raise InputError("a recording needs time and position", argument=needed, value=None)
        arrays = {
            signal: signal_array(signal, values)
            for signal, values in arguments.items()
            if values is not None
        }
        extras = checked_extra(extra)
        check_signals(arrays | {f"extra.{name}": values for name, values in extras.items()})
        # Read-only: attributes are set only here, without __setattr__.
        vars(self).update(dict.fromkeys(SIGNALS), **arrays, extra=extras)
        vars(self).update(
            kind=kind,
            torque_hold=torque_hold,
            velocity_derived=velocity_derived or velocity is None,
            name=name,
            metadata=json_mapping("metadata", metadata or {}),
            truth=None if truth is None else json_mapping("truth", truth),
        )
        if velocity is None:
            vars(self)["velocity"] = self.derived.velocity

    @classmethod
    def from_dataframe(
        cls,
        df: Any,
        *,
        columns: Mapping[str, str | int | None] | None = None,
        units: Mapping[str, str] | None = None,
        scale: Mapping[str, float] | None = None,
        extra: Collection[str] | Mapping[str, str | int] | None = None,
        gear_ratio: float | None = None,
        side: Mapping[str, str] | None = None,
        sample_period: float | None = None,
        kind: str | None = None,
        torque_hold: str | None = None,
    ) -> Self:
        """Return the recording from a data frame (pandas or similar).

        Parameters
        ----------
        df : DataFrame
            Data frame, or another object with `columns` and `df[column]`. Headers have the same meaning as in a
            file. The index is read as a column if it has a name ("time_s"), or contains dates or durations.
        columns, units, scale, extra, gear_ratio, side, sample_period, kind, torque_hold
            Same as in `load`.

        Raises
        ------
        InputError
            Same errors as in `load`. Messages count rows from 0.
        """
        from jointid.recording.contents import read_contents
        from jointid.recording.dataframe import FrameTable
        from jointid.recording.even_rows import as_stated
        from jointid.recording.sides import at_stated_sides, checked_ratio

        table, columns = as_stated(FrameTable(df), sample_period, columns)
        contents = read_contents(
            table,
            columns=columns,
            units=units,
            scale=scale,
            extra=extra,
            kind=kind,
            torque_hold=torque_hold,
        )
        fields = contents.fields()
        if gear_ratio is not None or side:
            ratio = None if gear_ratio is None else checked_ratio(gear_ratio)
            fields = at_stated_sides(fields, ratio, side, place=table.source)
        return cls(**fields)

    @functools.cached_property
    def fingerprint(self) -> str:
        """First 16 hexadecimal digits of the SHA-256 hash of all signals (names and bytes), extra signals included."""
        return fingerprint_of(self)

    def resample(self, *, period: float | None = None, rate: float | None = None) -> Self:
        """Return the recording on a uniform clock.

        `identify` uses the recorded time stamps, because interpolation correlates the noise. Use `resample` for
        methods that need equal time steps, such as spectra and filters.

        After each gap, the clock starts again at the first sample. Gaps remain gaps. Signals are interpolated
        linearly. With ``torque_hold="zoh"``, torque, motor_torque and current keep their last value. Signals are
        not filtered: at a lower rate, noise is aliased.

        Parameters
        ----------
        period : float, optional
            Time between samples [s].
        rate : float, optional
            Samples per second [Hz], instead of `period`.

        Returns
        -------
        Recording
            Derived velocities are interpolated like recorded velocities, and stay marked as derived.
            ``metadata["resampled_from"]`` is the median period before resampling [s].

        Raises
        ------
        InputError
            Neither or both of `period` and `rate` are set, a value is not positive, the result has too few or too
            many samples, or a gap would no longer be recognised.
        """
        from jointid.recording.resampling import resampled

        signals = resampled(self, period, rate)
        metadata = {**self.metadata, "resampled_from": self.sample_period}
        return type(self)(**{**self._fields(), **signals, "metadata": metadata})

    def to_pandas(self) -> pd.DataFrame:
        """Return the recording as a data frame in SI units, one row per sample.

        `Recording.from_dataframe` converts the data frame back to a bit-identical recording.

        Returns
        -------
        DataFrame
            Data frame with the time [s] as index. Columns have the names of the signals, or ``"extra_NAME"`` for an
            extra signal. The frame's `attrs` hold the joint's kind, `torque_hold` and the metadata.

        Raises
        ------
        InputError
            pandas is not installed.

        Examples
        --------
        >>> frame = recording.to_pandas()
        >>> list(frame.columns)
        ['position', 'velocity', 'torque', 'sensor']
        """
        from jointid.recording.dataframe import frame_of

        return frame_of(self)

    def save(self, path: str | os.PathLike[str]) -> None:
        """Write the recording to a file, completely or not at all.

        `load` reads a bit-identical recording from this file.

        Parameters
        ----------
        path : path-like
            File name with ending ``.npz``, ``.csv`` or ``.csv.gz``; an existing file is replaced.

        Raises
        ------
        InputError
            The file name has another ending, or the folder does not exist.
        OSError
            The file cannot be written; an existing file is unchanged.
        """
        from jointid.recording.saving import save_recording

        save_recording(self, path)

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Recording):
            return NotImplemented
        return same_fields(self._fields(), other._fields())

    def __hash__(self) -> int:
        return hash(self.fingerprint)

    def __repr__(self) -> str:
        return line_of(self)

    def _repr_html_(self) -> str:
        from jointid.recording.html import html_facts

        return str(html_facts(self))

    def __reduce__(self) -> tuple[Any, ...]:
        # Use the constructor, because unpickled arrays are writable again.
        return functools.partial(type(self), **self._fields()), ()
