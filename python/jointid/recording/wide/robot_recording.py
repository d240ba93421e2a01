"""A robot's recording: the signals of several joints on one clock, read-only."""

import functools
import os
from collections.abc import Iterable, Iterator, Mapping, Sequence
from types import MappingProxyType
from typing import Any, Self

import numpy as np
import numpy.typing as npt

from jointid.base.error_text import joint_phrase
from jointid.base.errors import InputError
from jointid.recording.attributes import check_attributes, json_mapping
from jointid.recording.recording import Recording
from jointid.recording.sides import JOINT, MOTOR, SIDES, at_joint
from jointid.recording.signals import FloatArray, signal_array
from jointid.recording.slicing import slice_between
from jointid.recording.wide.joint_names import joint_named
from jointid.recording.wide.robot_samples import RobotSamples
from jointid.recording.wide.robot_signals import (
    LISTED,
    ROBOT_SIGNALS,
    checked_names,
    checked_ratios,
    extra_arrays,
    joint_arrays,
    value_of_each,
)


class RobotRecording(RobotSamples, Mapping[str, Recording]):
    """The signals of several joints on one clock, read-only; a mapping from a joint's name to its recording.

    Arrays have one row per sample and one column per joint. A joint's missing signal is a column of NaN.

    Parameters
    ----------
    time : array_like, shape (n,)
        Time stamps [s], strictly increasing; n is at least 8.
    position : array_like, shape (n, joints)
        Positions of the joints [rad], or [m] with ``kind="prismatic"``.
    velocity : array_like, shape (n, joints), optional
        Velocities of the joints [rad/s] or [m/s]. Default: derived from the positions, as in `Recording`.
    torque : array_like, shape (n, joints), optional
        Torque of the actuators [N·m], on the side of the gear that `side` names.
    motor_torque, current, sensor, reference, link_position, temperature : array_like, shape (n, joints), optional
        Signals as in `Recording`. The reference is on the side of the gear that `side` names.
    side : {"joint", "motor"}
        Side of the gear on which position, velocity and torque are recorded. Default ``"joint"``.
    gear_ratio : sequence of float, optional
        Motor angle per joint angle, one value per joint; negative if motor and joint turn in opposite directions.
        With gear ratios, each joint's recording is on the joint side. Default: not known.
    names : sequence of str, optional
        Names of the joints. Default: "1", "2", ...
    extra : mapping of str to array_like, shape (n,) or (n, joints), optional
        Other signals by name. Default: none.
    kind : {"revolute", "prismatic"}
        Kind of all joints. Default ``"revolute"``.
    torque_hold : {"zoh", "linear"}, optional
        Torque between samples, as in `Recording`. Default: not known.
    velocity_derived : bool
        Whether `velocity` was derived from the position. Default False.
    name : str
        Default ``""``.
    metadata : mapping of str to JSON value, optional
        Default: empty.

    Raises
    ------
    InputError
        A signal has a wrong shape or is not finite, or time does not strictly increase. Two joints have the same
        name, or an option has an unknown value.

    Examples
    --------
    >>> import numpy as np
    >>> time = np.arange(100) / 100.0
    >>> robot = RobotRecording(time=time, position=np.column_stack([np.sin(time), np.cos(time)]))
    >>> robot.names
    ('1', '2')
    >>> robot.joint(2).name
    'joint 2'
    """

    def __init__(
        self,
        *,
        time: npt.ArrayLike,
        position: npt.ArrayLike,
        velocity: npt.ArrayLike | None = None,
        torque: npt.ArrayLike | None = None,
        motor_torque: npt.ArrayLike | None = None,
        current: npt.ArrayLike | None = None,
        sensor: npt.ArrayLike | None = None,
        reference: npt.ArrayLike | None = None,
        link_position: npt.ArrayLike | None = None,
        temperature: npt.ArrayLike | None = None,
        side: str = JOINT,
        gear_ratio: Sequence[float] | FloatArray | float | None = None,
        names: Sequence[str] | None = None,
        extra: Mapping[str, npt.ArrayLike] | None = None,
        kind: str = "revolute",
        torque_hold: str | None = None,
        velocity_derived: bool = False,
        name: str = "",
        metadata: Mapping[str, Any] | None = None,
    ) -> None:
        check_attributes(kind, torque_hold, name, velocity_derived)
        if side not in SIDES:
            raise InputError(
                f"{JOINT} or {MOTOR} is expected as the side of position, velocity and torque",
                argument="side",
                value=side,
            )
        clock = signal_array("time", time)
        given = (position, velocity, torque, motor_torque, current)
        rest = (sensor, reference, link_position, temperature)
        arrays = joint_arrays(clock, dict(zip(ROBOT_SIGNALS, (*given, *rest), strict=True)))
        joints = arrays["position"].shape[1]
        # Read-only: attributes are set only here, without __setattr__.
        vars(self).update(dict.fromkeys(ROBOT_SIGNALS), **arrays)
        vars(self).update(
            time=clock,
            side=side,
            gear_ratio=checked_ratios(gear_ratio, joints),
            names=checked_names(names, joints),
            extra=MappingProxyType(extra_arrays(extra or {}, clock, joints)),
            kind=kind,
            torque_hold=torque_hold,
            velocity_derived=velocity_derived,
            name=name,
            metadata=json_mapping("metadata", metadata or {}),
        )
        for joint in self.names:  # refuse here what a recording cannot hold
            self.joint(joint)

    @functools.cached_property
    def _recordings(self) -> dict[str, Recording]:
        return {}

    def joint(self, joint: str | int) -> Recording:
        """Return one joint's recording, on the joint side if the gear ratio is known.

        Parameters
        ----------
        joint : str or int
            Name or number of the joint. The number 3 means "3", or "joint_3" if all names differ only in their
            number.

        Returns
        -------
        Recording
            Without a gear ratio, motor-side values stay on the motor side, and ``metadata["side"]`` is "motor".

        Raises
        ------
        InputError
            There is no such joint.
        """
        name = joint_named(joint, self.names, self.name or "robot recording")
        if name not in self._recordings:
            self._recordings[name] = self._recording(name)
        return self._recordings[name]

    def _recording(self, name: str) -> Recording:
        column = self.names.index(name)
        fields: dict[str, Any] = {"time": self.time}
        for signal in ROBOT_SIGNALS:
            values = getattr(self, signal)
            if values is not None and not np.isnan(values[0, column]):
                fields[signal] = np.ascontiguousarray(values[:, column])
        ratio = None if self.gear_ratio is None else self.gear_ratio[column]
        fields["metadata"] = {**self.metadata, "joint": name}
        fields["extra"] = {
            key: values if values.ndim == 1 else np.ascontiguousarray(values[:, column])
            for key, values in self.extra.items()
        }
        found = at_joint(fields, self.side, ratio)
        shown = (
            f"{self.name} {joint_phrase(name)}".lstrip() if self.name or name.isdigit() else name
        )
        try:
            return Recording(
                **found,
                kind=self.kind,
                torque_hold=self.torque_hold,
                velocity_derived=self.velocity_derived and "velocity" in fields,
                name=shown,
            )
        except InputError as error:
            raise error.at(joint_phrase(name)) from None

    def to_recordings(self) -> tuple[Recording, ...]:
        """Return the recordings of all joints, in their order."""
        return tuple(self.joint(name) for name in self.names)

    def select(self, joints: Iterable[str | int]) -> Self:
        """Return the recording of these joints, in this order, with ``metadata["joints_listed"]`` True.

        Raises
        ------
        InputError
            There is no such joint, or `joints` is empty.
        """
        place = self.name or "robot recording"
        names = [joint_named(each, self.names, place, "joints") for each in joints]
        kept = [self.names.index(name) for name in names]
        fields = self.fields()
        for signal in self.signals[1:]:
            fields[signal] = fields[signal][:, kept]
        fields["extra"] = {
            key: values if values.ndim == 1 else values[:, kept]
            for key, values in self.extra.items()
        }
        if self.gear_ratio is not None:
            fields["gear_ratio"] = [self.gear_ratio[column] for column in kept]
        fields["metadata"] = {**self.metadata, LISTED: True}
        return type(self)(**{**fields, "names": names})

    def crop(self, start: float | None = None, stop: float | None = None) -> Self:
        """Return the samples from one time to another, both included; see `Recording.crop`."""
        kept = slice_between(self.time, start, stop)
        fields = self.fields()
        for signal in self.signals:
            fields[signal] = fields[signal][kept]
        fields["extra"] = {key: values[kept] for key, values in self.extra.items()}
        return type(self)(**fields)

    def with_gear_ratio(self, gear_ratio: Sequence[float] | FloatArray | float) -> Self:
        """Return the recording with other gear ratios, one per joint."""
        return type(self)(**{**self.fields(), "gear_ratio": gear_ratio})

    def with_torque_constants(self, torque_constants: Sequence[float] | FloatArray) -> Self:
        """Return the recording with torques from its currents, on the recording's `side` of the gear.

        Parameters
        ----------
        torque_constants : sequence of float
            Torque constants of the motors [N·m/A], one value per joint; negative if a positive current turns the
            joint backward. On the joint side, torque constants are multiplied by the gear ratios. Without gear
            ratios, state joint-side torque constants.

        Raises
        ------
        InputError
            There is no current, or the number of constants is wrong.
        """
        if self.current is None:
            raise InputError("the recording has no current", argument="torque_constants")
        found = value_of_each("torque_constants", torque_constants, len(self.names), "load")
        geared = self.side == JOINT and self.gear_ratio is not None
        ratios = np.array(self.gear_ratio if geared else (1.0,) * len(self.names))
        torque = self.current * (np.array(found) * ratios)
        metadata = {**self.metadata, "torque_constants": list(found)}
        return type(self)(**{**self.fields(), "torque": torque, "metadata": metadata})

    def save(self, path: str | os.PathLike[str]) -> None:
        """Write the recording to a file (.npz, .csv, .csv.gz), completely or not at all.

        ``load(path, joints="all")`` reads a bit-identical recording; ``load(path, joint=...)`` reads one joint's
        recording.

        Raises
        ------
        InputError
            The file name has another ending, or the folder does not exist.
        OSError
            The file cannot be written; an existing file is unchanged.
        """
        from jointid.recording.wide.robot_saving import save_robot

        save_robot(self, path)

    def __getitem__(self, joint: str | int) -> Recording:
        try:
            return self.joint(joint)
        except InputError as error:
            raise KeyError(str(error)) from None

    def __iter__(self) -> Iterator[str]:
        return iter(self.names)

    def __len__(self) -> int:
        return len(self.names)

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, RobotRecording):
            return NotImplemented
        return _plain(self.fields()) == _plain(other.fields())

    def __hash__(self) -> int:
        return hash((self.names, self.time.tobytes(), self.position.tobytes()))

    def __repr__(self) -> str:
        named = f" {self.name!r}" if self.name else ""
        shown = [each for each in self.signals if each != "time"]
        shown += [f"extra {each}" for each in self.extra]
        return (
            f"<RobotRecording{named}: {len(self)} joints ({', '.join(self.names)}), {self.samples} samples over "
            f"{self.duration:.6g} s, {self.side} side; {', '.join(shown)}>"
        )

    def __reduce__(self) -> tuple[Any, ...]:
        # Use the constructor, because unpickled arrays are writable again.
        return functools.partial(type(self), **self.fields()), ()


def _plain(fields: dict[str, Any]) -> dict[str, Any]:
    """Replace arrays by their bytes, so that -0.0 differs from 0.0 and NaN equals NaN."""
    flat = {**fields, **{f"extra {key}": value for key, value in fields["extra"].items()}}
    del flat["extra"]
    return {
        key: (value.shape, value.tobytes()) if isinstance(value, np.ndarray) else value
        for key, value in flat.items()
    }
