"""Checks of a sweep's arguments, and the work that they define."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from jointid.base.advice import Action
from jointid.base.errors import InputError
from jointid.identification.prepared import require_joint
from jointid.identification.search.search import Search
from jointid.joint.joint import Joint
from jointid.problem.recordings import listed
from jointid.problem.settings import stated_model
from jointid.recording.recording import Recording
from jointid.simulation.scenario import Scenario
from jointid.study.grid import cells_of
from jointid.study.work import Work


def _checked(search: Search) -> Search:
    """Return the search of a sweep. Refuse fields that belong to a single run."""
    for name in ("callback", "checkpoint", "resume"):
        if getattr(search, name) is not None:
            raise InputError(
                "a sweep has its own callback and its own file",
                argument=f"search.{name}",
                remedy="leave it out of the search",
            )
    return search


def work_of(
    subject: Recording | Sequence[Recording] | Scenario,
    joint: Joint | None,
    grid: Mapping[str, Any] | None,
    search: Search,
    options: Mapping[str, Any],
    standard_errors: bool,
    tracking: bool,
) -> Work:
    """Return the work of a sweep's arguments.

    Parameters
    ----------
    options : mapping of str to object
        Options of a problem for all cells.

    The other parameters are those of `sweep`.

    Raises
    ------
    InputError
        An argument or a value of the grid cannot be used with any recording.
    """
    search = _checked(search)
    common = {name: value for name, value in options.items() if name != "terms"}
    common["model"] = stated_model(options)
    for name, flag in (("standard_errors", standard_errors), ("tracking", tracking)):
        if not isinstance(flag, bool):
            raise InputError("true or false is expected", argument=name, value=flag)
    require_joint(joint)
    scenario = subject if isinstance(subject, Scenario) else None
    if tracking:
        if scenario is None:
            raise InputError(
                "the tracking error after identification needs a simulation, but recordings are given",
                argument="tracking",
                value=True,
                remedy=Action(
                    "call",
                    {"subject": ...},
                    text="a scenario instead of recordings",
                    function="sweep",
                ),
            )
        scenario.believing(scenario.joint)
    work = Work(
        subject=scenario if scenario is not None else listed(subject),  # type: ignore[arg-type]
        joint=joint,
        common=common,
        search=search,
        cells=cells_of(grid or {}, scenario),
        standard_errors=standard_errors,
        tracking=tracking,
        threads=search.threads,
    )
    for cell in work.cells:  # invalid settings raise here, before the work
        cell.search(search, search.seed, search.threads)
        cell.options(work.common)
    return work
