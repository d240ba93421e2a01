"""The samples of several joints on one clock."""

from collections.abc import Mapping
from typing import Any, NoReturn

from jointid.recording.signals import FloatArray
from jointid.recording.wide.robot_signals import ROBOT_SIGNALS


class RobotSamples:
    """Content of a robot's recording; only the constructor sets the attributes."""

    time: FloatArray
    position: FloatArray
    velocity: FloatArray | None
    torque: FloatArray | None
    motor_torque: FloatArray | None
    current: FloatArray | None
    sensor: FloatArray | None
    reference: FloatArray | None
    link_position: FloatArray | None
    temperature: FloatArray | None
    side: str
    gear_ratio: tuple[float, ...] | None
    names: tuple[str, ...]
    extra: Mapping[str, FloatArray]
    kind: str
    torque_hold: str | None
    velocity_derived: bool
    name: str
    metadata: Mapping[str, Any]

    @property
    def signals(self) -> tuple[str, ...]:
        """Names of the recorded signals in a fixed order, time first."""
        return ("time", *(name for name in ROBOT_SIGNALS if getattr(self, name) is not None))

    @property
    def samples(self) -> int:
        """Number of samples."""
        return len(self.time)

    @property
    def duration(self) -> float:
        """Time from the first sample to the last [s]."""
        return float(self.time[-1]) - float(self.time[0])

    def fields(self) -> dict[str, Any]:
        """Return the arguments that build this recording again."""
        names = ("time", *ROBOT_SIGNALS, "side", "gear_ratio", "names", "kind", "torque_hold")
        fields = {name: getattr(self, name) for name in (*names, "velocity_derived", "name")}
        return fields | {"extra": dict(self.extra), "metadata": dict(self.metadata)}

    def __setattr__(self, name: str, value: object) -> NoReturn:
        raise AttributeError(f"a recording is read-only, '{name}' cannot be set")

    def __delattr__(self, name: str) -> NoReturn:
        raise AttributeError(f"a recording is read-only, '{name}' cannot be deleted")
