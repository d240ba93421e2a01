"""Candidate models when the caller names none."""

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
"""Names of the candidate friction models; findings propose richer ones."""

_GRAVITY_ORDER = 1.0


@dataclass(frozen=True, slots=True, kw_only=True)
class Candidate:
    """Candidate model.

    Attributes
    ----------
    model : Model
        Fields of the call, with the name and gravity of this candidate.
    choice : TermChoice
    """

    model: Model
    choice: TermChoice


def candidates(
    runs: Sequence[Recording], joint: Joint | None, request: Request, parameters: object
) -> tuple[Candidate, ...]:
    """Return the candidate models, the simplest first; the last one has the terms of all.

    Candidates with gravity exist if the caller does not set gravity and only the drive's torque shows it. The joint is
    then revolute, without torque sensor, harmonic of order 1, or own torque term, which may already contain gravity.
    If the joint describes a link, the described weight is a further candidate.

    Parameters
    ----------
    request : Request
        Request of the call; its model may lack a name.
    parameters : mapping or None
        Parameters of the call, as in `identify`. A model that lacks one of them is no candidate, unless all do.

    Raises
    ------
    InputError
        The recordings do not support the terms, or `parameters` is not a mapping from names.
    """
    stated = request.model if joint is None else request.model.over(joint.model)

    def candidate(name: str, gravity: Gravity | None) -> Candidate:
        own = request.model.replace(name=name, gravity=gravity)
        choice = choose_terms(runs, joint, replace(request, model=own))
        return Candidate(model=stated.replace(name=name, gravity=gravity), choice=choice)

    gravities: tuple[Gravity | None, ...] = (stated.gravity,)
    simplest = candidate(NAMES[0], stated.gravity)
    if stated.gravity is None and _may_load(runs, stated, simplest.choice):
        # A described link need not cause a gravity torque, for example on a vertical axis.
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
