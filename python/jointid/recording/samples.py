"""The samples of a joint's signals, and quantities that follow from them."""

from __future__ import annotations

import functools
from collections.abc import Mapping
from types import MappingProxyType
from typing import Any, NoReturn

import numpy as np

from jointid.recording.derived import DerivedVelocity, derived_velocity
from jointid.recording.extra import unit_of_extra
from jointid.recording.gaps import Gap, find_gaps
from jointid.recording.order_statistics import median
from jointid.recording.signals import (
    SIGNALS,
    FloatArray,
    Kind,
    TorqueHold,
    check_signal_name,
    shown_unit,
)


class Samples:
    """Content of a recording; only the constructor sets the attributes."""

    time: FloatArray
    position: FloatArray
    velocity: FloatArray
    torque: FloatArray | None
    sensor: FloatArray | None
    reference: FloatArray | None
    link_position: FloatArray | None
    temperature: FloatArray | None
    motor_torque: FloatArray | None
    current: FloatArray | None
    late: FloatArray | None
    extra: Mapping[str, FloatArray]
    kind: Kind
    torque_hold: TorqueHold | None
    velocity_derived: bool
    name: str
    metadata: Mapping[str, Any]
    truth: Mapping[str, Any] | None

    @property
    def signals(self) -> tuple[str, ...]:
        """Names of the recorded signals in a fixed order, time first."""
        return tuple(name for name in SIGNALS if getattr(self, name) is not None)

    @functools.cached_property
    def sample_period(self) -> float:
        """Median time between samples [s]."""
        return median(np.diff(self.time))

    @functools.cached_property
    def ranges(self) -> Mapping[str, tuple[float, float]]:
        """Smallest and largest value of each of `signals` by name, in its unit; without extra signals.

        Examples
        --------
        >>> slowest, fastest = recording.ranges["velocity"]
        """
        signals = {name: getattr(self, name) for name in self.signals}
        return MappingProxyType(
            {name: (float(each.min()), float(each.max())) for name, each in signals.items()}
        )

    @property
    def duration(self) -> float:
        """Time from the first sample to the last [s]."""
        return float(self.time[-1]) - float(self.time[0])

    @functools.cached_property
    def gaps(self) -> tuple[Gap, ...]:
        """Intervals longer than 3.5 median sample periods, in order of time."""
        return find_gaps(self.time)

    @functools.cached_property
    def doubtful(self) -> tuple[int, ...]:
        """First sample of each interval that is left out because of `late`."""
        late = () if self.late is None else self.late[1:]
        return tuple(np.flatnonzero(late).tolist())

    @functools.cached_property
    def derived(self) -> DerivedVelocity:
        """Velocity derived from the position, and its noise, also if a velocity is recorded."""
        return derived_velocity(self.time, self.position, self.gaps, self.sample_period)

    def unit(self, signal: str) -> str:
        """Return a signal's unit, e.g. ``"rad/s"``: ``"1"`` for the sensor, ``""`` for an extra signal without unit."""
        if signal in self.extra:
            return unit_of_extra(self.metadata, signal)
        check_signal_name(signal, "signal")
        return shown_unit(signal, self.kind)

    def __len__(self) -> int:
        return len(self.time)

    def _fields(self) -> dict[str, Any]:
        """Return the arguments that build this recording again."""
        fields = {name: getattr(self, name) for name in (*SIGNALS, "kind", "torque_hold", "name")}
        return fields | {
            "extra": dict(self.extra),
            "velocity_derived": self.velocity_derived,
            "metadata": dict(self.metadata),
            "truth": None if self.truth is None else dict(self.truth),
        }

    def __setattr__(self, name: str, value: object) -> NoReturn:
        raise AttributeError(f"a recording is read-only, '{name}' cannot be set")

    def __delattr__(self, name: str) -> NoReturn:
        raise AttributeError(f"a recording is read-only, '{name}' cannot be deleted")
