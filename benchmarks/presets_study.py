"""`make study`, third part: presets of the thesis and other settings on `well_excited`. Prints a Markdown table.

A row has the mean absolute error of each parameter over the seeds. It also has the number of seeds with all six
parameters within 5 % of the truth (the criterion of the thesis). A row of 100 seeds with 200 × 1500 candidates takes
some seconds.
"""

import argparse

import numpy as np
from recordings import WELL_EXCITED

import jointid as jid
from jointid.identification.search.search import Method

TRUTH = {
    "coulomb": 25.0,
    "static": 20.0,
    "stribeck": 100.0,
    "viscous": 20.0,
    "sensor_offset": 15.0,
    "sensor_gain": 2.4,
}


def rows() -> dict[str, tuple[Method, jid.GaOptions]]:
    """Return method and options by the name of the row."""
    text, code = jid.GaOptions.thesis(), jid.GaOptions.thesis_code()
    plain = jid.GaOptions(population=200, generations=1500, polish=False)
    binary = plain.replace(coding="binary", bit_crossover="two_point")
    text_200, code_200 = (o.replace(population=200, generations=1500) for o in (text, code))
    return {
        "default": ("ga", jid.GaOptions()),
        "thesis-100": ("ga", text.replace(population=100, generations=1000)),
        "thesis-200": ("ga", text_200),
        "code-100": ("ga", code.replace(population=100, generations=1000)),
        "code-200": ("ga", code_200),
        "gene-200": ("ga", text_200.replace(mutation_unit="gene")),
        "real-200": ("ga", plain),  # same settings as binary-200, except the coding
        "binary-200": ("ga", binary),
        "random-200": ("random", plain),
    }


def main(names: list[str], seeds: int) -> None:
    """Run the searches and print the table."""
    recording = jid.load(WELL_EXCITED)
    print("| search | all within 5 % | " + " | ".join(TRUTH) + " |")
    print("|---|---|" + "---|" * len(TRUTH))
    for name in names:
        method, options = rows()[name]
        errors = np.array(
            [
                [
                    100.0 * abs(estimate.parameters[key].value / truth - 1.0)
                    for key, truth in TRUTH.items()
                ]
                for estimate in (
                    jid.identify(
                        recording,
                        jid.thesis_joint(),
                        residual="sensor",  # the residual of the thesis
                        search=jid.Search(method, ga=options, seed=seed),
                    )
                    for seed in range(seeds)
                )
            ]
        )
        good = int(np.sum(np.all(errors < 5.0, axis=1)))
        shown = " | ".join(f"{error:.2f}" for error in errors.mean(axis=0))
        print(f"| {name} | {good} of {seeds} | {shown} |", flush=True)


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("rows", nargs="*", help=f"of {', '.join(rows())}; default: all")
    parser.add_argument("--seeds", type=int, default=100)
    arguments = parser.parse_args()
    main(arguments.rows or list(rows()), arguments.seeds)
