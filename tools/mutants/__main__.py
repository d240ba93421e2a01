"""Try the mutants of the lists: `python -m mutants`, with `tools` on Python's path."""

from __future__ import annotations

import argparse
import os
import random
import sys
import time
from pathlib import Path

from measured_page import write_part

from mutants import page, tree
from mutants.catalogue import LISTS, REPOSITORY, Mutant, MutantError, check_places, read
from mutants.kept import VERDICTS, Kept
from mutants.running import Trials, Verdict


def main(arguments: list[str] | None = None) -> int:
    """Return 0 if at least 90 % die and each of the others is justified, 1 if not, 2 if a list is wrong."""
    options = _parser().parse_args(arguments)
    try:
        return _tried(options)
    except MutantError as error:
        sys.stderr.write(f"{error}\n")
        return 2


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(prog="mutants", description=__doc__)
    parser.add_argument("--lists", type=Path, default=LISTS, help="folder of the lists")
    parser.add_argument(
        "--only", default="", metavar="TEXT", help="only lists or files with this in their name"
    )
    parser.add_argument(
        "--python", action="store_true", help="only mutants in Python; nothing is compiled"
    )
    parser.add_argument("--again", action="store_true", help="also mutants with a valid verdict")
    parser.add_argument(
        "--sample", type=int, metavar="N", help="a sample of N mutants that were killed earlier"
    )
    parser.add_argument("--seed", type=int, default=1, help="seed of the sample")
    parser.add_argument("--quick", action="store_true", help="skip slow tests; store no verdict")
    parser.add_argument(
        "--check", action="store_true", help="only check that each text is in its place"
    )
    parser.add_argument("--verdicts", type=Path, default=VERDICTS, help="folder of the results")
    parser.add_argument(
        "--jobs", type=int, default=os.cpu_count() or 1, help="number of parallel processes"
    )
    parser.add_argument("--folder", type=Path, default=REPOSITORY / "build" / "mutants")
    parser.add_argument("--write", action="store_true", help="write the part of the page")
    return parser


def _tried(options: argparse.Namespace) -> int:
    everything = read(options.lists)
    check_places(everything)
    mutants = [each for each in everything if _chosen(each, options)]
    print(f"{len(everything)} mutants in the lists, {len(mutants)} chosen", flush=True)
    kept = Kept(options.verdicts, everything)
    if options.sample:
        killed = [each.mutant for each in kept.find(mutants) if each.killed]
        mutants = random.Random(options.seed).sample(killed, options.sample)
        print(f"{options.sample} of {len(killed)} drawn with seed {options.seed}", flush=True)
    if options.check:
        _page(kept, everything, write=options.write)
        return 0
    began = time.monotonic()
    folder = options.folder.resolve()
    known = [] if options.again or options.quick else kept.current(mutants)
    chosen = _others(mutants, known)
    tried = _trials(folder, everything, chosen, kept, options)
    minutes = (time.monotonic() - began) / 60.0
    verdicts = sorted([*known, *tried], key=lambda each: each.mutant.number)
    print(f"{page.summary(verdicts)}; {len(known)} of them earlier; {minutes:.1f} minutes")
    for each in verdicts:
        if not each.killed and each.mutant.justified:
            print(f"justified: {each.mutant}: {each.mutant.justified}")
    _page(kept, everything, write=options.write)
    wrong = page.complaints(verdicts)
    print("\n".join(wrong), end="\n" if wrong else "")
    return 1 if wrong else 0


def _page(kept: Kept, everything: list[Mutant], *, write: bool) -> None:
    if write:
        write_part(page.written(kept.find(everything), everything))


def _trials(
    folder: Path,
    everything: list[Mutant],
    mutants: list[Mutant],
    kept: Kept,
    options: argparse.Namespace,
) -> list[Verdict]:
    if not mutants:
        return []
    extension, core_check = tree.installed_core(), None
    if not all(each.is_python for each in mutants):
        # All mutants, so that another choice needs no compiler.
        print("building the core with all mutants in it", flush=True)
        inside = [each for each in everything if not each.is_python]
        extension, core_check = tree.built_core(folder, inside, options.jobs)
    packages = [
        tree.package(folder / f"package_{number}", extension) for number in range(options.jobs)
    ]
    trials = Trials(packages, core_check, folder / "logs", options.quick)
    return trials.all_of(mutants, _told, (lambda _: None) if options.quick else kept.add)


def _others(mutants: list[Mutant], known: list[Verdict]) -> list[Mutant]:
    numbers = {each.mutant.number for each in known}
    return [each for each in mutants if each.number not in numbers]


def _chosen(mutant: Mutant, options: argparse.Namespace) -> bool:
    if options.python and not mutant.is_python:
        return False
    return options.only in f"{mutant.room}: {mutant.path}"


def _told(line: str) -> None:
    print(line, flush=True)


if __name__ == "__main__":
    sys.exit(main())
