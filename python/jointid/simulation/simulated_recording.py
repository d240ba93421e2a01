"""A simulated recording: measured and true signals."""

import functools
from collections.abc import Iterator, Mapping
from types import MappingProxyType
from typing import Any, Self

import numpy as np
import numpy.typing as npt

from jointid.base.errors import InputError
from jointid.recording.extra import rows_of_extra
from jointid.recording.recording import Recording
from jointid.recording.signals import FloatArray, signal_array


class Truth(Mapping[str, Any]):
    """True values of a simulation: parameters as a mapping, signals in `signals`.

    Parameters
    ----------
    parameters : mapping of str to float
        True parameter values by name, in SI units.
    signals : mapping of str to ndarray, shape (n,)
        `position` [rad], `velocity` [rad/s], `acceleration` [rad/s²], `friction`, `link_torque` and `motor_torque`
        [N·m], at the recording's samples. `friction` is the friction torque of the drive. `link_torque` is the torque
        at the sensor. `control_velocity` [rad/s] is the velocity that the controller used.

    Examples
    --------
    >>> run = jid.simulate(known, jid.Pd(stiffness=8000.0, damping=400.0), jid.Trajectory.thesis(duration=2.0))
    >>> sorted(run.truth.signals)[:2]
    ['acceleration', 'control_velocity']
    """

    __slots__ = ("_parameters", "signals")

    def __init__(self, parameters: Mapping[str, Any], signals: Mapping[str, npt.ArrayLike]) -> None:
        self._parameters = dict(parameters)
        self.signals = MappingProxyType(
            {name: signal_array(name, values) for name, values in signals.items()}
        )

    def __getitem__(self, name: str) -> Any:
        return self._parameters[name]

    def __iter__(self) -> Iterator[str]:
        return iter(self._parameters)

    def __len__(self) -> int:
        return len(self._parameters)

    def __repr__(self) -> str:
        return f"Truth({self._parameters!r}, signals: {', '.join(self.signals) or 'none'})"


class SimulatedRecording(Recording):
    """A recording with the true signals of its simulation in `truth.signals`.

    A saved file and the result of `resample` keep the true parameters, but not the true signals.

    Examples
    --------
    >>> run = jid.simulate(known, jid.Pd(stiffness=8000.0, damping=400.0), jid.Trajectory.thesis(duration=2.0))
    >>> run.truth["coulomb"]
    25.0
    """

    truth: Truth

    def __init__(
        self, *, true_signals: Mapping[str, npt.ArrayLike] | None = None, **fields: Any
    ) -> None:
        super().__init__(**fields)
        truth = Truth(vars(self)["truth"] or {}, true_signals or {})
        for name, values in truth.signals.items():
            if len(values) != len(self.time):
                raise InputError(
                    f"this signal has {len(values)} samples, but time has {len(self.time)}; all signals need "
                    "the same number of samples",
                    argument=f"true_signals.{name}",
                )
        vars(self)["truth"] = truth

    def tracking_error(self, *, true: bool = True) -> FloatArray:
        """Return position minus reference [rad], for the true or the measured position.

        Raises
        ------
        InputError
            The recording has no reference.
        """
        if self.reference is None:
            raise InputError("the recording has no reference, so there is no tracking error")
        position = self.truth.signals.get("position", self.position) if true else self.position
        return np.asarray(position - self.reference)

    def _part(self, kept: slice, **changes: Any) -> Self:
        fields = self._fields()
        fields.update({signal: fields[signal][kept] for signal in self.signals}, **changes)
        fields["extra"] = rows_of_extra(self.extra, kept)
        signals = {name: values[kept] for name, values in self.truth.signals.items()}
        return type(self)(**fields, true_signals=signals)

    def __reduce__(self) -> tuple[Any, ...]:
        signals = dict(self.truth.signals)
        return functools.partial(type(self), **self._fields(), true_signals=signals), ()
