"""Section 5.5: genetic against random search, estimated and run."""

import numpy as np
from gallery import Gallery, titled
from scenario import TRUTH, Penalty, all_within, domain, errors, first_recording, hanging_joint

import jointid as jid


def chance(joint: jid.Joint, percent: float = 5.0) -> float:
    """That one random candidate has all six parameters within this of the truth."""
    product = 1.0
    for name, true in TRUTH.items():
        low, high = domain(joint, name)
        product *= 2.0 * 0.01 * percent * true / (high - low)
    return product


def draw(gallery: Gallery) -> None:
    """Run both with the same budgets."""
    joint = hanging_joint()
    penalty = Penalty(first_recording(), joint)
    trials = 2 if gallery.quick else 10
    thesis = jid.GaOptions.thesis().replace(population=200)
    generations = (20, 100) if gallery.quick else (20, 50, 100, 200, 500, 1000, 1500)
    cost = [200 * count for count in generations]
    worst: dict[str, list[list[float]]] = {"genetic (thesis's text)": [], "random": []}
    good = dict.fromkeys(worst, 0)
    for count in generations:
        options = thesis.replace(generations=count)
        searches = (penalty.genetic, penalty.random)
        for name, search in zip(worst, searches, strict=True):
            found = [search(options, trial)[0] for trial in range(trials)]
            worst[name].append([max(map(abs, errors(values).values())) for values in found])
            good[name] = sum(all_within(values) for values in found)  # the last budget's counts
    with gallery.picture("5.5_random_search") as axes:
        for number, (name, spread) in enumerate(worst.items()):
            look = jid.plot.line_style(number)
            middle = np.median(spread, axis=1)
            axes.loglog(cost, middle, marker="os"[number], label=f"{name}, median", **look)
            low, high = np.min(spread, axis=1), np.max(spread, axis=1)
            axes.fill_between(cost, low, high, color=look["color"], alpha=0.15, linewidth=0)
        axes.axhline(5.0, color="#999999", linewidth=0.8)
        axes.text(cost[0], 5.3, "5 %", color="#666666", fontsize=8)
        axes.set_xlabel("candidates tried [–]")
        axes.set_ylabel("error of the worst parameter [%]")
        axes.legend(loc="lower left")
        titled(axes, f"Section 5.5: {trials} trials each; shaded from best to worst")
    gallery.note("5.5", "candidates to one good, by chance", 1.0 / chance(joint), "", "6.4e7")
    for name, count in good.items():
        figure = f"{name}, {cost[-1]} candidates: trials with all within 5 %"
        gallery.note("5.5", figure, count, f"of {trials}")
    long = thesis.replace(population=2000, generations=100 if gallery.quick else 32_000)
    best, size = penalty.random(long, 0)
    tried = f"random, {2000 * (long.generations + 1):.2g} candidates"
    gallery.note("5.5", f"{tried}: worst parameter", max(map(abs, errors(best).values())), "%")
    by_ga = penalty.genetic(thesis.replace(generations=generations[-1]), 0)[1]
    gallery.note("5.5", f"{tried}: penalty against the genetic search's", size / by_ga, "times")
