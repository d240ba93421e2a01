"""Values that the recording does not determine: large errors, or a strong dependence on windows or noise."""

from __future__ import annotations

import math
from collections.abc import Collection, Iterator, Mapping
from dataclasses import dataclass

from jointid import _core
from jointid.base.advice import Action
from jointid.estimate.findings import Finding, Measured
from jointid.estimate.statistics import ParameterEstimate
from jointid.estimate.wording import percent, two_digits
from jointid.identification.warnings.check import Check, FindingType
from jointid.identification.warnings.evidence import Evidence
from jointid.problem.inner_products import inner

UNDETERMINED = FindingType(
    code="undetermined",
    meaning="a standard error above 5 %; or a value that moves by more than three times its error by chance when "
    "the windows are halved or doubled; or a gain that differs by more than 0.75 % depending on whether the noise "
    "is in the sensor or in the torque; or a gain of the other sign that fits as well; or an inertia that is hidden "
    "by a noisy velocity",
    advice="excite what is missing (the finding says how), or fix the parameter",
)

# A parameter is undetermined above this relative standard error, or when other windows move it by so many.
_LARGE_ERROR = 0.05
_LARGE_SHIFT = 3.0
_NOTICEABLE_SHIFT = 0.01
_INSEPARABLE = 0.98
_PAIRS = 5
# Width between the regressions with the noise in the sensor and with the noise in the torque, over the gain.
_WIDE = 0.0075

_SHOWN = 4  # reasons, and pairs, in the sentence; the evidence has all


@dataclass(frozen=True, slots=True)
class _Reason:
    text: str
    measured: Mapping[str, Measured]


def _find(evidence: Evidence) -> Iterator[Finding]:
    told = {name for each in evidence.undivided for name in each.change}  # by a finding of its own
    reasons: dict[str, list[_Reason]] = {
        p.name: found
        for p in evidence.parameters.values()
        if p.name not in told and (found := _why_undetermined(p, evidence))
    }
    for name, reason in _between_the_regressions(evidence):
        reasons.setdefault(name, [reason])
    guessed = _guessed_sign(evidence)
    if guessed is not None:
        reasons.setdefault("sensor_gain", []).append(guessed)
    if not reasons:
        return
    texts = [", and ".join(each.text for each in found) for found in reasons.values()]
    shown = list(dict.fromkeys(texts))[:_SHOWN]
    more = sum(text not in shown for text in texts)
    cause = "not well determined by this recording: " + "; ".join(shown)
    if more:
        cause += f"; and {more} more parameter{'s' * (more > 1)}"
    measured = {
        name: number
        for found in reasons.values()
        for each in found
        for name, number in each.measured.items()
    }
    if more:
        measured["more_parameters"] = Measured(float(more))
    for (first, second), correlation in _worst_pairs(evidence.correlations, reasons):
        cause += f"; {first} and {second} are indistinguishable (correlation {correlation:.3f})"
        measured[f"{first}.{second}.correlation"] = Measured(correlation)
    yield UNDETERMINED.finding(
        cause,
        *_advice(evidence, reasons, guessed is not None),
        evidence=measured,
        parameters=tuple(name for name in evidence.parameters if name in reasons),
    )


def _worst_pairs(
    correlations: Mapping[tuple[str, str], float], names: Collection[str]
) -> list[tuple[tuple[str, str], float]]:
    """The pairs with one of the parameters `names` that the recording separates least; a few of possibly thousands."""
    pairs = [
        (pair, correlation)
        for pair, correlation in correlations.items()
        if abs(correlation) > _INSEPARABLE and set(pair) & set(names)
    ]
    return sorted(pairs, key=lambda entry: -abs(entry[1]))[:_PAIRS]


def _advice(
    evidence: Evidence, reasons: Mapping[str, list[_Reason]], sign_was_guessed: bool
) -> Iterator[Action]:
    kinds = [_kind(name) for name in reasons]
    motions = dict.fromkeys(filter(None, map(_motion, reasons)))
    if motions:
        yield Action("record", text="; ".join(motions))
    if "inertia" in kinds:
        text = "the drive's data sheet: an inertia that is known need not be identified"
        yield Action("inspect", text=text)
    if sign_was_guessed:
        gain = evidence.parameters["sensor_gain"].value
        # A bound of 0 is refused: the sensor's residual is divided by the gain.
        bound = {"sensor_gain": {"min" if gain > 0.0 else "max": float(f"{0.01 * gain:.1e}")}}
        yield Action("call", {"parameters": bound}, text="if that is its sign")


def _motion(name: str) -> str:
    """Which motion determines a parameter, whatever its order or recording; from the terms' table."""
    base = name.split("[")[0]
    for term in _core.terms():
        if base == term.name or (term.family and base.startswith(f"{term.name}_")):
            return term.advice
    return next((shape.advice for shape in _core.shapes() if shape.name == base), "")


def _kind(name: str) -> str:
    """A parameter's name without direction and recording."""
    return name.split("[")[0].removesuffix("_positive").removesuffix("_negative")


def _scale(p: ParameterEstimate, evidence: Evidence) -> float:
    """Reference of the 5 %: an offset, or one phase of a harmonic, may be zero."""
    if "offset" in p.name:
        return max(abs(p.value), evidence.torque_level)
    family, _, rest = p.name.partition("_")
    if family in ("gravity", "ripple", "position"):
        order = rest.partition("_")[2]
        pair = [
            other.value
            for phase in ("cos", "sin")
            if (other := evidence.parameters.get(f"{family}_{phase}{'_' if order else ''}{order}"))
        ]
        return math.hypot(*pair)
    return abs(p.value)


def _why_undetermined(p: ParameterEstimate, evidence: Evidence) -> list[_Reason]:
    if p.name == "inertia" and p.vary and evidence.penalty.noise_limited:
        return [_Reason("inertia is hidden by the noise of the velocity, whatever the windows", {})]
    if p.stderr is None:
        return []
    scale = _scale(p, evidence)
    reasons = []
    if p.stderr > _LARGE_ERROR * scale:
        relative = scale == abs(p.value) and scale > 0.0
        error = Measured(p.stderr / scale) if relative else Measured(p.stderr, p.unit)
        text = (
            f"{p.name} has a standard error of {percent(p.stderr / scale) if relative else _with_unit(p)}"
            if p.stderr < 10.0 * scale
            else f"{p.name} is not excited"
        )
        reasons.append(_Reason(text, {f"{p.name}.stderr": error}))
    chance = evidence.chance[p.name]  # a shift is part of p.stderr, and would hide itself
    shift = max(abs(p.shift_halved or 0.0), abs(p.shift_doubled or 0.0))
    if scale > 0.0 and shift > _LARGE_SHIFT * chance and shift > _NOTICEABLE_SHIFT * scale:
        text = (
            f"{p.name} moves by {percent(shift / scale)} ({shift / chance:.1f} times its error by chance) when the "
            "windows are halved or doubled"
        )
        measured = {
            f"{p.name}.shift": Measured(shift / scale),
            f"{p.name}.shift_over_chance": Measured(shift / chance),
        }
        reasons.append(_Reason(text, measured))
    return reasons


def _with_unit(p: ParameterEstimate) -> str:
    """The standard error as the table has it."""
    return f"{two_digits(p.stderr or 0.0)} {p.unit}".rstrip()


def _guessed_sign(evidence: Evidence) -> _Reason | None:
    gain = evidence.parameters.get("sensor_gain")
    if gain is None or not gain.vary or not evidence.guessed_sign:
        return None
    sign = "negative" if gain.value > 0.0 else "positive"
    return _Reason(f"a {sign} sensor_gain fits almost as well", {})


def _between_the_regressions(evidence: Evidence) -> Iterator[tuple[str, _Reason]]:
    """Gain and offset, where the sensor's own noise is not small against its signal.

    With the noise in the sensor the gain is the value of one regression, with the noise in the torque
    that of the reverse one; the truth lies between (Frisch's bounds). Their distance is the noise that
    the windows leave, over the part of the reading that no other term explains: it grows as windows
    shrink, where the standard error, which takes the place of the noise for granted, shows nothing.
    """
    width = noise_width(evidence)
    if width <= _WIDE:
        return
    text = (
        f"sensor_gain differs by {percent(width)} depending on whether the noise is in the sensor or in the torque, "
        "and more with shorter windows, because the sensed torque hardly varies"
    )
    reason = _Reason(text, {"sensor_gain.noise_width": Measured(width)})
    for name in ("sensor_gain", "sensor_offset"):
        if name in evidence.parameters and evidence.parameters[name].vary:
            yield name, reason


def noise_width(evidence: Evidence) -> float:
    """Distance of the two regressions of the gain, over the gain; 0 without a free gain."""
    gain = evidence.parameters.get("sensor_gain")
    if gain is None or not gain.vary:
        return 0.0
    regressor = evidence.at_best
    free = [
        regressor.names.index(name)
        for name, p in evidence.parameters.items()
        if name in regressor.names and p.vary and p.at_bound is None and name != "sensor_gain"
    ]
    own = regressor.norm("sensor_gain")
    if free:
        reading = regressor.names.index("sensor_gain")
        own = regressor.triangle.solve(free, reading, rcond=1e-10)[1]
    residual = evidence.residual
    if evidence.penalty.residual != _core.Residual.sensor:
        residual = residual / (gain.value or 1e-300)
    freedom = max(1, residual.size - len(free) - 1)
    noise = inner(residual, residual) * residual.size / freedom
    return noise / max(own**2, 1e-300)


CHECK = Check(_find, (UNDETERMINED,))
