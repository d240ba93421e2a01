"""Command `sweep`."""

from __future__ import annotations

import argparse
import json
import os
import threading
from collections.abc import Iterator
from contextlib import contextmanager, nullcontext
from pathlib import Path
from typing import TYPE_CHECKING, Any

from jointid.base.errors import InputError
from jointid.cli.arguments import (
    by_name,
    method_argument,
    number_or_text,
    pair,
    several_recordings,
    whole,
    whole_seed,
    with_terms,
)
from jointid.cli.options import declared_arguments, stated_options
from jointid.cli.outputs import check_folder, check_page
from jointid.cli.parser import CommandParser
from jointid.cli.reading import load_all
from jointid.cli.scenario import scenario_arguments, scenario_of

if TYPE_CHECKING:
    from concurrent.futures import Executor
    from multiprocessing.process import BaseProcess

    from jointid.study.study_result import Study


def add_sweep(sweep: CommandParser) -> None:
    """Add the command's grammar."""
    sweep.epilog = (
        "examples:\n"
        "  jointid sweep run.csv --joint joint.toml --grid ga.population=20,50,100 --grid ga.generations=50,500\n"
        "  jointid sweep run.csv --joint joint.toml --grid windows=100,400,1600 --trials 1 --table sweep.csv\n"
        "  jointid sweep --simulate joint.toml --trajectory thesis:amplitude=60deg,cycle=3 \\\n"
        "      --grid sensors.torque_noise=0.1,0.5,2 --trials 20 --output study.jsonl\n"
        "  jointid sweep --simulate joint.toml … --output study.jsonl --resume   (continues)"
    )
    several_recordings(sweep, nargs="*", use="fitted as one")
    sweep.add_argument(
        "--simulate",
        type=Path,
        metavar="JOINT",
        help="simulate the joint of this file for each trial, instead of reading recordings",
    )
    scenario_arguments(sweep)
    sweep.add_argument("--joint", type=Path, help="joint file (.toml) with the known values")
    sweep.add_argument(
        "--grid",
        action="append",
        type=pair,
        default=[],
        metavar="SETTING=VALUE,…",
        help="a setting to sweep, such as ga.population, windows, method, sensors.torque_noise",
    )
    sweep.add_argument(
        "--trials",
        type=whole,
        help="trials of each combination (default: 10 for a simulation or a random search, otherwise 1)",
    )
    for name, explanation in (
        ("--ga", "options of the genetic algorithm: default, thesis or thesis_code"),
        ("--model", "friction model, such as stribeck:ripple=2"),
    ):
        sweep.add_argument(name, help=explanation)
    method_argument(sweep)
    declared_arguments(sweep)
    sweep.add_argument(
        "--standard-errors",
        action=argparse.BooleanOptionalAction,
        default=True,
        help="compute the standard errors of each trial (default: yes)",
    )
    sweep.add_argument(
        "--tracking",
        action="store_true",
        help="with --simulate: find the tracking error by a simulation with the identified parameters",
    )
    sweep.add_argument(
        "--seed", type=whole_seed, default=0, help="seed of the first trial (default 0)"
    )
    sweep.add_argument("--threads", type=whole, help="number of threads; 0: all cores")
    sweep.add_argument("--workers", type=whole, help="number of processes that share the trials")
    sweep.add_argument("--output", type=Path, help="file to which each trial is added (.jsonl)")
    sweep.add_argument(
        "--resume", action="store_true", help="continue the study in the file of --output"
    )
    sweep.add_argument("--table", type=Path, help="file for the table: .csv or .parquet")
    sweep.add_argument(
        "--plot", type=Path, help="draw the penalty over the first settings: .png, .pdf, .svg"
    )
    sweep.add_argument("--report", type=Path, help="write the HTML report to this file")
    sweep.add_argument("--json", action="store_true", help="print the summary as JSON")
    sweep.add_argument("--quiet", action="store_true", help="no progress bar")


def sweep(arguments: argparse.Namespace) -> None:
    """Identify with many settings."""
    from jointid.cli.progress import StudyProgress
    from jointid.identification.search.search import Search
    from jointid.joint.joint import Joint
    from jointid.study import sweeping

    for option in ("output", "table", "plot"):
        check_folder(option, getattr(arguments, option))
    check_page("report", arguments.report)
    if arguments.table is not None and arguments.table.suffix not in (".csv", ".parquet"):
        raise InputError(
            "a table is written as .csv or .parquet", argument="table", value=arguments.table
        )
    if arguments.plot is not None and arguments.plot.suffix not in (".png", ".pdf", ".svg"):
        raise InputError(
            "a plot is written as .png, .pdf or .svg", argument="plot", value=arguments.plot
        )
    if (arguments.simulate is None) == (not arguments.recordings):
        if arguments.recordings:
            raise InputError("a study needs recordings or a simulation (--simulate), not both")
        raise InputError("nothing to identify", remedy="give recordings or --simulate JOINT")
    options = stated_options(arguments)
    subject: Any
    unnamed = False
    model = with_terms(arguments.model, arguments)
    if arguments.terms and arguments.simulate is not None:
        raise InputError("a simulation has no extra signals", argument="terms", value=model.terms)
    if arguments.simulate is not None:
        subject = scenario_of(arguments.simulate, arguments)
    else:
        known = [] if arguments.joint is None else [Joint.load(arguments.joint).model]
        subject = load_all(arguments.recordings, arguments, [model, *known])
        unnamed = not any(each.named for each in (model, *known))
    with (
        _continuation(arguments),
        _workers(arguments.workers) as executor,
        StudyProgress(enabled=not arguments.quiet) as progress,
    ):
        study = sweeping.sweep(
            subject,
            Joint.load(arguments.joint) if arguments.joint is not None else None,
            grid=_grid(arguments.grid),
            trials=arguments.trials,
            search=Search(
                arguments.method,
                ga=arguments.ga,
                seed=arguments.seed,
                threads=arguments.threads or 0,
            ),
            standard_errors=arguments.standard_errors,
            tracking=arguments.tracking,
            executor=executor,
            callback=progress,
            output=arguments.output,
            resume=arguments.resume,
            model=model,
            **options,
        )
    _write(study, arguments)
    if unnamed and "model" not in study.swept and not arguments.json:
        print(
            "\nmodel: coulomb_viscous, because no model is named; jointid compare shows which model predicts best"
        )


@contextmanager
def _continuation(arguments: argparse.Namespace) -> Iterator[None]:
    """Report for a sweep that ended early how many trials are done, and how to continue."""
    from jointid.study.sweeping import StudyBrokenError, StudyInterruptedError

    if arguments.output is None:
        remedy = "the trials are lost; --output study.jsonl keeps each trial"
    else:
        remedy = f"the trials are in {arguments.output}; the same command with --resume continues the study"
    try:
        yield
    except StudyInterruptedError as stop:
        raise KeyboardInterrupt(f"{stop}; {remedy}") from None
    except StudyBrokenError as error:
        done = str(error).partition(". ")[0]
        raise InputError(done, remedy=remedy) from error


def _write(study: Study, arguments: argparse.Namespace) -> None:
    if arguments.table is not None:
        study.save(arguments.table)
    if arguments.plot is not None:
        from matplotlib.figure import Figure

        from jointid.base.pictures import write_picture
        from jointid.plot.study import sweep as draw

        figure = Figure(figsize=(6.4, 4.0), constrained_layout=True)
        y = study.swept[1] if len(study.swept) > 1 else None
        draw(study, y=y, ax=figure.subplots())
        write_picture(figure, arguments.plot, dpi=160)
    if arguments.report is not None:
        from jointid.report.saving import save_report

        save_report(study, arguments.report)
    summary = study.summary()
    print(json.dumps(summary.asdict(), indent=1, ensure_ascii=False) if arguments.json else summary)
    written = {name: getattr(arguments, name) for name in ("table", "plot", "report")}
    files = [f"{name}: {path}" for name, path in written.items() if path is not None]
    if files and not arguments.json:
        print("", *files, sep="\n")


def _workers(count: int | None) -> Executor | nullcontext[None]:
    if count is None:
        return nullcontext()
    if not 1 <= count <= 1024:
        raise InputError("1 to 1024 processes are expected", argument="workers", value=count)
    from concurrent.futures import ProcessPoolExecutor
    from multiprocessing import get_context

    # Each one is a new interpreter, because a fork of a process with threads may hang.
    return ProcessPoolExecutor(
        count, mp_context=get_context("spawn"), initializer=_end_with_the_command
    )


def _end_with_the_command() -> None:
    """End a worker when its command has ended. A killed command sends no signal, and workers would wait forever."""
    from multiprocessing import parent_process

    command = parent_process()
    if command is not None:
        threading.Thread(target=_end_after, args=(command,), daemon=True).start()


def _end_after(command: BaseProcess) -> None:
    command.join()
    os._exit(1)


def _grid(pairs: list[tuple[str, str]]) -> dict[str, list[Any]]:
    return {
        name: [_value(text) for text in values.split(",")]
        for name, values in by_name("grid", pairs).items()
    }


def _value(text: str) -> Any:
    words = {"true": True, "false": False, "none": None}
    return words[text] if text in words else number_or_text(text)
