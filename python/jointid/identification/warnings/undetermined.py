"""Values that the recording does not determine, and its deficits: speed, reversals, load, acceleration, travel."""

from __future__ import annotations

import math
from collections.abc import Collection, Iterator, Mapping, Sequence

from jointid.base.advice import Action
from jointid.base.values import dataclass
from jointid.estimate.findings import TITLE, Finding, Measured
from jointid.estimate.intervals import NORMAL
from jointid.estimate.statistics import ParameterEstimate
from jointid.estimate.wording import percent, two_digits
from jointid.identification.warnings.check import Check, FindingType
from jointid.identification.warnings.evidence import Evidence
from jointid.identification.warnings.excitation import Excitation, Lack
from jointid.identification.warnings.motion_advice import DESIGNED, other_motion
from jointid.identification.warnings.no_friction import without_friction

UNDETERMINED = FindingType(
    code="undetermined",
    meaning="the 95 % interval is wider than ±4 % of the value (±1 % for a sensor gain), or the value changes with the "
    "length of the windows. The log has too little fast motion, slow motion, reversals, load, acceleration, travel or "
    "time. Or velocity noise hides the inertia. Or a sensor gain of the opposite sign fits the log nearly as well",
    advice=f"fix the parameter, or record the missing motion{DESIGNED}",
)

# A parameter is not well determined if its 95 % interval is wider than this on either side, or if other windows
# change it by more than this number of errors. With a limit above 5 %, errors of 5 % by chance would not be reported.
_LARGE_ERROR = 0.04
# A gain is a calibration. If the load hardly varies, it is reported above this.
_LARGE_GAIN_ERROR = 0.01
_GAIN = ("sensor_gain", "sensor_offset")
_LARGE_SHIFT = 3.0
_NOTICEABLE_SHIFT = 0.01
_INSEPARABLE = 0.98
_NEARLY = 0.5  # of the limit: so uncertain are other parameters that correlate with one beyond it
_LOAD_FRICTION = 0.05
HIDES = 0.5  # noise in the velocity's change over a window: above it, noise exceeds the motion
_PAIRS = 5
_LOW_SPEED = ("static", "stribeck", "stribeck_velocity", "stribeck_exponent")
_FEW = 3  # names in a sentence
_SHOWN = 4  # further names in the details; the evidence contains all
_ACT = 73  # characters of the motion to record; 80 with the verb


@dataclass(frozen=True, slots=True)
class _Reason:
    short: str
    text: str  # full reason, if the short one is not enough
    measured: Mapping[str, Measured]


def _find(evidence: Evidence) -> Iterator[Finding]:
    reasons, lacks = _reasons(evidence)
    guessed = _guessed_sign(evidence)
    if guessed is not None:
        reasons.setdefault("sensor_gain", []).append(guessed)
    if not reasons:
        return
    values = [found[0].short for found in reasons.values()]
    title, count = _title(values, [lack.short for lack in lacks.values()])
    details = [each.text for found in reasons.values() for each in found if each.text]
    measured = {
        name: number
        for found in reasons.values()
        for each in found
        for name, number in each.measured.items()
    }
    if count < len(values):
        details.insert(0, f"also {', '.join(values[count : count + _SHOWN])}")
        measured["more_parameters"] = Measured(float(len(values) - count))
    for (first, second), correlation in _worst_pairs(evidence.correlations, reasons):
        details.append(
            f"{first} and {second} are indistinguishable (correlation {correlation:.3f})"
        )
        measured[f"{first}.{second}.correlation"] = Measured(correlation)
    for lack in lacks.values():
        details.append(lack.text)
        measured |= lack.measured
    yield UNDETERMINED.finding(
        title,
        *_advice(evidence, reasons, lacks, guessed is not None),
        details="; ".join(details),
        evidence=measured,
        parameters=tuple(name for name in evidence.parameters if name in reasons),
    )


def _title(values: Sequence[str], missing: Sequence[str]) -> tuple[str, int]:
    """Return values and deficits of the recording, as many as fit into a title, and the number of values in it."""
    title, count = "", 1
    for count in range(min(_FEW, len(values)), 0, -1):
        for lacks in range(min(2, len(missing)), -1, -1):
            lack = f": {', '.join(missing[:lacks])}" if lacks else ""
            title = f"{', '.join(values[:count])}{_others(len(values) - count)}{lack}"
            if len(title) <= TITLE and (lacks or not missing):
                return title, count
    return title, count


def _others(count: int) -> str:
    return f" and {count} other{'s' * (count > 1)}" if count else ""


def _reasons(evidence: Evidence) -> tuple[dict[str, list[_Reason]], dict[str, Lack]]:
    """Return why parameters are not well determined, if the recording lacks something, and these deficits."""
    excitation = Excitation(evidence)
    # These have their own findings.
    elsewhere = {name for each in evidence.undivided for name in each.change}
    elsewhere |= set(without_friction(evidence))
    reasons: dict[str, list[_Reason]] = {}
    lacks: dict[str, Lack] = {}
    for p in evidence.parameters.values():
        found = _why_undetermined(p, evidence)
        if not found or p.name in elsewhere:
            continue
        lack = _lack(p, evidence, excitation)
        if lack is None:
            continue
        reasons[p.name] = found
        known = lacks.get(lack.quantity)
        # If two figures apply to the same quantity, the larger requirement is kept.
        if known is None or lack.wanted > known.wanted:
            lacks[lack.quantity] = lack
    for p in _as_uncertain(evidence, reasons):
        if p.name not in reasons and p.name not in elsewhere:
            reasons[p.name] = [_uncertain(p, evidence)]
    # More time is the last advice, because it helps least if other quantities are missing.
    return reasons, dict(sorted(lacks.items(), key=lambda entry: entry[0] == "duration"))


def _as_uncertain(evidence: Evidence, names: Collection[str]) -> list[ParameterEstimate]:
    """Return parameters nearly as uncertain as one of `names` that correlates with them.

    Two parameters that the recording hardly separates are wrong together, even if one of them is just below the limit.
    """
    tied = {
        name
        for pair, correlation in evidence.correlations.items()
        if abs(correlation) > _INSEPARABLE and set(pair) & set(names)
        for name in pair
    }
    tied |= set(with_partners(evidence, names))
    found = []
    for name, p in evidence.parameters.items():
        if name in tied and name not in names and p.stderr is not None:
            limit = _LARGE_GAIN_ERROR if name in _GAIN else _LARGE_ERROR
            if _half_width(p) > _NEARLY * limit * scale_of(p, evidence):
                found.append(p)
    return found


def _lack(p: ParameterEstimate, evidence: Evidence, excitation: Excitation) -> Lack | None:
    """Return the deficit of the recording for a parameter; None if the model's residual makes its error large."""
    if _hidden(p, evidence):
        return excitation.noise()
    lack = excitation.lack(p)
    if lack is not None or evidence.causes is not None:
        return lack
    error, wanted = _half_width(p), _LARGE_ERROR * scale_of(p, evidence)
    if math.isinf(error) or error <= wanted or wanted == 0.0:
        return None
    return excitation.longer(p.name, error, wanted)


def wide(evidence: Evidence) -> tuple[str, ...]:
    """Return parameters that are not well determined, for any reason."""
    return tuple(p.name for p in evidence.parameters.values() if _why_undetermined(p, evidence))


def with_partners(evidence: Evidence, names: Collection[str]) -> tuple[str, ...]:
    """Return the parameters, plus the other friction parameters at low speed if they contain one of these.

    Height and decay of this friction lie on one curve. An effect on one of them changes the other by an amount that a
    first-order shift does not show.
    """
    low = [name for name, p in evidence.parameters.items() if p.vary and _kind(name) in _LOW_SPEED]
    partners = low if set(low) & set(names) else []
    return tuple(dict.fromkeys([*names, *partners]))


def listed(names: Collection[str], room: int = TITLE) -> str:
    """Return at most three names for a sentence; fewer if there is no room for them."""
    text = ""
    for count in range(min(_FEW, len(names)), 0, -1):
        text = ", ".join(list(names)[:count]) + _others(len(names) - count)
        if len(text) <= room:
            break
    return text


def _worst_pairs(
    correlations: Mapping[tuple[str, str], float], names: Collection[str]
) -> list[tuple[tuple[str, str], float]]:
    """Return the pairs with one of `names` that the recording separates least; only a few of many."""
    pairs = [
        (pair, correlation)
        for pair, correlation in correlations.items()
        if abs(correlation) > _INSEPARABLE and set(pair) & set(names)
    ]
    return sorted(pairs, key=lambda entry: -abs(entry[1]))[:_PAIRS]


def _advice(
    evidence: Evidence,
    reasons: Mapping[str, list[_Reason]],
    lacks: Mapping[str, Lack],
    sign_was_guessed: bool,
) -> Iterator[Action]:
    motions = list(dict.fromkeys(lack.motion for lack in lacks.values()))
    if motions:
        while len(text := ", ".join(motions)) > _ACT:
            motions.pop()
        if set(lacks) == {"velocity_noise"}:  # another log of the same motion is enough
            yield Action("record", text=text)
        else:
            yield other_motion(
                evidence,
                text,
                wider=bool({"load_range", "travel"} & set(lacks)),
                faster="top_speed" in lacks,
            )
    if "inertia" in map(_kind, reasons):
        text = "the drive's data sheet: a known inertia need not be identified"
        yield Action("inspect", text=text)
    if sign_was_guessed:
        gain = evidence.parameters["sensor_gain"].value
        # A bound of 0 is refused, because the sensor's residual is divided by the gain.
        bound = {"sensor_gain": {"min" if gain > 0.0 else "max": float(f"{0.01 * gain:.1e}")}}
        yield Action("call", {"parameters": bound}, text="if the gain has this sign")


def _kind(name: str) -> str:
    """Return a parameter's name without direction and recording."""
    return name.split("[")[0].removesuffix("_positive").removesuffix("_negative")


def scale_of(p: ParameterEstimate, evidence: Evidence) -> float:
    """Return the reference of the interval's width, because an offset or one phase of a harmonic may be zero."""
    if "offset" in p.name:
        return max(abs(p.value), evidence.torque_level)
    if p.name == "load_friction":  # it may be 0 for a joint
        return max(abs(p.value), _LOAD_FRICTION)
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
    if _hidden(p, evidence):
        share = evidence.residuals.noise_share
        # Noise adds to the variance of the velocity's change, which is the divisor of the inertia's slope.
        text = (
            "velocity noise hides the inertia in windows of any length"
            if share > HIDES
            else f"velocity noise makes the inertia about {percent(share)} too small in windows of any length"
        )
        short = "inertia unknown" if share > HIDES else f"inertia {percent(share)} too small"
        return [_Reason(short, text, {})]
    if p.stderr is None:
        return []
    if evidence.torques.is_nothing(p):
        return []
    scale = scale_of(p, evidence)
    reasons = []
    if _half_width(p) > (_LARGE_GAIN_ERROR if p.name in _GAIN else _LARGE_ERROR) * scale:
        reasons.append(_uncertain(p, evidence))
    chance = evidence.chance[p.name]  # p.stderr contains the shift, which would hide it
    shift = max(abs(p.shift_halved or 0.0), abs(p.shift_doubled or 0.0))
    if scale > 0.0 and shift > _LARGE_SHIFT * chance and shift > _NOTICEABLE_SHIFT * scale:
        text = (
            f"{p.name} changes by {percent(shift / scale)} ({shift / chance:.1f} times its random error) if the "
            "window length is halved or doubled"
        )
        measured = {
            f"{p.name}.shift": Measured(shift / scale),
            f"{p.name}.shift_over_chance": Measured(shift / chance),
        }
        reasons.append(_Reason(f"{p.name} ± {percent(shift / scale)}", text, measured))
    return reasons


def _uncertain(p: ParameterEstimate, evidence: Evidence) -> _Reason:
    """Return the standard error, as a share if the value itself is the reference."""
    scale = scale_of(p, evidence)
    error = p.stderr or 0.0
    relative = scale == abs(p.value) and scale > 0.0
    size = percent(error / scale) if relative else _with_unit(p)
    excited = error < 10.0 * scale
    measured = {
        f"{p.name}.stderr": Measured(error / scale) if relative else Measured(error, p.unit)
    }
    if evidence.torques.is_friction(p.name):
        share = evidence.torques.of_all_friction(p.name, _half_width(p))
        measured[f"{p.name}.share"] = Measured(share)
    return _Reason(f"{p.name} ± {size}" if excited else f"{p.name} unknown", "", measured)


def _half_width(p: ParameterEstimate) -> float:
    """Return half of the 95 % interval, without the part that no recording can determine; 0 without an interval."""
    if p.interval is None:
        return 0.0
    half = 0.5 * (p.interval[1] - p.interval[0])
    beyond = NORMAL * p.systematic.get("symmetry", 0.0)
    return math.sqrt(max(0.0, half**2 - beyond**2)) if beyond else half


def _hidden(p: ParameterEstimate, evidence: Evidence) -> bool:
    return p.name == "inertia" and p.vary and evidence.penalty.noise_limited


def _with_unit(p: ParameterEstimate) -> str:
    """Return the standard error as in the table."""
    return f"{two_digits(p.stderr or 0.0)} {p.unit}".rstrip()


def _guessed_sign(evidence: Evidence) -> _Reason | None:
    gain = evidence.parameters.get("sensor_gain")
    if gain is None or not gain.vary or not evidence.guessed_sign:
        return None
    sign = "negative" if gain.value > 0.0 else "positive"
    return _Reason(
        "sign of sensor_gain unknown", f"a {sign} sensor_gain fits almost as well as this value", {}
    )


CHECK = Check(_find, (UNDETERMINED,))
