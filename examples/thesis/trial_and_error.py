"""Figure 6-11: identification against tuning, one parameter after the other, as a patient person would."""

import numpy as np
from gallery import Gallery, titled
from scenario import (
    INITIAL,
    NOISE,
    TRUTH,
    controller,
    domain,
    errors,
    found,
    hanging_joint,
    wide_motion,
)

import jointid as jid


def tune(
    joint: jid.Joint, true: jid.Joint, *, passes: int, values_each: int
) -> tuple[list[dict[str, float]], list[float]]:
    """Vary each parameter over its domain in turn, keep what tracks best; the best after each pass."""
    best = dict(INITIAL)
    kept, size = [], []
    for number in range(passes):
        for name in TRUTH:
            low, high = domain(joint, name)
            tried = np.linspace(low, high, values_each)
            if number:  # around what was found, ever finer
                half = (high - low) * 0.5**number
                tried = np.clip(np.linspace(-0.5, 0.5, values_each) * half + best[name], low, high)
            tried = np.append(tried, best[name])  # never worse
            runs = jid.simulate_batch(
                true,
                [controller(joint, best | {name: float(value)}) for value in tried],
                wide_motion(),
                sensors=NOISE,
            )
            best[name] = float(tried[int(np.argmin(runs.error))])
        kept.append(dict(best))
        size.append(float(runs.error.min()))
    return kept, size


def draw(gallery: Gallery) -> None:
    """Tune, identify, run both."""
    joint = hanging_joint()
    true = joint.with_parameters(TRUTH)
    passes, values_each = (1, 5) if gallery.quick else (4, 11)
    tuned, size = tune(joint, true, passes=passes, values_each=values_each)
    first = jid.simulate(true, controller(joint, INITIAL), wide_motion(), sensors=NOISE)
    estimate = found(jid.identify(first, joint))
    cases = {"trial and error, 1 pass": tuned[0], "identified from one run": estimate}
    if passes > 1:
        cases[f"trial and error, {passes} passes"] = tuned[-1]
    runs = jid.simulate_batch(
        true,
        [controller(joint, values) for values in cases.values()],
        wide_motion(),
        sensors=NOISE,
        recordings=True,
    )
    with gallery.picture("6-11_trial_and_error") as axes:
        jid.plot.tracking_error(dict(zip(cases, runs.recordings, strict=True)), axes)
        titled(axes, "6-11: identified against trial and error")
    for number, error in enumerate(size, start=1):
        trials = number * len(TRUTH) * (values_each + 1)
        gallery.note("6-11", f"trial and error, {trials} runs: rms error", 1e3 * error, "mrad")
    gallery.note("6-11", "identified, 1 run: rms error", 1e3 * runs.error[1], "mrad")
    for name, values in cases.items():
        worst = max(map(abs, errors(values).values()))
        gallery.note("6-11", f"{name}: worst parameter off by", worst, "%")
