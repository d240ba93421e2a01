"""What to mind about an estimate, in plain language. One function a warning; each may stay silent."""

from collections.abc import Callable, Iterator

from jointid.estimate.statistics import Warned
from jointid.estimate.wording import percent
from jointid.identification.warnings.balance import torque_balance
from jointid.identification.warnings.evidence import Facts
from jointid.identification.warnings.identifiability import at_bound, model_too_rich, undetermined
from jointid.identification.warnings.motion import (
    sensor_lags,
    time_jitter,
    too_fast,
    velocity_disagrees,
)
from jointid.identification.warnings.ripple import periodic_residual
from jointid.identification.warnings.signals import clipped, constant, repeated, spikes


def diagnose(facts: Facts) -> tuple[Warned, ...]:
    """All warnings, the gravest first."""
    drawn = [(check, warning) for check in _CHECKS for warning in check(facts)]
    # A controller feeds a rippling sensor back, and the motion that follows looks like a lag of it.
    modelled = any(name.startswith("ripple_") for name in facts.parameters)
    ripples = modelled or any(check is periodic_residual for check, _ in drawn)
    found = [warning for check, warning in drawn if not (ripples and check is sensor_lags)]
    units = [warning for warning in found if warning.code == "implausible_units"]
    # Degrees make the motor's angle wrong, too: what swings with it is not ripple.
    spurious = [warning for warning in found if units and warning.code == "ripple"]
    return tuple(warning for warning in found if warning not in (*units[1:], *spurious))


def _stopped(facts: Facts) -> Iterator[Warned]:
    if facts.status != "converged":
        yield Warned(
            code="stopped",
            parameters=(),
            message=f"the search did not finish ({facts.message}): better values may exist",
        )


def _noisy_velocity(facts: Facts) -> Iterator[Warned]:
    # Running integrals have no edges whose noise would count.
    if facts.penalty.noise_limited and not facts.penalty.cumulative:
        inertia = facts.parameters.get("inertia")
        share = percent(facts.residuals.noise_share)
        yield Warned(
            code="noisy_velocity",
            parameters=("inertia",) if inertia is not None and inertia.vary else (),
            message=(
                f"the velocity is so noisy that noise makes up {share} of its change over a window, and no "
                "window is long enough: inertia comes out too small; record the position more finely, or longer"
            ),
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
    # Running integrals of white noise are correlated by themselves.
    if facts.residuals.autocorrelation > 0.5 and not facts.penalty.cumulative:
        yield Warned(
            code="structured_residual",
            parameters=(),
            message=(
                f"neighbouring windows miss in the same direction (correlation {facts.residuals.autocorrelation:.2f}): "
                "the joint does something that the model lacks; the standard errors allow for it, a bias may remain"
            ),
        )


def _standing(facts: Facts) -> Iterator[Warned]:
    if facts.residuals.standing > 0.35:
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
    velocity_disagrees,
    too_fast,
    torque_balance,
    constant,
    clipped,
    spikes,
    repeated,
    time_jitter,
    sensor_lags,
    _noisy_velocity,
    model_too_rich,
    at_bound,
    undetermined,
    periodic_residual,
    _poor_fit,
    _structured_residual,
    _standing,
    _few_windows,
    _gaps,
    _assumed_units,
)
