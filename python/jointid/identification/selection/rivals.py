"""The models that are compared where nobody names one."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from jointid import _core
from jointid.base.errors import InputError
from jointid.base.values import dataclass
from jointid.joint.checks import check_mapping
from jointid.joint.joint import Joint
from jointid.joint.model import Gravity, Model
from jointid.joint.own_terms import TORQUES, OwnTerms
from jointid.problem.terms import Request, TermChoice, choose_terms
from jointid.recording.recording import Recording

NAMES = ("coulomb_viscous", "stribeck")
"""Of the friction models that compete; richer ones are proposed by findings."""

_GRAVITY_ORDER = 1.0


@dataclass(frozen=True, slots=True, kw_only=True)
class Candidate:
    """A model that competes.

    Attributes
    ----------
    model : Model
        The call's fields, with the name and gravity of this candidate.
    choice : TermChoice
    """

    model: Model
    choice: TermChoice


def candidates(
    runs: Sequence[Recording], joint: Joint | None, request: Request, parameters: object
) -> tuple[Candidate, ...]:
    """Return the models that compete, the simplest first; the last one has the terms of all.

    Gravity competes where it is not stated and where only the drive's torque shows it: on a revolute
    joint without a torque sensor, without a harmonic of order 1, and without an own term that is a torque: who
    states a model's torque has stated its gravity. Of a described link the weight competes as it is described, too.

    Parameters
    ----------
    request : Request
        Its model may lack a name.
    parameters : mapping or None
        As in `identify`: a model that lacks one of them does not compete, unless every model does.

    Raises
    ------
    InputError
        Terms that cannot be used with these recordings; `parameters` is no mapping from names.
    """
    stated = request.model if joint is None else request.model.over(joint.model)

    def candidate(name: str, gravity: Gravity | None) -> Candidate:
        own = request.model.replace(name=name, gravity=gravity)
        choice = choose_terms(runs, joint, replace(request, model=own))
        return Candidate(model=stated.replace(name=name, gravity=gravity), choice=choice)

    gravities: tuple[Gravity | None, ...] = (stated.gravity,)
    simplest = candidate(NAMES[0], stated.gravity)
    if stated.gravity is None and _may_load(runs, stated, simplest.choice):
        # Who describes a link need not have thought of its weight; on an upright axis it has none.
        described = joint is not None and joint.link is not None
        gravities = ("none", "known", "free") if described else ("none", "free")
    made = tuple(candidate(name, gravity) for gravity in gravities for name in NAMES)
    wanted = {name.partition("[")[0] for name in _named(parameters)}
    fitting = tuple(each for each in made if wanted <= _parameters(each.choice))
    return fitting or made


def _may_load(runs: Sequence[Recording], stated: Model, choice: TermChoice) -> bool:
    return (
        runs[0].kind == "revolute"
        and not choice.sensor
        and _GRAVITY_ORDER not in (stated.harmonics or ())
        and not any(
            own.kind in TORQUES and not own.rate for own in OwnTerms.of(stated.terms or {}).each
        )
    )


def _named(parameters: object) -> list[str]:
    if parameters is None:
        return []
    check_mapping("", "parameters", parameters)
    return [str(name) for name in parameters]  # type: ignore[attr-defined]


def _parameters(choice: TermChoice) -> set[str]:
    found: set[str] = set()
    for key in choice.terms:
        try:
            term = _core.term(key)
        except InputError:
            continue
        found.update((term.name, *term.shapes))
    return found
