"""Figures 5-4 to 5-11: identified against guessed at random, and tracking with wrong parameters."""

import numpy as np
from gallery import Gallery, titled
from scenario import (
    NOISE,
    TRUTH,
    Penalty,
    controller,
    domain,
    hanging_joint,
    wide_motion,
)

import jointid as jid

SHARES = (1, 5, 10, 20, 30, 40)


def random_guess(seed: int, joint: jid.Joint) -> dict[str, float]:
    """Anywhere in the search domain."""
    rng = np.random.default_rng(seed)
    return {name: float(rng.uniform(*domain(joint, name))) for name in TRUTH}


def wrong_by(share: float, seed: int) -> dict[str, float]:
    """Every parameter up to this share [%] off, at random."""
    rng = np.random.default_rng(seed)
    return {
        name: true * (1.0 + 0.01 * share * float(rng.uniform(-1.0, 1.0)))
        for name, true in TRUTH.items()
    }


def draw(gallery: Gallery) -> None:
    """Draw both groups."""
    _guesses(gallery)
    _shares(gallery)


def _guesses(gallery: Gallery) -> None:
    joint = hanging_joint()
    true = joint.with_parameters(TRUTH)
    count = 3 if gallery.quick else 20
    guesses = [random_guess(seed, joint) for seed in range(count)]
    first = jid.simulate_batch(
        true,
        [controller(joint, guess) for guess in guesses],
        wide_motion(),
        sensors=NOISE,
        recordings=True,
    )
    penalties = [Penalty(run, joint) for run in first.recordings]
    populations = (20, 200)
    with gallery.picture("5-4_5-5_random_guess", 1, 2, sharey=True) as panels:
        for number, (axes, population) in enumerate(zip(panels, populations, strict=True), start=4):
            options = jid.GaOptions.thesis().replace(population=population, generations=100)
            identified = [
                controller(joint, penalty.genetic(options, trial)[0])
                for trial, penalty in enumerate(penalties)
            ]
            second = jid.simulate_batch(
                true, identified, wide_motion(), sensors=NOISE, recordings=True
            )
            jid.plot.tracking_error(
                {"random guess": first.recordings[0], "identified": second.recordings[0]}, axes
            )
            titled(axes, f"5-{number}: population {population}, 100 generations")
            better = 100.0 * float(np.mean(second.error < first.error))
            gallery.note(f"5-{number}", "runs better than their guess", better, "%", "better")
            gain = float(np.median(first.error / second.error))
            gallery.note(f"5-{number}", "error smaller, median of runs", gain, "times")
            size = 1e3 * float(np.median(second.error))
            gallery.note(f"5-{number}", "rms error, median of runs", size, "mrad")


def _shares(gallery: Gallery) -> None:
    joint = hanging_joint()
    true = joint.with_parameters(TRUTH)
    draws = 4 if gallery.quick else 40
    best = jid.simulate(true, controller(joint, TRUTH), wide_motion(), sensors=NOISE)
    with gallery.picture("5-6_to_5-11_parameter_error", 3, 2, size=(9.2, 8.4), sharey=True) as rows:
        for number, (axes, share) in enumerate(zip(rows, SHARES, strict=True), start=6):
            runs = jid.simulate_batch(
                true,
                [controller(joint, wrong_by(share, seed)) for seed in range(draws)],
                wide_motion(),
                sensors=NOISE,
                recordings=True,
            )
            middle = int(np.argsort(runs.error)[draws // 2])
            jid.plot.tracking_error(
                {"true parameters": best, f"within ±{share} %": runs.recordings[middle]}, axes
            )
            titled(axes, f"5-{number}: parameters within ±{share} % (median of {draws})")
            size = 1e3 * float(np.median(runs.error))
            gallery.note(f"5-{number}", f"±{share} %: rms error, median", size, "mrad")
            gallery.note(f"5-{number}", f"±{share} %: largest", 1e3 * runs.error.max(), "mrad")
