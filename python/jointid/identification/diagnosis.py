"""What to mind about an estimate, in plain language. One function a warning; each may stay silent."""

import math
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass

from jointid.estimate.findings import ParameterEstimate, ResidualStatistics, Warned
from jointid.estimate.wording import percent
from jointid.recording.recording import Recording

# A parameter is undetermined above this relative standard error, or when other windows move it by so many.
_LARGE_ERROR = 0.05
_LARGE_SHIFT = 3.0
_NOTICEABLE_SHIFT = 0.01
_INSEPARABLE = 0.98

_ADVICE = {
    "sensor_gain": "move the link through a wider range of gravity torque",
    "sensor_offset": "move the link through a wider range of gravity torque",
    "static": "let the joint pass slowly through speeds near zero, in both directions",
    "stribeck": "let the joint pass slowly through speeds near zero, in both directions",
    "coulomb": "move in both directions, at several speeds",
    "viscous": "move faster, at several speeds",
    "inertia": "accelerate harder, or give the inertia in the joint file",
    "torque_offset": "move as much in one direction as in the other",
    "stribeck_velocity": "let the joint pass slowly through speeds near zero, in both directions",
    "stribeck_exponent": "let the joint pass slowly through speeds near zero, in both directions",
    "load_friction": "move with different loads",
    "gravity_cos": "move through a wider range of angles",
    "gravity_sin": "move through a wider range of angles",
}


@dataclass(frozen=True, slots=True, kw_only=True)
class Facts:
    """What the warnings are drawn from."""

    recordings: tuple[Recording, ...]
    parameters: Mapping[str, ParameterEstimate]
    residuals: ResidualStatistics
    model: str
    noise_limited: bool
    torque_level: float
    status: str
    message: str
    bounds_from_data: tuple[str, ...]
    correlations: Mapping[tuple[str, str], float]


def diagnose(facts: Facts) -> tuple[Warned, ...]:
    """All warnings, the gravest first."""
    return tuple(warning for check in _CHECKS for warning in check(facts))


def _stopped(facts: Facts) -> Iterator[Warned]:
    if facts.status != "converged":
        yield Warned(
            code="stopped",
            parameters=(),
            message=f"the search did not finish ({facts.message}): better values may exist",
        )


def _noisy_velocity(facts: Facts) -> Iterator[Warned]:
    if facts.noise_limited:
        share = percent(facts.residuals.noise_share)
        yield Warned(
            code="noisy_velocity",
            parameters=("inertia",) if facts.parameters["inertia"].vary else (),
            message=(
                f"the velocity is so noisy that noise makes up {share} of its change over a window, and no "
                "window is long enough: inertia comes out too small; record the position more finely, or longer"
            ),
        )


def _richness(facts: Facts) -> str | None:
    """Why the data do not carry a static excess, or None when they do."""
    static, coulomb = facts.parameters.get("static"), facts.parameters.get("coulomb")
    if static is None or coulomb is None:
        return None
    shape = facts.parameters.get("stribeck") or facts.parameters["stribeck_velocity"]
    if static.at_bound == "min" or coulomb.at_bound == "min":
        which = "static" if static.at_bound == "min" else "Coulomb"
        return f"{which} friction ended at its lower bound"
    if static.stderr is not None and static.stderr > 0.5 * abs(static.value):
        share = percent(static.stderr / abs(static.value))
        return f"static friction is {static.value:.3g} with a standard error of {share}"
    if shape.vary and shape.at_bound is not None and shape.name in facts.bounds_from_data:
        return "the Stribeck shape ended on the bound of what the data could show"
    return None


def _model_too_rich(facts: Facts) -> Iterator[Warned]:
    reason = _richness(facts)
    if reason is not None:
        yield Warned(
            code="model_too_rich",
            parameters=("coulomb", "static", "stribeck"),
            message=(
                f"the data do not carry the model '{facts.model}': {reason}; "
                "use model='coulomb_viscous', or record slow motion through zero speed"
            ),
        )


def _at_bound(facts: Facts) -> Iterator[Warned]:
    told = ("static", "stribeck") if _richness(facts) is not None else ()
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


def _kind(name: str) -> str:
    """The quantity behind a parameter's name, whatever its direction or recording."""
    return name.split("[")[0].removesuffix("_positive").removesuffix("_negative")


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


def _undetermined(facts: Facts) -> Iterator[Warned]:
    found: list[str] = []
    reasons: list[str] = []
    for p in facts.parameters.values():
        if p.stderr is None:
            continue
        scale = _scale(p, facts)
        shift = max(abs(p.shift_halved or 0.0), abs(p.shift_doubled or 0.0))
        moves = shift > _LARGE_SHIFT * p.stderr and shift > _NOTICEABLE_SHIFT * scale
        if p.stderr <= _LARGE_ERROR * scale and not moves:
            continue
        found.append(p.name)
        if p.stderr > _LARGE_ERROR * scale:
            reasons.append(
                f"{p.name} has a standard error of {percent(p.stderr / scale)}"
                if p.stderr < 10.0 * scale
                else f"{p.name} is not excited"
            )
        if moves:
            reasons.append(
                f"{p.name} moves by {percent(shift / scale)} ({shift / p.stderr:.1f} standard errors) when the "
                "windows are halved or doubled"
            )
    if not found:
        return
    message = "not well determined by this recording: " + "; ".join(reasons)
    for (first, second), correlation in facts.correlations.items():
        if abs(correlation) > _INSEPARABLE and {first, second} & set(found):
            message += (
                f"; {first} and {second} can hardly be told apart (correlation {correlation:.3f})"
            )
    advice = dict.fromkeys(_ADVICE[key] for key in map(_kind, found) if key in _ADVICE)
    yield Warned(
        code="undetermined",
        parameters=tuple(found),
        message=message + (" — " + "; ".join(advice) if advice else ""),
    )


def _poor_fit(facts: Facts) -> Iterator[Warned]:
    if facts.residuals.r_squared < 0.95:
        yield Warned(
            code="poor_fit",
            parameters=(),
            message=(
                f"the model explains only {100.0 * facts.residuals.r_squared:.1f} % of what was measured: check units "
                "and signs, the gear ratio, and whether gravity, a load or sensor ripple is missing from the model"
            ),
        )


def _structured_residual(facts: Facts) -> Iterator[Warned]:
    if facts.residuals.autocorrelation > 0.5:
        yield Warned(
            code="structured_residual",
            parameters=(),
            message=(
                f"neighbouring windows miss in the same direction (correlation {facts.residuals.autocorrelation:.2f}): "
                "the joint does something that the model lacks; the standard errors allow for it, a bias may remain"
            ),
        )


def _standing(facts: Facts) -> Iterator[Warned]:
    if facts.residuals.standing > 0.4:
        yield Warned(
            code="standing",
            parameters=(),
            message=(
                f"the joint stands still or sticks in {100.0 * facts.residuals.standing:.0f} % of the recording; "
                "those samples say nothing about friction and were left out: record more motion"
            ),
        )


def _few_windows(facts: Facts) -> Iterator[Warned]:
    free = sum(p.vary for p in facts.parameters.values())
    if facts.residuals.windows < 8 * free:
        yield Warned(
            code="few_windows",
            parameters=(),
            message=(
                f"{facts.residuals.windows} windows for {free} parameters: the standard errors are themselves "
                "uncertain; record longer, or use shorter windows"
            ),
        )


def _gaps(facts: Facts) -> Iterator[Warned]:
    for recording in facts.recordings:
        if recording.gaps:
            longest = max(recording.gaps, key=lambda gap: gap.duration)
            yield Warned(
                code="gaps",
                parameters=(),
                message=(
                    f"{len(recording.gaps)} gap(s) in the recording, the longest of {longest.duration:.3g} s at "
                    f"{longest.start:.3f} s; no window crosses them"
                ),
            )


def _assumed_units(facts: Facts) -> Iterator[Warned]:
    signals = dict.fromkeys(
        str(signal)
        for recording in facts.recordings
        for signal in _sequence(recording.metadata.get("assumed_units"))
    )
    if signals:
        yield Warned(
            code="assumed_units",
            parameters=(),
            message=(
                f"no unit was given for {', '.join(signals)}; SI was assumed: name it in the header (position_rad) or "
                "with units="
            ),
        )


def _sequence(value: object) -> tuple[object, ...]:
    return tuple(value) if isinstance(value, list | tuple) else ()


_CHECKS: tuple[Callable[[Facts], Iterator[Warned]], ...] = (
    _stopped,
    _noisy_velocity,
    _model_too_rich,
    _at_bound,
    _undetermined,
    _poor_fit,
    _structured_residual,
    _standing,
    _few_windows,
    _gaps,
    _assumed_units,
)
