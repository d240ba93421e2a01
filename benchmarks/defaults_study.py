"""Least number of candidates: how many of 100 seeds reach the separable optimum, by population and generations.

Prints a Markdown table. A seed reaches the optimum if its penalty is at most 1e-6 above the optimal one, relative. The
polish ends with a search over the whole ranges of the shape parameters. "alone" leaves out this search: it shows the
result of only the genetic algorithm and the local polish.
"""

import argparse
from typing import Any

from recordings import WELL_EXCITED

import jointid as jid
from jointid import _core
from jointid.cli.demonstration import data_folder
from jointid.identification.search.domain import SearchDomain, domain_for
from jointid.identification.search.run import Engine
from jointid.problem.problem import Problem
from jointid.problem.terms import Request, choose_terms

SIZES = ((10, 10), (16, 10), (20, 20), (20, 40), (24, 40), (30, 60), (40, 80), (60, 120))
CLOSE = 1e-6


def problem(
    recording: jid.Recording, joint: jid.Joint | None, **model: Any
) -> tuple[_core.Penalty, SearchDomain]:
    """Return the penalty and its domain, as in `identify`."""
    residual = model.pop("residual", None)
    name = model.pop("model", None)
    request = Request(model=jid.Model(name, **model), residual=residual)
    choice = choose_terms((recording,), joint, request)
    whole = Problem(recordings=(recording,), joint=joint, choice=choice)
    penalty = whole.penalty(None)
    return penalty, domain_for(penalty, joint, None, whole.peak_speed)


def reached(
    penalty: _core.Penalty, domain: SearchDomain, options: _core.GaOptions, seeds: int
) -> tuple[int, int]:
    """Return the numbers of seeds that reach the optimum: with the whole polish, and with the local polish alone."""
    engine = Engine.of(penalty, domain, 0)
    low, high = domain.lower, domain.upper
    best = _core.minimise_separable(engine.form, low, high).best
    best_penalty = _core.polish(penalty, low, high, best).penalty
    whole = alone = 0
    near: _core.SeparableResult | _core.PolishResult
    for seed in range(seeds):
        found = _core.minimise_genetic(
            engine.form, low, high, options=options, seed=seed, threads=1
        )
        polished, _, _ = engine.polished(domain, found.best)
        near = _core.refine_separable(engine.form, low, high, found.best, everywhere=False)
        if len(low) - penalty.coefficients > 1:
            near = _core.polish(penalty, low, high, near.best)
        whole += penalty(polished) <= best_penalty * (1.0 + CLOSE)
        alone += near.penalty <= best_penalty * (1.0 + CLOSE)
    return whole, alone


def main(seeds: int) -> None:
    """Print the table."""
    excited = jid.load(WELL_EXCITED)
    industrial = jid.load(data_folder() / "kr300_joint1.csv.gz")
    thesis, robot = jid.thesis_joint(), jid.Joint.load(data_folder() / "kr300_joint1.toml")
    problems = {
        "well_excited, sensor": problem(excited, thesis),
        "well_excited, torque": problem(excited, thesis, residual="torque"),
        "well_excited, no joint": problem(excited, None, model="stribeck"),
        "well_excited, two shapes": problem(excited, thesis, model="stribeck_general"),
        "KR300": problem(industrial, robot),
        "KR300, Stribeck (too rich)": problem(industrial, robot, model="stribeck"),
    }
    print("| population x generations | candidates | " + " | ".join(problems) + " |")
    print("|---|---|" + "---|" * len(problems))
    for population, generations in SIZES:
        options = _core.GaOptions(population=population, generations=generations)
        cells = [
            "{} (alone {})".format(*reached(penalty, domain, options, seeds))
            for penalty, domain in problems.values()
        ]
        candidates = population * (generations + 1)
        print(f"| {population} x {generations} | {candidates} | " + " | ".join(cells) + " |")


if __name__ == "__main__":
    arguments = argparse.ArgumentParser(description=__doc__)
    arguments.add_argument("--seeds", type=int, default=100)
    main(arguments.parse_args().seeds)
