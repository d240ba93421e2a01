"""The terms of a joint's torque balance, chosen from the joint, the recordings and the call."""

import functools
from collections.abc import Mapping, Sequence
from dataclasses import field
from typing import Literal, get_args

from jointid import _core
from jointid.base.advice import Action
from jointid.base.errors import InputError
from jointid.base.values import dataclass
from jointid.joint.joint import Joint
from jointid.joint.model import Load, Model, ResolvedModel
from jointid.problem.own_integrals import centred
from jointid.recording.recording import Recording

_GRAVITY = ("gravity_cos", "gravity_sin")
_LOADS = {"link": "load_friction_link"}
_SENSOR = ("sensor_gain", "sensor_offset")

# Residuals: the torque against the part of the reading that the motion explains, the reading against the
# remaining torque (the thesis), and the torque against the reading.
Residual = Literal["instruments", "sensor", "torque"]
RESIDUALS: tuple[str, ...] = get_args(Residual)


WEAK_READING = "the motion explains too little of the sensor's reading"
"""Reason why the reading of a sensor is not projected on the motion."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Request:
    """The terms and the residual that a call requests.

    Attributes
    ----------
    model : Model
        Model of the call; its fields override those of the joint's model.
    residual : str or None
        "instruments", "sensor" or "torque"; None: instruments if there is a sensor, else the torque.
    """

    model: Model = field(default_factory=Model)
    residual: str | None = None


@dataclass(frozen=True, slots=True, kw_only=True)
class TermChoice:
    """The terms of one identification, in the core's order, and its residual.

    Attributes
    ----------
    terms : tuple of str
        Keys of the core's terms.
    model : Model
        The call's fields, completed by the joint's; the name is never None.
    residual : str
        "instruments", "sensor" or "torque".
    sensor : bool
        Whether the terms contain the sensor's gain and offset.
    gear_ratio : float
    dropped : str
        A term that is redundant with another one, and the reason; empty if none.
    residual_reason : str
        Reason why the residual is not the default; empty if it is, or if the call states it.
    """

    terms: tuple[str, ...]
    model: Model
    residual: str
    sensor: bool
    gear_ratio: float = 1.0
    dropped: str = ""
    residual_reason: str = ""

    @property
    def per_recording(self) -> tuple[str, ...]:
        """Coefficients with a separate value per recording."""
        return self.model.resolved.per_recording


def choose_terms(
    recordings: Sequence[Recording], joint: Joint | None, request: Request
) -> TermChoice:
    """Return the terms of the torque balance: inertia, friction, then gravity, offset, harmonics and sensor.

    Raises
    ------
    InputError
        The residual needs a sensor and there is none, terms are indistinguishable, or a coefficient of the
        call's `per_recording` is not among the terms. Such coefficients of the joint's model are ignored.
    """
    base = joint if joint is not None else Joint()
    stated = request.model.over(base.model)
    model = stated.resolved
    _check_kind(recordings, joint)
    sensor = _has_sensor(recordings, joint)
    # Instruments project the reading, but load friction needs the reading itself for each direction of motion.
    usual = "instruments" if sensor and not model.load_friction else "torque"
    residual = request.residual or usual
    if residual != "torque" and not sensor:
        raise InputError(
            "the recording has no torque sensor",
            argument="residual",
            value=residual,
            remedy=Action("call", {"residual": "torque"}),
        )
    if residual == "instruments" and model.load_friction:
        raise InputError(
            "instrumental variables replace the reading, but load friction depends on the reading",
            argument="residual",
            value=residual,
            remedy=Action("call", {"residual": "torque"}),
        )
    if model.ripple and joint is None:
        raise InputError(
            "ripple orders are per motor revolution, but no joint with a gear_ratio is given",
            argument="ripple",
            value=list(model.ripple),
            remedy="give a joint with its gear_ratio",
        )
    if model.gravity == "known" and joint is None:
        raise InputError(
            "no joint with a known link is given",
            argument="gravity",
            value=model.gravity,
            remedy="give a joint with a link, or set gravity to free",
        )
    offset, dropped = _offset(base, model, sensor)
    wanted = {"inertia", *_friction(_models()[model.name], model.asymmetric)}
    wanted.update(_GRAVITY if model.gravity != "none" else ())
    wanted.update(_SENSOR if sensor else ())
    wanted.update(
        (_LOADS.get(str(model.load_friction), "load_friction"),) if model.load_friction else ()
    )
    wanted.update(("torque_offset",) if offset else ())
    own = centred(model.terms, recordings)
    terms = (*_ordered(wanted, model.ripple, model.harmonics), *own.keys_in_core)
    apart = stated.per_recording
    if request.model.per_recording is not None:
        _check_per_recording(request.model.per_recording, terms)
    elif apart is not None:  # from the joint: other recordings or terms may use it
        known = _coefficients(terms)
        apart = tuple(name for name in apart if name in known)
    chosen = stated.replace(name=model.name, per_recording=apart if len(recordings) > 1 else None)
    return TermChoice(
        terms=terms,
        model=chosen.replace(terms=own) if own.each else chosen,
        residual=residual,
        sensor=sensor,
        gear_ratio=base.gear_ratio,
        dropped=dropped,
    )


def loads(model: Model, recordings: Sequence[Recording], joint: Joint | None) -> tuple[Load, ...]:
    """Return the loads that friction may depend on in these recordings; the torque behind the gear must be known."""
    sensor = _has_sensor(recordings, joint)
    return ("drive", "link") if sensor or model.resolved.gravity != "none" else ("drive",)


def _check_kind(recordings: Sequence[Recording], joint: Joint | None) -> None:
    if joint is not None and recordings[0].kind != joint.kind:
        raise InputError(
            f"{joint.owner} is {joint.kind}",
            argument="kind",
            value=recordings[0].kind,
            place="recording",
            remedy="check the unit of the position, or the kind of the joint",
        )


def _has_sensor(recordings: Sequence[Recording], joint: Joint | None) -> bool:
    if joint is None:
        return all(recording.sensor is not None for recording in recordings)
    if joint.sensor:
        for number, recording in enumerate(recordings):
            if recording.sensor is None:
                raise InputError(
                    f"{joint.owner} has a torque sensor, but the recording has no signal sensor",
                    argument="sensor",
                    place=f"recording {number}",
                    remedy=(
                        Action("call", {"columns": {"sensor": ...}}, function="load"),
                        Action("call", {"sensor": False}, function="Joint"),
                    ),
                )
    return joint.sensor


def _friction(terms: Sequence[str], asymmetric: bool) -> list[str]:
    if not asymmetric:
        return list(terms)
    return [f"{term}_{side}" for term in terms for side in ("positive", "negative")]


def _offset(joint: Joint, model: ResolvedModel, sensor: bool) -> tuple[bool, str]:
    """Return whether the torque has an offset of its own, and the message if another term replaces it."""
    if sensor:
        if joint.torque_offset:
            raise InputError(
                "torque_offset and sensor_offset are the same constant and cannot both be identified",
                argument="torque_offset",
                value=True,
                remedy=Action("call", {"torque_offset": False}, function="Joint"),
            )
        return False, ""
    if joint.torque_offset is None and model.asymmetric and model.gravity != "none":
        # No motion can separate a constant from a difference of Coulomb frictions; it can separate gravity.
        return (
            False,
            "torque_offset: gravity includes all torque that is the same in both directions",
        )
    return joint.torque_offset is not False, ""


def _ordered(
    wanted: set[str], ripple: tuple[float, ...], harmonics: tuple[float, ...]
) -> tuple[str, ...]:
    """Return keys in the core's order; keys with orders replace the row of their family."""
    orders = {"ripple": ripple, "position": harmonics}
    keys: list[str] = []
    rows = _rows()
    for key in sorted(wanted - rows.keys()):
        raise InputError("there is no such term", argument="model", value=key)
    for row, family in rows.items():
        if family:
            keys += [f"{row}_{order:g}" for order in orders[row.split("_")[0]]]
        elif row in wanted:
            keys.append(row)
    return tuple(keys)


@functools.cache
def _models() -> Mapping[str, Sequence[str]]:
    """Return the keys of each model's friction terms."""
    return {entry.name: tuple(entry.terms) for entry in _core.models()}


@functools.cache
def _rows() -> dict[str, bool]:
    """Return the keys of the core's rows, without own terms, and whether each stands for one term per order."""
    return {term.key: term.family for term in _core.terms() if not term.own}


def _coefficients(terms: tuple[str, ...]) -> dict[str, str]:
    """Return name → name and key → name of the terms' coefficients."""
    names = {key: _core.term(key).name for key in terms}
    return names | {name: name for name in names.values()}


def _check_per_recording(names: tuple[str, ...], terms: tuple[str, ...]) -> None:
    known = _coefficients(terms)
    for name in names:
        if name not in known:
            raise InputError(
                f"the model has no term {name}; choose one of {', '.join(dict.fromkeys(known.values()))}",
                argument="per_recording",
                value=list(names),
            )
