"""A joint's torque law as expressions in a programming language."""

from __future__ import annotations

import re
from collections.abc import Callable, Sequence
from dataclasses import dataclass

from jointid.exports.identifiers import parameter_identifier
from jointid.exports.law import FrictionTerm, Function, Harmonic, Law, Over

_PARTS: dict[Over, tuple[str, str]] = {
    "gravity": ("gravity_cos", "gravity_sin"),
    "harmonics": ("position_cos_{}", "position_sin_{}"),
    "ripple": ("ripple_cos_{}", "ripple_sin_{}"),
}


@dataclass(frozen=True, slots=True, kw_only=True)
class Language:
    """Notation of a law's elements in a language."""

    name: Callable[[str], str]  # returns a constant's name for a parameter's name
    number: Callable[[float], str]
    exp: str
    log: str
    sin: str
    cos: str


def fading(law: Law, side: int, language: Language) -> list[str]:
    """Return the summands of one direction's friction that remain at low speed. They use `speed` and `load_size`."""
    return [_summand(each, language) for each in _of_side(law, side) if not each.vanishes]


def growing(law: Law, side: int, language: Language) -> list[str]:
    """Return the summands of one direction's friction that are zero at zero speed."""
    return [_summand(each, language) for each in _of_side(law, side) if each.vanishes]


def _of_side(law: Law, side: int) -> list[FrictionTerm]:
    return [each for each in law.friction if each.term.side in (0, side)]


def _summand(term: FrictionTerm, language: Language) -> str:
    value = language.name(term.term.name)
    if not term.term.expression:
        return value
    words = {"exp": language.exp, "log": language.log}
    words |= {name: language.name(name) for name in term.shapes}
    basis = re.sub(r"[a-z_]\w*", lambda word: words.get(word[0], word[0]), term.term.expression)
    basis = re.sub(r"\b\d+\.\d+\b", lambda number: language.number(float(number[0])), basis)
    return f"({value} * {basis})"


def periodic(law: Law, kind: Over, angle: str, language: Language) -> list[str]:
    """Return the summands of the torque over an angle."""
    summands = []
    for each in law.over(kind):
        cos, sin = harmonic_names(each)
        turned = angle if each.order == 1.0 else f"{language.number(each.order)} * {angle}"
        summands.append(f"({language.name(cos)} * {language.cos}({turned}))")
        summands.append(f"({language.name(sin)} * {language.sin}({turned}))")
    return summands


def centred(law: Law, kind: Function, language: Language, *, slope: bool = False) -> list[str]:
    """Return the summands of own functions of `position`, or of their derivatives."""
    if not law.functions(kind):
        return []
    cos, sin, centre = (language.name(name) for name in _centred_names(kind))
    angle = f"position - {centre}"
    if slope:
        return [f"({sin} * {language.cos}({angle}))", f"(-({cos} * {language.sin}({angle})))"]
    one = language.number(1.0)
    return [
        f"({cos} * ({language.cos}({angle}) - {one}))",
        f"({sin} * {language.sin}({angle}))",
    ]


def _centred_names(kind: Function) -> tuple[str, str, str]:
    return f"{kind}_cos_of_position", f"{kind}_sin_of_position", f"{kind}_centre"


def harmonic_names(harmonic: Harmonic) -> tuple[str, str]:
    """Return the names of a harmonic's two coefficients."""
    cos, sin = _PARTS[harmonic.over]
    return cos.format(f"{harmonic.order:g}"), sin.format(f"{harmonic.order:g}")


def total(summands: Sequence[str], nothing: str) -> str:
    """Return the sum, or `nothing` for an empty one."""
    return " + ".join(summands) if summands else nothing


def constants(law: Law) -> dict[str, float]:
    """Return the law's numbers by parameter name, each once."""
    values: dict[str, float] = {}
    for term in law.friction:
        values |= {term.term.name: term.value, **term.shapes}
    for each in law.harmonics:
        cos, sin = harmonic_names(each)
        values |= {cos: each.cos, sin: each.sin}
    for own in law.centred:
        names = _centred_names(own.kind)
        values |= dict(zip(names, (own.cos, own.sin, own.centre), strict=True))
    return values


def origin(parameter: str) -> str:
    """Return the source of a number in the law that is not a parameter."""
    return (
        "centre angle of the terms that depend on the position"
        if parameter.endswith("_centre")
        else "from the link"
    )


def upper(name: str) -> str:
    """Return a parameter's name as the name of a constant."""
    return parameter_identifier(name).upper()
