"""A robot: its links from a URDF, and how its motors drive them."""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Self

import numpy as np
import numpy.typing as npt
from numpy.typing import NDArray

from jointid.base.argument_checks import is_finite, require_path
from jointid.base.errors import InputError
from jointid.joint.model import Model
from jointid.recording.sides import SIDES
from jointid.recording.wide.robot_recording import RobotRecording
from jointid.recording.wide.robot_signals import value_of_each
from jointid.robot.links.facts import read_facts
from jointid.robot.links.finding_columns import joint_columns
from jointid.robot.links.link_tree import LinkTree
from jointid.robot.links.models import friction_models
from jointid.robot.links.position_drive import PositionDrive

Array = NDArray[np.float64]

_GRAVITY = (0.0, 0.0, -9.81)


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Robot:
    """A robot's links, joints and motors. `from_urdf` makes it.

    Attributes
    ----------
    tree : LinkTree
        Links, joints and inertias, from the URDF.
    names : tuple of str
        Names of the joints; every list with one value per joint has this order.
    gear_ratios : tuple of float or None
        Motor angle per joint angle of each joint, with sign.
    couplings : ndarray, shape (n, n)
        Matrix from joint speeds to motor speeds divided by gear ratios; the identity if each motor turns only with
        its own joint.
    rotor_inertias : tuple of (float or None)
        Inertia of each motor with its gear, at the joint [kg·m² or kg]; None: identified.
    zero_offsets : tuple of float or None
        Joint positions in the URDF at the recording's position 0 [rad or m]. None: 0, or multiples of 90 degrees if
        the URDF's inertias fit only with these multiples.
    side : str or None
        Side of the gear of recorded positions and torques: "joint" or "motor"; None: the side in the recording's
        headers.
    name : str
        Name of the robot in the URDF.
    torque_scales : tuple of float or None
        Factors by which the recorded torques are multiplied; None: 1.
    directions : tuple of float or None
        1, or -1 if positive recorded positions and torques are negative about the URDF's axis; None: 1.
    torque_constants : tuple of float or None
        Torque per recorded current of each motor [N·m/A], with sign; None: not known.
    models : tuple of str or None
        Friction model of each joint, for calls that name no model; None: "auto".
    drive : PositionDrive or None
        Position loop that computes torques from desired positions; None: torques are recorded.
    gravity_free : bool
        Whether the direction of gravity is identified.
    """

    tree: LinkTree
    names: tuple[str, ...]
    gear_ratios: tuple[float, ...] | None
    couplings: Array
    rotor_inertias: tuple[float | None, ...]
    zero_offsets: tuple[float, ...] | None = None
    side: str | None = None
    name: str = ""
    torque_scales: tuple[float, ...] | None = None
    directions: tuple[float, ...] | None = None
    torque_constants: tuple[float, ...] | None = None
    models: tuple[str, ...] | None = None
    drive: PositionDrive | None = None
    gravity_free: bool = False

    @classmethod
    def from_urdf(
        cls,
        path: str | os.PathLike[str],
        joints: Sequence[str] | None = None,
        *,
        gear_ratios: Sequence[float] | None = None,
        couplings: npt.ArrayLike | Mapping[str, Mapping[str, float]] | None = None,
        rotor_inertias: Sequence[float | None] | None = None,
        zero_offsets: Sequence[float] | None = None,
        side: str | None = None,
        gravity: Sequence[float] | str | None = None,
        torque_constants: Sequence[float] | None = None,
        torque_scales: Sequence[float] | None = None,
        directions: Sequence[float] | None = None,
        models: Mapping[str, Model | str] | None = None,
        drive: Mapping[str, object] | None = None,
        facts: str | os.PathLike[str] | None = None,
    ) -> Self:
        """Return the robot that a URDF describes.

        Parameters
        ----------
        path : path-like
            File of the URDF. Meshes are not read.
        joints : sequence of str, optional
            Names of the joints to identify, in the URDF's order. All lists below have this order. The other joints
            stay at position zero. Default: all movable joints.
        gear_ratios : sequence of float, optional
            Motor angle per joint angle, one value per joint; negative if motor and joint turn in opposite
            directions. Default: gear ratios of the recording. A joint-side recording needs no gear ratios.
        couplings : array_like, shape (n, n), or mapping, optional
            Matrix from joint speeds to motor speeds divided by gear ratios. Row i belongs to motor i. Ones in
            columns 5 and 6 of row 6 mean that motor 6 turns with both joints; ``{"joint_6": {"joint_5": 1.0}}`` has
            the same meaning. Default: each motor turns only with its own joint.
        rotor_inertias : sequence of float or None, optional
            Inertia of each motor with its gear at the joint: motor-side inertia times squared gear ratio [kg·m² or
            kg]. None: identified. Default: all rotor inertias are identified.
        zero_offsets : sequence of float, optional
            Joint positions in the URDF at the recording's position 0 [rad or m]. The controller's zero pose often
            differs from the URDF's. Default: 0, or multiples of 90 degrees if the URDF's inertias fit only with
            these multiples.
        side : {"joint", "motor"}, optional
            Side of the gear of recorded positions and torques. Default: the side in the recording's headers.
        gravity : sequence of float or "free", optional
            Gravity in the base's frame [m/s²]. "free" identifies the direction of gravity, e.g. for a tilted or
            hanging robot. Default (0, 0, -9.81): the base stands upright.
        torque_constants : sequence of float, optional
            Motor torque per recorded current [N·m/A], one value per joint; negative if a positive current turns the
            joint backward. Gear ratios convert the torques to the joints. Without gear ratios, state joint-side
            torque constants. Default: not known; the recording then needs a torque.
        torque_scales : sequence of float, optional
            Factors by which recorded torques are multiplied, one per joint, or per motor for motor-side torques.
            A factor is the true over the assumed torque constant; -1 reverses a sign. Default: 1.
        directions : sequence of float, optional
            1 or -1, one per joint: -1 if positive recorded positions and torques are negative about the URDF's
            axis. Default: 1.
        models : mapping, optional
            Friction models by joint name, for calls of `identify` that name no model. A file of facts states them
            as ``model`` in a table ``[joints.NAME]``. Default: "auto".
        drive : mapping, optional
            Position loop that computes the torque from the desired position, if no torque is recorded. Its values
            are on the recording's side of the gear. ``kp`` [N·m/rad] and ``kd`` [N·m·s/rad]: gains, one for all
            joints or one per joint. With ``"free"``, ``kp`` is identified from the weight of the links, and ``kd``
            is part of the viscous coefficient. ``torque_limits``: largest torques [N·m] (default: none). ``hold``:
            "zoh" (default) if a desired position is held until the next row, "linear" if it is interpolated.
            ``delay``: time from a row to the effect of its desired position [s] (default: identified). Default:
            torques are recorded.
        facts : path-like, optional
            TOML file with any of these arguments except `path`, or with ``zero_offsets_deg``. Arguments of the call
            override the file. ``"free"`` marks a rotor inertia to identify.

        Raises
        ------
        InputError
            pinocchio is not installed, the file is not a URDF, a joint does not exist, or values do not fit the
            joints.

        Examples
        --------
        >>> robot = jid.Robot.from_urdf("arm.urdf", gear_ratios=[100, -50])
        >>> robot.names
        ('shoulder', 'elbow')
        """
        from jointid.robot.links.reading_urdf import tree_of_urdf

        if facts is not None:
            given = {
                "joints": joints,
                "gear_ratios": gear_ratios,
                "couplings": couplings,
                "rotor_inertias": rotor_inertias,
                "zero_offsets": zero_offsets,
                "side": side,
                "gravity": gravity,
                "torque_constants": torque_constants,
                "torque_scales": torque_scales,
                "directions": directions,
                "models": models,
                "drive": drive,
            }
            stated = {name: value for name, value in given.items() if value is not None}
            place = require_path("facts", facts)
            read = read_facts(place)
            try:
                return cls.from_urdf(path, **{**read, **stated})
            except InputError as error:
                said = error.argument.partition(".")[0]
                raise (
                    error.at(place.name) if said in read.keys() - stated.keys() else error
                ) from None
        file = require_path("path", path)
        if side not in (None, *SIDES):
            raise InputError(f"{' or '.join(SIDES)} is expected", argument="side", value=side)
        free = isinstance(gravity, str) and gravity == "free"
        pull = _GRAVITY if gravity is None or free else gravity
        if isinstance(pull, str):
            raise InputError('3 numbers or "free" are expected', argument="gravity", value=gravity)
        down = _numbers("gravity", pull, 3)
        tree = tree_of_urdf(file, joints, down)
        n = len(tree.names)
        of_each = {
            name: None if values is None else value_of_each(name, values, n, "Robot.from_urdf")
            for name, values in (
                ("gear_ratios", gear_ratios),
                ("torque_constants", torque_constants),
            )
        }
        return cls(
            tree=tree,
            names=tree.names,
            **of_each,
            couplings=_couplings(couplings, tree.names),
            rotor_inertias=_rotors(rotor_inertias, n),
            zero_offsets=None
            if zero_offsets is None
            else tuple(_numbers("zero_offsets", zero_offsets, n)),
            side=side,
            name=file.stem,
            torque_scales=_factors("torque_scales", torque_scales, n),
            directions=_factors("directions", directions, n),
            models=None if models is None else _models(models, tree.names),
            drive=None if drive is None else _drive(drive, n, couplings),
            gravity_free=free,
        )

    @property
    def n(self) -> int:
        """Number of joints."""
        return len(self.names)

    @property
    def coupled(self) -> NDArray[np.bool_]:
        """For each motor: True if it also turns with joints other than its own joint."""
        return np.array(
            [np.any(np.delete(row, k) != 0.0) for k, row in enumerate(self.couplings)], dtype=bool
        )

    def columns_of(self, recording: RobotRecording) -> list[int]:
        """Return the recording's column of each joint.

        Joints are matched by name. If no name fits and the number of joints is the same, the order of `joints` in
        the call of `load` applies. Without `joints`, joints are matched by the numbers in the recording's names, or
        in order without numbers.

        Raises
        ------
        InputError
            The recording has no such joint.
        """
        return joint_columns(self.names, recording)


def _models(models: Mapping[str, Model | str], names: Sequence[str]) -> tuple[str, ...]:
    if not isinstance(models, Mapping):
        raise InputError(
            "a mapping from joint names to models is expected", argument="models", value=models
        )
    try:
        return tuple(friction_models(dict(models), names))
    except InputError as error:
        raise InputError(
            error.reason, argument="models", value=error.value, remedy=error.remedy
        ) from None


def _drive(drive: object, n: int, couplings: object) -> PositionDrive:
    if couplings is not None:
        raise InputError(
            "a position drive cannot be combined with couplings",
            argument="drive",
            remedy="record torques",
        )
    return PositionDrive.of(drive, n)


def _numbers(argument: str, values: Sequence[float], count: int) -> list[float]:
    try:
        array = np.asarray(values, dtype=np.float64)
    except (OverflowError, TypeError, ValueError):
        array = np.full(0, np.nan)
    if array.shape != (count,) or not np.all(np.isfinite(array)):
        raise InputError(f"{count} numbers are expected", argument=argument, value=values)
    return [float(each) for each in array]


def _factors(argument: str, values: Sequence[float] | None, count: int) -> tuple[float, ...] | None:
    """Return factors that are not 0; directions are 1 or -1."""
    if values is None:
        return None
    found = _numbers(argument, values, count)
    if 0.0 in found or (argument == "directions" and any(abs(each) != 1.0 for each in found)):
        expected = "1 or -1 is expected" if argument == "directions" else "a factor is not 0"
        raise InputError(expected, argument=argument, value=values)
    return tuple(found)


def _couplings(
    couplings: npt.ArrayLike | Mapping[str, Mapping[str, float]] | None, names: Sequence[str]
) -> Array:
    n = len(names)
    matrix = np.eye(n)
    if isinstance(couplings, Mapping):
        matrix = _named_couplings(couplings, list(names))
    elif couplings is not None:
        try:
            matrix = np.array(couplings, dtype=np.float64)
        except (OverflowError, TypeError, ValueError):
            matrix = np.full((0, 0), np.nan)
        if matrix.shape != (n, n) or not np.all(np.isfinite(matrix)):
            raise InputError(
                f"a matrix of {n} x {n} numbers is expected, one row per motor and one column per joint",
                argument="couplings",
                value=couplings,
            )
    if np.linalg.cond(matrix) > 1e9:
        raise InputError(
            "the matrix is singular: motor speeds do not determine joint speeds",
            argument="couplings",
            value=couplings,
        )
    matrix.flags.writeable = False
    return matrix


def _named_couplings(couplings: Mapping[str, Mapping[str, float]], names: list[str]) -> Array:
    """Return the matrix; couplings that are not named keep their default."""
    matrix = np.eye(len(names))
    for motor, row in couplings.items():
        if motor not in names:
            raise InputError(
                f"the robot has no such joint; it has {', '.join(names)}",
                argument=f"couplings.{motor}",
            )
        if not isinstance(row, Mapping):
            raise InputError(
                "a mapping from joints to shares is expected for each motor",
                argument=f"couplings.{motor}",
                value=row,
            )
        for joint, share in row.items():
            if joint not in names:
                raise InputError(
                    f"the robot has no such joint; it has {', '.join(names)}",
                    argument=f"couplings.{motor}.{joint}",
                )
            if not is_finite(share):
                raise InputError(
                    "a number is expected", argument=f"couplings.{motor}.{joint}", value=share
                )
            matrix[names.index(motor), names.index(joint)] = share
    return matrix


def _rotors(values: Sequence[float | None] | None, n: int) -> tuple[float | None, ...]:
    if values is None:
        return (None,) * n
    if not isinstance(values, Sequence | np.ndarray) or len(values) != n:
        raise InputError(f"{n} values are expected", argument="rotor_inertias", value=values)
    found: list[float | None] = []
    for each in values:
        if each is not None and not (is_finite(each) and each >= 0.0):
            raise InputError("0 or more is expected", argument="rotor_inertias", value=each)
        found.append(None if each is None else float(each))
    return tuple(found)
