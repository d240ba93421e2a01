"""The header of a study: the first line of its file, with the study's fingerprint."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Mapping
from typing import Any

from jointid import _core
from jointid.base.errors import InputError
from jointid.joint.checks import finite_number, suggestion
from jointid.simulation.scenario import Scenario
from jointid.study.saved_header import FORMAT, SCHEMA
from jointid.study.work import Work


def header_of_work(work: Work, trials: int, truth: Mapping[str, float] | None) -> dict[str, Any]:
    """Return the first line of the study's file.

    Parameters
    ----------
    work : Work
    trials : int
        Number of trials of each cell.
    truth : mapping of str to float or None
        True parameters from the call.

    Raises
    ------
    InputError
        The truth is not a mapping of names to numbers.
    """
    subject = work.subject
    simulated = isinstance(subject, Scenario)
    settings: dict[str, Any] = {
        "subject": repr(subject)
        if isinstance(subject, Scenario)
        else [{"name": run.name, "fingerprint": run.fingerprint} for run in subject],
        "joint": None if work.joint is None else repr(work.joint),
        "options": {name: repr(value) for name, value in sorted(work.common.items())},
        "search": repr((work.search.chosen_method, work.search.ga or "default")),
        "standard_errors": work.standard_errors,
        "tracking": work.tracking,
        "version": _core.__version__,
    }
    header = {
        "format": FORMAT,
        "schema": SCHEMA,
        "version": _core.__version__,
        "swept": list(work.cells[0].labels),
        "cells": [cell.labels for cell in work.cells],
        "seed": work.seed,
        "settings": settings,
    }
    values = [{n: repr(v) for n, v in cell.values.items()} for cell in work.cells]
    holds = [] if simulated else [(run.kind, run.torque_hold, repr(run.gaps)) for run in subject]  # type: ignore[union-attr]
    text = json.dumps([header, values, holds], sort_keys=True)
    fingerprint = hashlib.sha256(text.encode()).hexdigest()[:16]
    settings["fingerprint"] = fingerprint
    return header | {
        "fingerprint": fingerprint,
        "trials": trials,
        "truth": _truth(work, truth),
        "truths": _truths(work, truth),
    }


def _truth(work: Work, given: Mapping[str, float] | None) -> dict[str, float]:
    """Return the true parameters: from the call, otherwise those that are the same for all recordings."""
    if given is not None:
        if not isinstance(given, Mapping):
            raise InputError(
                "a mapping of parameters to numbers is expected", argument="truth", value=given
            )
        for name in given:
            if not isinstance(name, str) or not _core.is_parameter(name.partition("[")[0]):
                known = suggestion(name, _core.parameter_names())
                raise InputError(
                    f"there is no such parameter; {known}", argument=str(name), place="truth"
                )
        return {str(name): finite_number("truth", str(name), v) for name, v in given.items()}
    if isinstance(work.subject, Scenario):
        return work.subject.truth
    tables = [dict(run.truth or {}) for run in work.subject]
    return {
        name: float(value)
        for name, value in tables[0].items()
        if isinstance(value, int | float) and all(table.get(name) == value for table in tables)
    }


def _truths(work: Work, given: Mapping[str, float] | None) -> list[dict[str, float]]:
    """Return the true parameters of each cell if cells differ, otherwise an empty list."""
    if not isinstance(work.subject, Scenario) or given is not None:
        return []
    truths = []
    for cell in work.cells:
        try:
            truths.append(cell.scenario(work.subject).truth)
        except InputError:  # the cell's rows are refused with this error
            truths.append({})
    return truths if any(truth != truths[0] for truth in truths) else []
