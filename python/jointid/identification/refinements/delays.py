"""Constant delays of torque, sensor and velocity against the position.

Each signal is held against the motion by itself: the velocity against the position's rate, the sensor's
reading against link inertia and gravity, the torque against inertia, gravity and friction as any function of
the speed. So no delay is blamed on another signal. A model error may still ask for a shift, but not for the same one
of every part of the torque; see `_torque`.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace

import numpy as np

from jointid.estimate.delays import Delay
from jointid.identification.refinements.balance_misfit import SURE, fits_better, rows_of
from jointid.identification.refinements.balances import SMALL, SUSPECT, Motion, margin, reach
from jointid.identification.refinements.command_noise import delay_in_command
from jointid.identification.refinements.shift_fit import Balance, Shift, fit_shift
from jointid.identification.refinements.smooth_windows import Stretch
from jointid.identification.refinements.stretches import few_of, pieces_of
from jointid.problem.problem import Problem
from jointid.recording.shifting import shifted

_SURE = 5.0  # standard errors
_SURE_OF_VELOCITY = 8.0  # standard errors; no friction stands between velocity and position
# A torque that is held between samples seems early by about half of one; read so, it leaves half of the squares.
_HELD, _HELD_GAIN = 0.2, 0.5  # sample periods, and a share
_VELOCITY = 0.35  # sample periods; a backward difference has 0.5
_LEAST_IN_COMMAND = 0.3  # sample periods
_BEYOND_ANSWER = 3.0  # times the joint's answer to noise of the torque
_WITHIN_SAMPLE = 0.06  # sample periods: friction and torque jump between samples
_CLEARLY = 4.0  # standard errors: a first look at parts of the motion is enough
_ALIKE, _BARELY_ALIKE = 0.5, 0.7  # of the delay: how far estimates of it may be apart
_MOST_LEFT = 0.5  # of a signal's variance unexplained: other torques act
_MOST_LEFT_OF_VELOCITY = 0.05
# The fall of the sum of squares that makes a shift worth it: noise of a reading leaves little to fall.
_LEAST_GAIN = {"velocity": 0.01, "sensor": 0.0, "torque": 0.02}


def refined_delays(
    problem: Problem, given: Mapping[str, float] | None
) -> tuple[Problem, dict[str, Delay]]:
    """Return the problem with its signals' delays taken away, and the delays by signal.

    Parameters
    ----------
    problem : Problem
        Problem of the unchanged recordings.
    given : mapping of str to float, optional
        Delays to take away [s], no others. Default: those that are certain and without which the torque
        balance fits better; never a torque that is early by more than a sample. One that fits better as held
        between samples, which nobody stated, is taken for that.
    """
    choose = given is None
    shift = dict(given or {})
    if shift:
        problem = _shifted(problem, shift)
    found: dict[str, Delay] = {}
    mended = (
        problem  # also without what the call leaves: the next signal is held against true motion
    )
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
            # The model has no say in what the velocity and the reading show by themselves.
            sure = SURE if signal == "torque" else 0.0
            fits = fits_better(mended, without, least, sure=sure, reversals=not smooth)
            # Friction that the model lacks may look like a late torque; the others are measured without it.
            certain = fits or signal != "torque"
            wrong = signal == "torque" and left.value < -problem.recordings[0].sample_period
            # A torque does not come before its motion: then the position is late, as a coarse one is.
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
    """The problem with a torque that is held between samples; None where that is not clearly better.

    Such a torque seems early by half a sample, if nobody says that it is held. A shift has to predict less well.
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
    """Return the problem with delays that are known taken away [s], without a look at others."""
    return _shifted(problem, given).changed(shift=dict(given)) if given else problem


def _shifted(problem: Problem, shift: Mapping[str, float]) -> Problem:
    return replace(problem, recordings=tuple(shifted(run, shift) for run in problem.recordings))


def _measured(signal: str, motion: Motion) -> tuple[Shift, bool] | None:
    """A signal's delay and whether it is certain; parts of the motion show that the velocity has none."""
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
            # Noise of the torque that the joint answers comes before the reading, too.
            answer = motion.answer() * told.torque_over_reading
            if told.share > _BEYOND_ANSWER * abs(answer):
                return told.shift, True
            told = None
        possible = found is not None and found.value + found.stderr > SMALL
        if told is None and found is not None and possible and found.unexplained <= _MOST_LEFT:
            from jointid.identification.refinements.sample_fit import delay_by_samples

            by_samples = delay_by_samples(pieces, found, reach(period), motion.inertia)
            if by_samples is not None:
                # Jumps are those of the acceleration alone: neither a varying inertia nor slow motion has them.
                return by_samples, _is_long(by_samples, SMALL)
    if found is None or found.unexplained > _MOST_LEFT:
        return None
    # An early reading is one that is not of a control cycle, up to half a sample.
    least = SMALL if found.value > 0.0 or not pieces[0].held else SMALL + 0.6 * period
    if not _is_long(found, least):
        return found, False
    # A link whose inertia varies with the pose may look like a late reading.
    for factor, varying in ((3, False), (1, True)):
        other = _searched(motion.reading_otherwise(factor, varying=varying), period, 0.0)
        if other is None or not found.agrees(other, _ALIKE) or abs(other.value) < least:
            return found, False
    return found, True


def _torque(motion: Motion) -> tuple[Shift, bool] | None:
    """The torque's delay, and whether it is certain.

    Certain is what conservative torque and friction ask for alike, with and without an inertia that
    varies, and with and without the reversals: pre-sliding fakes a delay at the reversals only, a varying
    inertia away from them.
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
    """The delay: from no shift, and only where that looks long, from the shift of least misfit."""
    if least > 0.0:
        found = fit_shift(balance, least=SUSPECT * least)
        if _is_short(found, least):
            return found
    return fit_shift(balance, reach=reach(period))


def _is_short(found: Shift | None, least: float) -> bool:
    """Whether a first look is enough."""
    return found is not None and abs(found.value) < max(SUSPECT * least, 2.0 * found.stderr)


def _is_clearly_none(found: Shift, least: float) -> bool:
    return (
        found.unexplained < _MOST_LEFT_OF_VELOCITY
        and abs(found.value) + _CLEARLY * found.stderr < SUSPECT * least
    )


def _is_long(found: Shift, least: float) -> bool:
    return abs(found.value) > max(least, _SURE * found.stderr)
