"""What the recording does not determine: undetermined values, values on bounds, models that are too rich."""

from __future__ import annotations

import math
from collections.abc import Iterator

from jointid import _core
from jointid.estimate.statistics import ParameterEstimate, Warned
from jointid.estimate.wording import percent, two_digits
from jointid.identification.warnings.evidence import Facts
from jointid.problem.inner_products import inner

# A parameter is undetermined above this relative standard error, or when other windows move it by so many.
_LARGE_ERROR = 0.05
_LARGE_SHIFT = 3.0
_NOTICEABLE_SHIFT = 0.01
_INSEPARABLE = 0.98
# Width between the regressions with the noise in the sensor and with the noise in the torque, over the gain.
_WIDE = 0.0075

_STATIC = ("static", "static_positive", "static_negative")
_COULOMB = ("coulomb", "coulomb_positive", "coulomb_negative")
_SHAPES = ("stribeck", "stribeck_velocity", "stribeck_exponent")


def _richness(facts: Facts) -> str | None:
    """Why the data do not carry a static excess, or None when they do."""
    found = facts.parameters
    static = [found[name] for name in _STATIC if name in found and found[name].vary]
    if not static:
        return None
    for p in (*static, *(found[name] for name in _COULOMB if name in found)):
        if p.at_bound == "min":
            return f"{p.name} friction ended at its lower bound"
    for p in static:
        if p.stderr is not None and p.stderr > 0.5 * abs(p.value):
            return f"{p.name} friction is {p.value:.3g} with a standard error of {percent(p.stderr / abs(p.value))}"
    for name in _SHAPES:
        if name in found and found[name].at_bound is not None and name in facts.bounds_from_data:
            return f"the shape {name} ended on the bound of what the data could show"
    return None


def model_too_rich(facts: Facts) -> Iterator[Warned]:
    """A Stribeck model on data that do not carry it."""
    reason = _richness(facts)
    if reason is not None:
        yield Warned(
            code="model_too_rich",
            parameters=tuple(p for p in (*_COULOMB, *_STATIC, *_SHAPES) if p in facts.parameters),
            message=(
                f"the data do not carry the model '{facts.model}': {reason}; "
                "use model='coulomb_viscous', or record slow motion through zero speed"
            ),
        )


def at_bound(facts: Facts) -> Iterator[Warned]:
    """Values that ended on a bound."""
    told = (*_STATIC, *_SHAPES) if _richness(facts) is not None else ()
    for p in facts.parameters.values():
        if p.at_bound is None or p.name in told:
            continue
        limit = p.min if p.at_bound == "min" else p.max
        side = "lower" if p.at_bound == "min" else "upper"
        yield Warned(
            code="at_bound",
            parameters=(p.name,),
            message=(
                f"{p.name} ended at its {side} bound {limit:.6g} {p.unit}: the best value lies beyond it, "
                "or the data do not determine it; other values are affected"
            ),
        )


def undetermined(facts: Facts) -> Iterator[Warned]:
    """Values that another choice of windows, of noise, or chance itself would have made quite different."""
    reasons = {
        p.name: reason
        for p in facts.parameters.values()
        if (reason := _why_undetermined(p, facts)) is not None
    }
    for name, reason in _between_the_regressions(facts):
        reasons.setdefault(name, reason)
    for name, reason in _with_a_guessed_sign(facts):
        reasons[name] = ", and ".join((*reasons.get(name, "").splitlines(), reason))
    if not reasons:
        return
    message = "not well determined by this recording: " + "; ".join(dict.fromkeys(reasons.values()))
    for (first, second), correlation in facts.correlations.items():
        if abs(correlation) > _INSEPARABLE and {first, second} & reasons.keys():
            message += (
                f"; {first} and {second} can hardly be told apart (correlation {correlation:.3f})"
            )
    advice = dict.fromkeys(filter(None, map(_advice, reasons)))
    yield Warned(
        code="undetermined",
        parameters=tuple(name for name in facts.parameters if name in reasons),
        message=message + (" — " + "; ".join(advice) if advice else ""),
    )


def _advice(name: str) -> str:
    """Which motion determines a parameter, whatever its order or recording."""
    base = name.split("[")[0]
    for term in _core.terms():
        if base == term.name or (term.family and base.startswith(f"{term.name}_")):
            return term.advice
    return next((shape.advice for shape in _core.shapes() if shape.name == base), "")


def _scale(p: ParameterEstimate, facts: Facts) -> float:
    """What 5 % refers to: an offset may rightly be zero, and so may one phase of a harmonic."""
    if "offset" in p.name:
        return max(abs(p.value), facts.torque_level)
    family, _, rest = p.name.partition("_")
    if family in ("gravity", "ripple", "position"):
        order = rest.partition("_")[2]
        pair = [
            other.value
            for phase in ("cos", "sin")
            if (other := facts.parameters.get(f"{family}_{phase}{'_' if order else ''}{order}"))
        ]
        return math.hypot(*pair)
    return abs(p.value)


def _why_undetermined(p: ParameterEstimate, facts: Facts) -> str | None:
    if p.name == "inertia" and p.vary and facts.penalty.noise_limited:
        return "inertia hides in the noise of the velocity, whatever the windows"
    if p.stderr is None:
        return None
    scale = _scale(p, facts)
    reasons = []
    if p.stderr > _LARGE_ERROR * scale:
        told = percent(p.stderr / scale) if scale == abs(p.value) else _with_unit(p)
        reasons.append(
            f"{p.name} has a standard error of {told}"
            if p.stderr < 10.0 * scale
            else f"{p.name} is not excited"
        )
    chance = facts.chance[p.name]  # a shift is part of p.stderr, and would hide itself
    shift = max(abs(p.shift_halved or 0.0), abs(p.shift_doubled or 0.0))
    if shift > _LARGE_SHIFT * chance and shift > _NOTICEABLE_SHIFT * scale:
        reasons.append(
            f"{p.name} moves by {percent(shift / scale)} ({shift / chance:.1f} times its error by chance) when the "
            "windows are halved or doubled"
        )
    return ", and ".join(reasons) or None


def _with_unit(p: ParameterEstimate) -> str:
    """The standard error as the table has it."""
    return f"{two_digits(p.stderr or 0.0)} {p.unit}".rstrip()


def _with_a_guessed_sign(facts: Facts) -> Iterator[tuple[str, str]]:
    gain = facts.parameters.get("sensor_gain")
    if gain is not None and gain.vary and facts.guessed_sign:
        sign = "negative" if gain.value > 0.0 else "positive"
        yield (
            "sensor_gain",
            f"a {sign} sensor_gain fits almost as well (give it a value or bounds, if its sign is known)",
        )


def _between_the_regressions(facts: Facts) -> Iterator[tuple[str, str]]:
    """Gain, and the offset that hangs on it, where the sensor's own noise is not small against its signal.

    With the noise in the sensor the gain is the value of one regression, with the noise in the torque
    that of the reverse one; the truth lies between (Frisch's bounds). Their distance is the noise that
    the windows leave, over the part of the reading that no other term explains: it grows as windows
    shrink, where the standard error, which takes the place of the noise for granted, shows nothing.
    """
    width = noise_width(facts)
    if width <= _WIDE:
        return
    reason = (
        f"sensor_gain differs by {percent(width)} depending on whether the noise is in the sensor or in the torque, "
        "and more with shorter windows, because the sensed torque hardly varies"
    )
    for name in ("sensor_gain", "sensor_offset"):
        if name in facts.parameters and facts.parameters[name].vary:
            yield name, reason


def noise_width(facts: Facts) -> float:
    """Distance of the two regressions of the gain, over the gain; 0 without a free gain."""
    gain = facts.parameters.get("sensor_gain")
    if gain is None or not gain.vary:
        return 0.0
    regressor = facts.at_best
    free = [
        regressor.names.index(name)
        for name, p in facts.parameters.items()
        if name in regressor.names and p.vary and p.at_bound is None and name != "sensor_gain"
    ]
    own = regressor.norm("sensor_gain")
    if free:
        reading = regressor.names.index("sensor_gain")
        own = regressor.triangle.solve(free, reading, rcond=1e-10)[1]
    residual = facts.residual
    if facts.penalty.residual == _core.Residual.torque:
        residual = residual / (gain.value or 1e-300)
    freedom = max(1, residual.size - len(free) - 1)
    noise = inner(residual, residual) * residual.size / freedom
    return noise / max(own**2, 1e-300)
