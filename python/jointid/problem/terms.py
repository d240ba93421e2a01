"""Which terms the torque balance of a joint has, told from the joint, the recordings and the call."""

from collections.abc import Collection, Sequence
from dataclasses import dataclass, replace

from jointid import _core
from jointid.base.errors import InputError, shown
from jointid.joint.joint import Joint
from jointid.joint.parameters import order_list
from jointid.recording.recording import Recording

_GRAVITY = ("gravity_cos", "gravity_sin")
_SENSOR = ("sensor_gain", "sensor_offset")


@dataclass(frozen=True, slots=True, kw_only=True)
class Request:
    """What a call asks of the model; None leaves it to the joint."""

    model: str | None = None
    residual: str | None = None
    asymmetric: bool | None = None
    ripple: Collection[float] | None = None
    harmonics: Collection[float] | None = None
    load_friction: bool | None = None
    per_recording: Collection[str] = ()


@dataclass(frozen=True, slots=True, kw_only=True)
class TermChoice:
    """The terms of one identification, in canonical order, and what the residual is compared with.

    Attributes
    ----------
    terms : tuple of str
        Keys of the core's terms.
    dropped : str
        A term that another one makes superfluous, and why; empty if none.
    """

    terms: tuple[str, ...]
    model: str
    residual: str
    sensor: bool
    asymmetric: bool = False
    ripple: tuple[float, ...] = ()
    harmonics: tuple[float, ...] = ()
    load_friction: bool = False
    per_recording: tuple[str, ...] = ()
    gear_ratio: float = 1.0
    dropped: str = ""


def _known(name: str, known: Sequence[str], what: str) -> str:
    if name not in known:
        raise InputError(f"{what} '{name}' is not known; known are {', '.join(known)}")
    return name


def _check_kind(recordings: Sequence[Recording], joint: Joint | None) -> None:
    if joint is not None and recordings[0].kind != joint.kind:
        raise InputError(
            f"the recording is {recordings[0].kind}, joint '{joint.name}' is {joint.kind}; check the position's unit, "
            "or the joint's kind"
        )


def _has_sensor(recordings: Sequence[Recording], joint: Joint | None) -> bool:
    if joint is None:
        return all(recording.sensor is not None for recording in recordings)
    if joint.sensor:
        for number, recording in enumerate(recordings):
            if recording.sensor is None:
                raise InputError(
                    f"joint '{joint.name}' has a torque sensor, but recording {number} has no signal "
                    "'sensor'; map it with columns={'sensor': ...}, or drop [sensor] from the joint"
                )
    return joint.sensor


def choose_terms(
    recordings: Sequence[Recording], joint: Joint | None, request: Request
) -> TermChoice:
    """Terms of the torque balance: inertia, friction, then gravity, offset, harmonics and sensor.

    Raises
    ------
    InputError
        An unknown model or residual; a sensor residual without a sensor; collinear terms.
    """
    models = {entry.name: entry for entry in _core.models()}
    base = joint if joint is not None else Joint()
    name = _known(request.model or base.friction, tuple(models), "model")
    _check_kind(recordings, joint)
    sensor = _has_sensor(recordings, joint)
    residual = request.residual or ("sensor" if sensor else "torque")
    compared = _known(residual, ("sensor", "torque"), "residual")
    if compared == "sensor" and not sensor:
        raise InputError(
            "residual 'sensor' needs a torque sensor in the recording; use residual='torque'"
        )
    choice = TermChoice(
        terms=(),
        model=name,
        residual=compared,
        sensor=sensor,
        asymmetric=base.asymmetric if request.asymmetric is None else bool(request.asymmetric),
        ripple=_orders("ripple", request.ripple, base.ripple),
        harmonics=_orders("harmonics", request.harmonics, base.harmonics),
        load_friction=base.load_friction
        if request.load_friction is None
        else bool(request.load_friction),
        per_recording=_shared_not(request.per_recording) if len(recordings) > 1 else (),
        gear_ratio=base.gear_ratio,
    )
    if choice.ripple and joint is None:
        raise InputError("ripple counts turns of the motor: give a joint with its gear_ratio")
    offset, dropped = _offset(base, choice)
    wanted = {"inertia", *_friction(models[name].terms, choice.asymmetric)}
    wanted.update(_GRAVITY if base.gravity != "none" else ())
    wanted.update(_SENSOR if sensor else ())
    wanted.update(("load_friction",) if choice.load_friction else ())
    wanted.update(("torque_offset",) if offset else ())
    if base.gravity != "none" and 1.0 in choice.harmonics:
        raise InputError(
            "harmonics: order 1 over the joint's angle is what gravity is; drop it, or set gravity = 'none'"
        )
    return replace(choice, terms=_ordered(wanted, choice), dropped=dropped)


def _orders(
    name: str, asked: Collection[float] | None, known: tuple[float, ...]
) -> tuple[float, ...]:
    return known if asked is None else order_list("identify", name, asked)


def _shared_not(names: object) -> tuple[str, ...]:
    if isinstance(names, str) or not isinstance(names, Collection):
        raise InputError(
            f"per_recording is {shown(names)}; a list of names like ('sensor_offset',) is expected"
        )
    return tuple(names)


def _friction(terms: Sequence[str], asymmetric: bool) -> list[str]:
    if not asymmetric:
        return list(terms)
    return [f"{term}_{side}" for term in terms for side in ("positive", "negative")]


def _offset(joint: Joint, choice: TermChoice) -> tuple[bool, str]:
    """Whether the torque has an offset of its own, and what is said when it has not."""
    if choice.sensor:
        if joint.torque_offset:
            raise InputError(
                "torque_offset and sensor_offset are the same constant and cannot both be identified; "
                "set torque_offset = false in the joint's [model]"
            )
        return False, ""
    if choice.asymmetric:
        if joint.torque_offset:
            raise InputError(
                "torque_offset and asymmetric Coulomb friction are the same where the joint moves; set torque_offset = "
                "false in the joint's [model], or asymmetric=False"
            )
        return False, "torque_offset: asymmetric Coulomb friction holds it"
    return joint.torque_offset is not False, ""


def _ordered(wanted: set[str], choice: TermChoice) -> tuple[str, ...]:
    """Keys in the core's order; a family's row gives way to its orders."""
    orders = {"ripple": choice.ripple, "position": choice.harmonics}
    keys: list[str] = []
    for term in _core.terms():
        if term.family:
            keys += [f"{term.key}_{order:g}" for order in orders[term.key.split("_")[0]]]
        elif term.key in wanted:
            keys.append(term.key)
    return tuple(keys)
