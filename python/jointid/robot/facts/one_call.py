"""Merge the models that several findings advise into one call, so that one call does not undo another."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace

from jointid.base.advice import Action
from jointid.estimate.findings import Finding
from jointid.joint.model import AUTO, Model
from jointid.robot.links.models import PLAIN, SHAPED

CHOICE = (PLAIN, SHAPED)  # candidates of "auto"


def with_one_call(
    findings: Sequence[Finding], names: Sequence[str], models: Sequence[str]
) -> list[Finding]:
    """Return findings with merged advice: a call that sets the models of some joints sets those of all findings.

    `names` are the joints, and `models` the requested models, one for each joint. Stated models stay. If the model is
    to be chosen automatically, the advised options are added to that choice.
    """
    stated = dict(zip(names, models, strict=True))
    advised: dict[str, str] = {}
    for name, model in _advised(findings):
        asked, wanted = (Model.parse(each) for each in (advised.get(name, stated[name]), model))
        both = wanted.over(asked)
        # An automatic choice stays automatic, with the advised option.
        advised[name] = str(both.replace(name=asked.name) if wanted.name in CHOICE else both)
    if not advised:
        return [*findings]
    kept = {name: model for name, model in stated.items() if model != AUTO}
    every = {**kept, **advised}
    ordered = {name: every[name] for name in names if name in every}
    call = Action("call", {"model": ordered}, function="identify_robot")
    return [
        replace(found, advice=tuple(call if _is_model(each) else each for each in found.advice))
        for found in findings
    ]


def advised_models(findings: Sequence[Finding]) -> dict[str, str]:
    """Return the models by joint that findings advise, from the result of `with_one_call`."""
    return dict(_advised(findings))


def _advised(findings: Sequence[Finding]) -> Iterator[tuple[str, str]]:
    for found in findings:
        for action in found.advice:
            if _is_model(action):
                yield from action.arguments["model"].items()


def _is_model(action: Action) -> bool:
    return action.function == "identify_robot" and isinstance(
        action.arguments.get("model"), Mapping
    )
