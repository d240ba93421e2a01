"""Bounds and fixed values of parameters from the joint and the call."""

from collections.abc import Mapping

from jointid.base.errors import InputError
from jointid.joint.joint import Joint
from jointid.joint.own_terms import is_fixed
from jointid.joint.parameters import Parameter, merge


def known_parameters(
    names: tuple[str, ...],
    joint: Joint | None,
    changes: Mapping[str, float | Mapping[str, object] | Parameter] | None,
) -> list[Parameter]:
    """Return value and bounds of each parameter, set by joint and call.

    A parameter of one recording, such as `sensor_offset[1]`, takes those of the shared parameter.

    Raises
    ------
    InputError
        The same errors as in `parameter_bounds`.
    """
    table = parameter_bounds(names, joint, changes)
    return [
        table.get(name) or table.get(name.split("[")[0]) or Parameter(name=name) for name in names
    ]


def parameter_bounds(
    names: tuple[str, ...],
    joint: Joint | None,
    changes: Mapping[str, float | Mapping[str, object] | Parameter] | None,
) -> dict[str, Parameter]:
    """Return value and bounds, set by joint and call, of the parameters `names` and of others in the joint.

    Parameters
    ----------
    names : tuple of str
        Parameters of the identification.
    joint : Joint or None
    changes : mapping or None
        Argument `parameters` of the call; it overrides the joint.

    Raises
    ------
    InputError
        The call names a parameter that is not in `names`, or the bounds contradict each other.
    """
    gains = {n: Parameter(name=n, value=1.0, vary=False) for n in names if is_fixed(n)}
    table = merge(gains | known_values(joint), joint.parameters if joint is not None else {})
    table = merge(
        table, {name: _freed(table, name, entry) for name, entry in (changes or {}).items()}
    )
    for name in changes or {}:
        if name not in names and not any(other.startswith(f"{name}[") for other in names):
            raise InputError(
                f"this identification has no such parameter; its parameters are {', '.join(names)}",
                argument=name,
                place="parameters",
            )
    return table


def known_values(joint: Joint | None) -> dict[str, Parameter]:
    """Return the parameters that the joint fixes: known inertia and known gravity."""
    values: dict[str, Parameter] = {}
    if joint is None:
        return values
    inertia = joint.known_inertia
    if inertia is not None:
        values["inertia"] = Parameter(name="inertia", value=inertia, vary=False)
        if joint.link is not None:
            share = joint.link_inertia / (joint.link_inertia + (joint.reflected_inertia or 0.0))
            values["link_share"] = Parameter(name="link_share", value=share, vary=False)
    if joint.model.resolved.gravity == "known":
        gravity = joint.gravity_coefficients
        values["gravity_cos"] = Parameter(name="gravity_cos", value=gravity.cos, vary=False)
        values["gravity_sin"] = Parameter(name="gravity_sin", value=gravity.sin, vary=False)
    return values


def _freed(
    table: Mapping[str, Parameter], name: str, entry: float | Mapping[str, object] | Parameter
) -> float | Mapping[str, object] | Parameter:
    """Return the entry of a call. Bounds make a parameter free that the joint fixes."""
    fixed = name in table and not table[name].vary
    if (
        fixed
        and isinstance(entry, Mapping)
        and {"min", "max"} & entry.keys()
        and "vary" not in entry
    ):
        return {"value": None, **entry, "vary": True}
    return entry
