"""A joint: its known values before an identification, and its identified values after it."""

import functools
import os
from collections.abc import Mapping
from dataclasses import fields, replace
from types import MappingProxyType
from typing import TYPE_CHECKING, Any, Self, get_args

import numpy as np
from numpy.typing import NDArray

from jointid.base.advice import Action
from jointid.base.errors import InputError
from jointid.base.values import dataclass
from jointid.joint.checks import (
    check_choice,
    check_flag,
    check_mapping,
    finite_number,
    positive_number,
    set_numbers,
    suggestion,
)
from jointid.joint.consistency import check_consistency
from jointid.joint.joint_fields import JointFields
from jointid.joint.link import Limits, Link
from jointid.joint.model import Model
from jointid.joint.parameters import merge, parameter_table
from jointid.joint.tolerances import Tolerances
from jointid.joint.voltage_drive import VoltageDrive
from jointid.recording.signals import Kind, TorqueHold

if TYPE_CHECKING:
    from jointid.recording.recording import Recording


@dataclass(frozen=True, kw_only=True, repr=False)
class Joint(JointFields):
    """One joint of a robot: drive, friction model, sensor, link, parameters and limits.

    Values are on the output side of the gear, except those marked as motor side. For a prismatic joint, torques are
    forces [N], inertias are masses [kg], and angles are travels [m]. Its gear ratio is the motor's angle per travel
    [rad/m].

    Parameters
    ----------
    name : str
        Default ``""``.
    kind : {"revolute", "prismatic"}
        Default ``"revolute"``.
    inertia : float, optional
        Inertia of the drive alone, at the output [kg·m²]. Default: computed from `rotor_inertia`, or identified if
        both are unknown. Without a torque sensor, the identified inertia includes the link's inertia.
    rotor_inertia : float, optional
        Inertia of the rotor, motor side [kg·m²].
    gear_ratio : float
        Motor's angle per output angle; negative if motor and output turn in opposite directions. Default 1.
    torque_constant : float, optional
        Torque constant of the motor, motor side [N·m/A].
    torque_hold : {"zoh", "linear"}, optional
        Torque between samples: held ("zoh") or linearly interpolated ("linear"). Default: not known.
    sensor : bool
        Whether the joint has a torque sensor. Default False.
    model : Model, str or mapping
        Known terms of the torque balance, e.g. the text ``"stribeck:ripple=2"``. Default: none.
    torque_offset : bool, optional
        Whether the torque has a constant offset. Default: True without a torque sensor, otherwise False.
    link : Link, optional
        Default: not known.
    parameters : mapping of str to Parameter
        Known values of parameters, and bounds of the search. Default: none.
    limits : Limits
        Default: none known.
    tolerances : Tolerances or mapping
        Tolerances of the known values above, e.g. ``{"torque_constant": "5 %"}``. `identify` shows the effect of
        each tolerance on each parameter. Default: none.
    voltage : VoltageDrive, optional
        Drive of a servo without a torque signal: the motor's voltage is duty times supply voltage. Default: the
        drive's input is a torque.

    Raises
    ------
    InputError
        A field is invalid, or fields contradict each other.

    Examples
    --------
    >>> elbow = jid.Joint(name="elbow", gear_ratio=101.0, rotor_inertia=2.472e-4, sensor=True, model="stribeck")
    >>> round(elbow.reflected_inertia, 4)
    2.5217
    """

    def __post_init__(self) -> None:
        if not isinstance(self.name, str):
            raise InputError("text is expected", argument="name", value=self.name, place="joint")
        if any("\ud800" <= letter <= "\udfff" for letter in self.name):
            raise InputError(
                "the name has characters that no file can store",
                argument="name",
                value=self.name,
                place="joint",
            )
        owner = self.owner
        check_choice(owner, "kind", self.kind, get_args(Kind))
        if self.torque_hold is not None:
            check_choice(owner, "torque_hold", self.torque_hold, get_args(TorqueHold))
        set_numbers(self, owner, ("inertia", "rotor_inertia", "torque_constant"), positive_number)
        set_numbers(self, owner, ("gear_ratio",), finite_number)
        if self.gear_ratio == 0.0:
            raise InputError(
                "a value other than 0 is expected; use 1 for a joint without a gear",
                argument="gear_ratio",
                value=0,
                place=owner,
            )
        check_flag(owner, "sensor", self.sensor)
        if self.torque_offset is not None:
            check_flag(owner, "torque_offset", self.torque_offset)
        try:
            object.__setattr__(self, "model", Model.of(self.model))
        except InputError as error:
            raise error.at(owner) from None
        if not isinstance(self.link, Link | None):
            raise InputError("a Link is expected", argument="link", value=self.link, place=owner)
        if not isinstance(self.limits, Limits):
            raise InputError(
                "Limits are expected", argument="limits", value=self.limits, place=owner
            )
        if not isinstance(self.voltage, VoltageDrive | None):
            raise InputError(
                "a VoltageDrive is expected", argument="voltage", value=self.voltage, place=owner
            )
        try:
            object.__setattr__(self, "tolerances", Tolerances.of(self.tolerances))
        except InputError as error:
            raise error.at(owner) from None
        table = MappingProxyType(parameter_table(self.parameters))
        object.__setattr__(self, "parameters", table)
        check_consistency(self, owner)

    @staticmethod
    def load(path: str | os.PathLike[str]) -> "Joint":
        """Return the joint from a joint file (TOML).

        Raises
        ------
        InputError
            The file does not exist, is not TOML, or has an invalid value; the error names file, table and key.
        """
        from jointid.joint.joint_file import joint_from_document, read_document

        return joint_from_document(read_document(path), str(path), Joint)

    def save(self, path: str | os.PathLike[str]) -> None:
        """Write the joint to a joint file; if writing fails, an existing file is unchanged.

        An existing joint file keeps its comments, its order and its tables `user`, `session` and `estimate`.

        Raises
        ------
        InputError
            The file name does not end in ``.toml``, the folder does not exist, or an existing file is not a joint
            file.
        OSError
            The file cannot be written; an existing file is unchanged.
        """
        from jointid.joint.joint_file import save_joint

        save_joint(self, path)

    def replace(self, **changes: Any) -> Self:
        """Return a joint with some fields changed.

        Raises
        ------
        InputError
            There is no such field, or a value is invalid.
        """
        known = [item.name for item in fields(self)]
        for name in changes:
            if name not in known:
                raise InputError(
                    f"a joint has no such field; {suggestion(name, known)}",
                    argument=name,
                    place="joint",
                )
        return replace(self, **changes)

    def with_parameters(self, values: Mapping[str, float]) -> Self:
        """Return a joint with the values of some parameters changed; min, max and vary are unchanged.

        Parameters
        ----------
        values : mapping of str to float
            Values by parameter name, in SI units at the output.

        Raises
        ------
        InputError
            A parameter is unknown, or its value is not finite or is outside the bounds.
        """
        check_mapping("", "values", values)
        table = merge(self.parameters, {name: {"value": value} for name, value in values.items()})
        for name in values:
            finite_number(f"parameter '{name}'", "value", table[name].value)
        return replace(self, parameters=table)

    def output_torque(self, recording: "Recording") -> NDArray[np.float64]:
        """Return the drive's torque at the output, from a recording's torque, motor torque or current.

        Parameters
        ----------
        recording : Recording
            Recording. Its first available signal is used: `torque`, `motor_torque` times gear ratio, `current`
            times torque constant and gear ratio.

        Returns
        -------
        ndarray, shape (n,)
            Torque [N·m] or force [N].

        Raises
        ------
        InputError
            The recording has none of these signals, or it has only a current and the joint has no torque constant.
        """
        if recording.torque is not None:
            return recording.torque
        if recording.motor_torque is not None:
            return recording.motor_torque * self.gear_ratio
        if recording.current is None:
            raise InputError(
                "the recording has no signal torque, motor_torque or current",
                remedy="identify the recordings of this joint separately: the input of its drive is a voltage"
                if self.voltage is not None
                else Action("call", {"columns": {"torque": ...}}, function="load"),
            )
        if self.torque_constant is None:
            raise InputError(
                "the recording has only the current, and the joint has no torque constant",
                argument="torque_constant",
                place=self.owner,
                remedy="give the joint's torque_constant in N·m/A",
            )
        return recording.current * (self.torque_constant * self.gear_ratio)

    def __repr__(self) -> str:
        usual = _values(Joint())
        shown = [f"{name}={v!r}" for name, v in _values(self).items() if v != usual[name]]
        return f"Joint({', '.join(shown)})"

    def _repr_html_(self) -> str:
        from jointid.joint.html import html_facts

        return str(html_facts(self))

    def __reduce__(self) -> tuple[Any, ...]:
        # Use the constructor, because read-only mappings cannot be pickled.
        return functools.partial(type(self), **_values(self)), ()


def _values(joint: Joint) -> dict[str, Any]:
    """Return the arguments that build this joint again."""
    values = {item.name: getattr(joint, item.name) for item in fields(joint)}
    return values | {"parameters": dict(joint.parameters)}
