"""How many windows (end of section 4.6): from ten to every sample."""

import numpy as np
from gallery import Gallery, titled
from scenario import (
    INITIAL,
    NOISE,
    TRUTH,
    controller,
    errors,
    found,
    hanging_joint,
    wide_motion,
)

import jointid as jid


def draw(gallery: Gallery) -> None:
    """Identify the same recordings with each number of windows."""
    joint = hanging_joint()
    true = joint.with_parameters(TRUTH)
    seeds = range(2 if gallery.quick else 10)
    runs = jid.simulate_batch(
        true,
        controller(joint, INITIAL),
        wide_motion(),
        sensors=NOISE,
        seeds=seeds,
        recordings=True,
    ).recordings
    samples = len(runs[0].time) - 1
    counts = [10, 20, 50, 100, 200, 500, 1000, 2000, 5000, samples]
    size = {name: [] for name in TRUTH}  # type: dict[str, list[float]]
    for count in counts:
        wrong = [errors(found(_identify(run, joint, count))) for run in runs]
        for name in TRUTH:
            size[name].append(float(np.sqrt(np.mean([error[name] ** 2 for error in wrong]))))
    chosen = _identify(runs[0], joint, None).residuals.windows
    with gallery.picture("window_count") as axes:
        for number, name in enumerate(TRUTH):
            look = jid.plot.line_style(number)
            axes.loglog(
                counts, size[name], marker="os^DvP"[number], markersize=4, label=name, **look
            )
        axes.axvline(
            chosen, color="#999999", linewidth=4.0, alpha=0.5, label="chosen from the noise"
        )
        axes.set_xlabel("number of windows n [–]")
        axes.set_ylabel("rms error [%]")
        axes.legend(loc="upper right", fontsize=7.5)
        titled(axes, f"Estimate and number of windows, {len(runs)} simulated runs")
    gallery.note("4.6", "windows chosen by default", chosen)
    for count in (10, 100, 1000, samples):
        worst = max(size[name][counts.index(count)] for name in TRUTH)
        gallery.note("4.6", f"worst parameter's rms error, n = {count}", worst, "%")


def _identify(run: jid.Recording, joint: jid.Joint, count: int | None) -> jid.Estimate:
    """Identify with the residual of the thesis."""
    return jid.identify(run, joint, windows=count, residual="sensor", search="separable")
