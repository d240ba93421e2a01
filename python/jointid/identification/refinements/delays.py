"""Constant delays of torque, sensor and velocity relative to the position.

Each signal is compared with the motion separately. The velocity is compared with the rate of the position, the sensor
reading with link inertia and gravity, and the torque with inertia, gravity and friction as any function of the speed.
A delay is therefore not attributed to another signal. A model error may also look like a shift, but not like the same
shift of every part of the torque; see `_torque`.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace

import numpy as np

from jointid.estimate.delays import Delay
from jointid.identification.refinements.balance_residual import SURE, fits_better, rows_of
from jointid.identification.refinements.balances import SMALL, SUSPECT, Motion, margin, reach
from jointid.identification.refinements.command_noise import delay_in_command
from jointid.identification.refinements.shift_fit import Balance, Shift, fit_shift
from jointid.identification.refinements.smooth_windows import Stretch
from jointid.identification.refinements.stretches import few_of, pieces_of
from jointid.problem.problem import Problem
from jointid.recording.shifting import shifted

_SURE = 5.0  # standard errors
_SURE_OF_VELOCITY = 8.0  # standard errors; friction does not affect velocity against position
# A held torque seems early by about half a sample. Treating it as held must halve the sum of squares.
_HELD, _HELD_GAIN = 0.2, 0.5  # sample periods, and a share
_VELOCITY = 0.35  # sample periods; a backward difference has a delay of 0.5
_LEAST_IN_COMMAND = 0.3  # sample periods
_BEYOND_ANSWER = 3.0  # factor on the joint's response to noise of the torque
_WITHIN_SAMPLE = 0.06  # sample periods; error because friction and torque jump between samples
_CLEARLY = 4.0  # standard errors, from which on the result from parts of the motion is enough
_ALIKE, _BARELY_ALIKE = 0.5, 0.7  # largest difference of two estimates, as a share of the delay
_MOST_LEFT = 0.5  # largest unexplained share of a signal's variance; above it, other torques act
_MOST_LEFT_OF_VELOCITY = 0.05
# Smallest relative decrease of the sum of squares. With a noisy reading the decrease is small.
_LEAST_GAIN = {"velocity": 0.01, "sensor": 0.0, "torque": 0.02}


def refined_delays(
    problem: Problem, given: Mapping[str, float] | None
) -> tuple[Problem, dict[str, Delay]]:
    """Return the problem with the delays of its signals removed, and the delays by signal.

    Parameters
    ----------
    problem : Problem
        Problem of the unchanged recordings.
    given : mapping of str to float, optional
        Delays to remove [s]; no others are removed. Default: remove delays that are certain and improve the fit of the
        torque balance, but not that of a torque that is early by more than one sample. If the caller sets no hold
        and the torque fits better as held between samples, it is treated as held.
    """
    choose = given is None
    shift = dict(given or {})
    if shift:
        problem = _shifted(problem, shift)
    found: dict[str, Delay] = {}
    mended = problem  # without all certain delays, because the next signal needs the true motion
    motion = Motion(pieces=pieces_of(mended))
    for signal in ("velocity", "sensor", "torque"):
        measured = _measured(signal, motion)
        if choose and signal == "torque" and measured is not None:
            held = _with_held_torque(mended, measured[0].value)
            if held is not None:
                mended, motion = held, Motion(pieces=pieces_of(held))
                measured = _measured(signal, motion)
        if measured is None:
            continue
        left, certain = measured
        taken, fits = shift.get(signal, 0.0), False
        value = taken + left.value
        if certain:
            without = _shifted(mended, {signal: left.value})
            least, smooth = _LEAST_GAIN[signal], signal == "sensor"
            # The delays of velocity and reading do not depend on the model.
            sure = SURE if signal == "torque" else 0.0
            fits = fits_better(mended, without, least, sure=sure, reversals=not smooth)
            # Friction that the model lacks may look like a late torque. It does not affect the other signals.
            certain = fits or signal != "torque"
            wrong = signal == "torque" and left.value < -problem.recordings[0].sample_period
            # A torque cannot be early by a sample. The position is then late, for example a coarse one.
            if fits and not (choose and wrong):
                mended, motion = without, Motion(pieces=pieces_of(without))
                if choose:
                    shift[signal] = taken = left.value
        found[signal] = Delay(
            signal=signal,
            value=value,
            stderr=left.stderr,
            certain=certain,
            fits=fits,
            applied=taken,
        )
    if choose:
        problem = mended
    return problem.changed(shift=shift) if shift else problem, found


def _with_held_torque(problem: Problem, delay: float) -> Problem | None:
    """Return the problem with a torque that is held between samples; None if that is not clearly better.

    A held torque seems early by half a sample if it is interpolated. A shift must predict less well.
    """
    period = problem.recordings[0].sample_period
    if delay > -_HELD * period or problem.states_hold:
        return None
    held = problem.changed(torque_hold="zoh")
    if not fits_better(problem, held, _HELD_GAIN):
        return None
    moved = _shifted(problem, {"torque": delay})
    pairs = zip(held.recordings, moved.recordings, strict=True)
    same = replace(held, recordings=tuple(rows_of(run, other) for run, other in pairs))
    return held if fits_better(moved, same, 0.0) else None


def delays_removed(problem: Problem, given: Mapping[str, float]) -> Problem:
    """Return the problem with known delays [s] removed, without a search for others."""
    return _shifted(problem, given).changed(shift=dict(given)) if given else problem


def _shifted(problem: Problem, shift: Mapping[str, float]) -> Problem:
    return replace(problem, recordings=tuple(shifted(run, shift) for run in problem.recordings))


def _measured(signal: str, motion: Motion) -> tuple[Shift, bool] | None:
    """Return a signal's delay and whether it is certain.

    For the velocity, parts of the motion may suffice to exclude a delay.
    """
    if not motion.pieces:
        return None
    if signal == "sensor":
        return _sensor(motion)
    if signal == "torque":
        measured = _torque(motion)
        if measured is None:
            return None
        error = float(
            np.hypot(measured[0].stderr, _WITHIN_SAMPLE * motion.pieces[0].stretch.period)
        )
        return replace(measured[0], stderr=error), measured[1]
    stretches = [piece.stretch for piece in motion.pieces if not piece.stretch.derived]
    few = few_of(stretches)
    first = _velocity(few, glance=True) if few else None
    return _velocity(stretches) if first is None or first[1] else first


def _velocity(stretches: Sequence[Stretch], glance: bool = False) -> tuple[Shift, bool] | None:
    if not stretches:
        return None
    windows = [
        each.windows(each.half_length(by_position=True), margin=margin(each), usable_only=False)
        for each in stretches
    ]
    columns = [
        each.rates(stretch.position)[:, None]
        for each, stretch in zip(windows, stretches, strict=True)
    ]
    balance = Balance(
        windows=windows,
        signals=[each.velocity for each in stretches],
        columns=columns,
        conservative=1,
        held=False,
    )
    period = stretches[0].period
    if glance:
        found = fit_shift(balance, robust=False, least=SUSPECT * _VELOCITY * period)
        return None if found is None else (found, not _is_clearly_none(found, _VELOCITY * period))
    found = _searched(balance, period, _VELOCITY * period)
    if found is None or found.unexplained > _MOST_LEFT_OF_VELOCITY:
        return None
    long = abs(found.value) > max(_VELOCITY * period, _SURE_OF_VELOCITY * found.stderr)
    return found, long


def _sensor(motion: Motion) -> tuple[Shift, bool] | None:
    pieces = [piece for piece in motion.pieces if piece.sensor is not None]
    if not pieces:
        return None
    if len(pieces) < len(motion.pieces):
        motion = Motion(pieces=pieces)
    period = pieces[0].stretch.period
    found = _searched(motion.reading, period, SMALL)
    if found is None or abs(found.value) + 2.0 * found.stderr > SMALL:
        told = delay_in_command(pieces)
        late = told is not None and told.shift.value > max(SMALL, _LEAST_IN_COMMAND * period)
        if told is not None and late and (found is None or found.agrees(told.shift, _ALIKE)):
            # The joint's response to torque noise also appears in the torque before the reading.
            answer = motion.answer() * told.torque_over_reading
            if told.share > _BEYOND_ANSWER * abs(answer):
                return told.shift, True
            told = None
        possible = found is not None and found.value + found.stderr > SMALL
        if told is None and found is not None and possible and found.unexplained <= _MOST_LEFT:
            from jointid.identification.refinements.sample_fit import delay_by_samples

            by_samples = delay_by_samples(pieces, found, reach(period), motion.inertia)
            if by_samples is not None:
                # Only the acceleration jumps; a varying inertia and slow motion have no jumps.
                return by_samples, _is_long(by_samples, SMALL)
    if found is None or found.unexplained > _MOST_LEFT:
        return None
    # With a held torque, a reading that is not part of a control cycle may seem early by half a sample.
    least = SMALL if found.value > 0.0 or not pieces[0].held else SMALL + 0.6 * period
    if not _is_long(found, least):
        return found, False
    # An inertia of the link that varies with the pose may look like a late reading.
    for factor, varying in ((3, False), (1, True)):
        other = _searched(motion.reading_otherwise(factor, varying=varying), period, 0.0)
        if other is None or not found.agrees(other, _ALIKE) or abs(other.value) < least:
            return found, False
    return found, True


def _torque(motion: Motion) -> tuple[Shift, bool] | None:
    """Return the torque's delay, and whether it is certain.

    A delay is certain if conservative torque and friction show the same delay, with and without a varying inertia, and
    with and without reversals. Pre-sliding looks like a delay only at reversals, and a varying inertia only away
    from them.
    """
    period = motion.pieces[0].stretch.period
    look = motion.first_look
    found = look if _is_short(look, SMALL) else fit_shift(motion.torque, reach=reach(period))
    if found is None or found.unexplained > _MOST_LEFT:
        return None
    if not _is_long(found, SMALL) or not found.is_of_all(_BARELY_ALIKE):
        return found, False
    others: tuple[tuple[Callable[[], Balance], float], ...] = (
        (lambda: motion.torque_otherwise(varying=True), _ALIKE),
        (lambda: motion.torque_otherwise(clear=True), _ALIKE),
    )
    for other, share in others:
        compared = _searched(other(), period, 0.0)
        if compared is None or not found.agrees(compared, share):
            return found, False
    return found, True


def _searched(balance: Balance, period: float, least: float) -> Shift | None:
    """Return the delay, starting from 0. If it may be long, start from the shift with the smallest residual."""
    if least > 0.0:
        found = fit_shift(balance, least=SUSPECT * least)
        if _is_short(found, least):
            return found
    return fit_shift(balance, reach=reach(period))


def _is_short(found: Shift | None, least: float) -> bool:
    """Return whether the first estimate is clearly shorter than `least`."""
    return found is not None and abs(found.value) < max(SUSPECT * least, 2.0 * found.stderr)


def _is_clearly_none(found: Shift, least: float) -> bool:
    return (
        found.unexplained < _MOST_LEFT_OF_VELOCITY
        and abs(found.value) + _CLEARLY * found.stderr < SUSPECT * least
    )


def _is_long(found: Shift, least: float) -> bool:
    return abs(found.value) > max(least, _SURE * found.stderr)
