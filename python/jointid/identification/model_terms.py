"""Which terms the torque balance of a joint has, told from the joint, the recordings and the call."""

from collections.abc import Sequence
from dataclasses import dataclass

from jointid import _core
from jointid.errors import InputError
from jointid.joint.joint import Joint
from jointid.recording.recording import Recording

_GRAVITY = ("gravity_cos", "gravity_sin")
_SENSOR = ("sensor_gain", "sensor_offset")


@dataclass(frozen=True, slots=True, kw_only=True)
class TermChoice:
    """The terms of one identification, in canonical order, and what the residual is compared with."""

    terms: tuple[str, ...]
    model: str
    residual: str
    sensor: bool


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
    recordings: Sequence[Recording], joint: Joint | None, model: str | None, residual: str | None
) -> TermChoice:
    """Terms of the torque balance: inertia, friction, then gravity, offset and sensor as the joint has them.

    Raises
    ------
    InputError
        An unknown model or residual; a sensor residual without a sensor; collinear offsets.
    """
    models = {entry.name: entry for entry in _core.models()}
    name = _known(
        model or (joint.friction if joint is not None else "coulomb_viscous"),
        tuple(models),
        "model",
    )
    _check_kind(recordings, joint)
    sensor = _has_sensor(recordings, joint)
    compared = _known(
        residual or ("sensor" if sensor else "torque"), ("sensor", "torque"), "residual"
    )
    if compared == "sensor" and not sensor:
        raise InputError(
            "residual 'sensor' needs a torque sensor in the recording; use residual='torque'"
        )
    wanted = {"inertia", *models[name].terms}
    if joint is not None and joint.gravity != "none":
        wanted.update(_GRAVITY)
    offset = (
        joint.torque_offset if joint is not None and joint.torque_offset is not None else not sensor
    )
    if sensor:
        wanted.update(_SENSOR)
        if offset:
            raise InputError(
                "torque_offset and sensor_offset are the same constant and cannot both be identified; "
                "set torque_offset = false in the joint's [model]"
            )
    if offset:
        wanted.add("torque_offset")
    ordered = tuple(term.name for term in _core.terms() if term.name in wanted)
    return TermChoice(terms=ordered, model=name, residual=compared, sensor=sensor)
