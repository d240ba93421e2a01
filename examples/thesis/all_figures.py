"""Every figure of the thesis that can be computed: pictures and a table of numbers.

python examples/thesis/all_figures.py --output figures [--quick] [GROUP ...]
"""

import argparse
import time
from collections.abc import Callable
from pathlib import Path

import converter_study
import estimates_compared
import guess_and_error
import matplotlib
import models_and_adaptation
import population_grid
import random_search
import ripple_and_open_loop
import sensitivity_study
import sine_example
import trajectories
import trial_and_error
import window_study
from gallery import Gallery

GROUPS: dict[str, Callable[[Gallery], None]] = {
    module.__name__: module.draw
    for module in (
        models_and_adaptation,
        sensitivity_study,
        sine_example,
        window_study,
        trajectories,
        guess_and_error,
        population_grid,
        random_search,
        converter_study,
        estimates_compared,
        trial_and_error,
        ripple_and_open_loop,
    )
}


def main(folder: Path, groups: list[str], *, quick: bool) -> Gallery:
    """Draw the groups and write the table."""
    matplotlib.use("Agg")
    gallery = Gallery(folder, quick=quick)
    folder.mkdir(parents=True, exist_ok=True)
    for name in groups:
        started = time.perf_counter()
        GROUPS[name](gallery)
        print(f"{name}: {time.perf_counter() - started:.1f} s", flush=True)
    gallery.write_table()
    return gallery


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("groups", nargs="*", metavar="GROUP", help=f"of {', '.join(GROUPS)}")
    parser.add_argument("--output", type=Path, required=True, help="folder for the pictures")
    parser.add_argument(
        "--quick", action="store_true", help="small settings: a minute, rough numbers"
    )
    arguments = parser.parse_args()
    for group in arguments.groups:
        if group not in GROUPS:
            parser.error(f"group '{group}' is not known; choose one of {', '.join(GROUPS)}")
    main(arguments.output, arguments.groups or list(GROUPS), quick=arguments.quick)
