"""`sweep`: identify again and again, over settings and seeds."""

from __future__ import annotations

import os
import time
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from concurrent.futures import FIRST_COMPLETED, BrokenExecutor, Executor, Future, wait
from contextlib import nullcontext
from dataclasses import dataclass, replace
from typing import Any

from jointid.base.argument_checks import require_path
from jointid.base.errors import InputError
from jointid.identification.search.search import METHODS
from jointid.joint.joint import Joint
from jointid.joint.parameters import suggestion
from jointid.problem.problem import listed, whole_number
from jointid.recording.recording import Recording
from jointid.simulation.scenario import Scenario
from jointid.study.grid import OPTIONS, cells_of, genetic_options
from jointid.study.header import header_of_work
from jointid.study.row import REFUSED, Row
from jointid.study.runner import Runner, run_chunk
from jointid.study.study_file import StudyFile
from jointid.study.study_result import Study, study_of
from jointid.study.work import Place, Work

_OUTSTANDING = 64  # parts that wait in an executor, at most
_LONGEST_WAIT = 0.05  # [s] between two looks at Ctrl-C


@dataclass(frozen=True, slots=True, kw_only=True)
class StudyStep:
    """Progress of a study, as the callback sees it.

    Attributes
    ----------
    number, total : int
        Trials done so far, and in all.
    rows : tuple of Row
        Those done since the last call.
    """

    number: int
    total: int
    rows: tuple[Row, ...]


class StudyInterruptedError(KeyboardInterrupt):
    """Ctrl-C in a sweep; `study` has what was done until then.

    Parameters
    ----------
    study : Study
    """

    def __init__(self, study: Study) -> None:
        super().__init__(f"{len(study.rows)} of {len(study.cells) * study.trials} trials were done")
        self.study = study


class StudyBrokenError(RuntimeError):
    """A sweep's executor lost a worker; `study` has what was done until then.

    Parameters
    ----------
    study : Study
    """

    def __init__(self, study: Study) -> None:
        super().__init__(
            f"a worker of the executor died after {len(study.rows)} of {len(study.cells) * study.trials} "
            "trials; out of memory perhaps. What is in output= can be gone on with by resume=True"
        )
        self.study = study


def sweep(
    subject: Recording | Sequence[Recording] | Scenario,
    joint: Joint | None = None,
    *,
    grid: Mapping[str, Any] | None = None,
    trials: int = 10,
    seed: int = 0,
    stderr: bool = False,
    tracking: bool = False,
    truth: Mapping[str, float] | None = None,
    executor: Executor | None = None,
    threads: int | None = None,
    callback: Callable[[StudyStep], object] | None = None,
    output: str | os.PathLike[str] | None = None,
    resume: bool = False,
    **options: Any,
) -> Study:
    """Identify with every combination of some settings, several times each.

    Parameters
    ----------
    subject : Recording, sequence of Recording, or Scenario
        What to identify from. A scenario is simulated for each trial, with a seed of its own.
    joint : Joint, optional
        As in `identify`. Default with a scenario: the simulated one, of which the search uses bounds
        and known facts, not the values.
    grid : mapping of str to sequence or mapping, optional
        Settings by name, each with its values, or with labels and values: arguments of `identify`
        (``"windows"``, ``"method"``, ``"model"``, …), ``"ga"`` (``"default"``, ``"thesis"``,
        ``"thesis_code"`` or GaOptions), ``"ga.FIELD"``, ``"parameters.NAME"`` (fixed), and of a
        scenario its fields, ``"sensors.FIELD"``, ``"controller.FIELD"``, ``"truth.NAME"``.
        Default: one cell.
    trials : int
        Of each combination. Default 10.
    seed : int
        Trial t has the seed ``seed + t``, in every cell: for the search, and for the noise of a
        simulated recording. `identify` with a row's seed gives the row. Default 0.
    stderr : bool
        Whether to have standard errors, too; some milliseconds more a trial. Default False.
    tracking : bool
        Of a scenario whose controller compensates friction: whether to simulate again with the
        identified and with the true parameters. Default False.
    truth : mapping of str to float, optional
        True parameters [SI], for biases and shares of success. Default: what the recordings or the
        scenario know.
    executor : concurrent.futures.Executor, optional
        Who does the trials: a process pool, or a cluster's, such as Dask's ``client.get_executor()``.
        It is left running. Default: this process.
    threads : int, optional
        Default: all; in an executor, 1 each.
    callback : callable, optional
        Called with a `StudyStep` whenever trials are done; returning True stops.
    output : path, optional
        A file (.jsonl) that keeps each row as it is done.
    resume : bool
        Whether to go on with an existing `output`; also with more trials. Default False.
    **options
        Arguments of `identify` for all cells.

    Returns
    -------
    Study
        The same rows, bit for bit, for any executor and number of threads, in one go or resumed.

    Raises
    ------
    InputError
        Anything that cannot be used, in one sentence. Settings that cannot be used with a recording
        give rows with the status "refused"; only if all are refused is it an error.
    StudyBrokenError
        The executor lost a worker.
    StudyInterruptedError
        Ctrl-C, within 0.1 s; a `KeyboardInterrupt` whose `study` has the rows done so far.
    """
    began = time.perf_counter()
    work = _work(subject, joint, grid, seed, options, stderr, tracking)
    work = _threaded(work, executor, threads)
    trials = whole_number("trials", trials, 1, 10**9)
    whole_number("seed", work.seed + trials - 1, 0, 2**64 - 1)
    if callback is not None and not callable(callback):
        raise InputError(f"callback must be callable, got {callback!r}")
    if executor is not None and not hasattr(executor, "submit"):
        raise InputError(f"executor is {executor!r}; a concurrent.futures.Executor is expected")
    header = header_of_work(work, trials, truth)
    file = None
    if output is not None:
        output = require_path("output", output)
        if output.suffix != ".jsonl":
            raise InputError(
                f"output {output}: a study grows in a .jsonl file; Study.save writes tables"
            )
        file = StudyFile(output, header, resume=resume)
    elif resume:
        raise InputError("resume=True goes on with a file; give it as output=")
    rows = [] if file is None else [row for row in file.rows if row.trial < trials]
    total = len(work.cells) * trials
    places = work.ordered(trials, (row.place for row in rows))
    try:
        with file if file is not None else nullcontext():
            for done in _done(work, places, executor):
                if file is not None:
                    file.append(done)
                rows += done
                if callback is not None and callback(
                    StudyStep(number=len(rows), total=total, rows=tuple(done))
                ):
                    break
    except BrokenExecutor as error:
        raise StudyBrokenError(study_of(header, rows, time.perf_counter() - began)) from error
    except KeyboardInterrupt as interrupt:
        study = study_of(header, rows, time.perf_counter() - began)
        raise StudyInterruptedError(study) from interrupt
    if rows and all(row.status == REFUSED for row in rows):
        raise InputError(rows[0].message)
    return study_of(header, rows, time.perf_counter() - began)


def _work(
    subject: Recording | Sequence[Recording] | Scenario,
    joint: Joint | None,
    grid: Mapping[str, Any] | None,
    seed: int,
    options: dict[str, Any],
    stderr: bool,
    tracking: bool,
) -> Work:
    for name in options:
        if name not in OPTIONS:
            raise InputError(f"sweep: '{name}' is no option; {suggestion(name, OPTIONS)}")
    for name, flag in (("stderr", stderr), ("tracking", tracking)):
        if not isinstance(flag, bool):
            raise InputError(f"{name} must be True or False, got {flag!r}")
    if joint is not None and not isinstance(joint, Joint):
        raise InputError(
            f"joint must be a Joint, got {joint!r}; read a file with jointid.Joint.load"
        )
    if "ga" in options:
        options = options | {"ga": genetic_options(options["ga"])}
    scenario = subject if isinstance(subject, Scenario) else None
    if tracking:
        if scenario is None:
            raise InputError("tracking=True simulates; give a jointid.Scenario, not recordings")
        scenario.believing(scenario.joint)
    work = Work(
        subject=scenario if scenario is not None else listed(subject),  # type: ignore[arg-type]
        joint=joint,
        common=options,
        cells=cells_of(grid or {}, scenario),
        seed=whole_number("seed", seed, 0, 2**64 - 1),
        stderr=stderr,
        tracking=tracking,
        threads=0,
    )
    for cell in work.cells:  # what is wrong in itself is told before the work
        cell.genetic(work.common)
        method = cell.options(work.common).get("method", "ga")
        if method not in METHODS:
            raise InputError(f"method {method!r} is not known; known are {', '.join(METHODS)}")
    return work


def _threaded(work: Work, executor: Executor | None, threads: int | None) -> Work:
    usual = 0 if executor is None else 1
    return replace(
        work, threads=usual if threads is None else whole_number("threads", threads, 0, 1024)
    )


def _done(work: Work, places: Sequence[Place], executor: Executor | None) -> Iterator[list[Row]]:
    """Rows as they come."""
    if executor is None:
        runner = Runner(work)
        for chunk in work.chunks(places):
            yield from runner.run(chunk)
        return
    yield from _elsewhere(work, places, executor)


def _elsewhere(work: Work, places: Iterable[Place], executor: Executor) -> Iterator[list[Row]]:
    chunks = work.chunks(list(places))
    running: set[Future[list[Row]]] = set()
    try:
        while True:
            while len(running) < _OUTSTANDING and (chunk := next(chunks, None)) is not None:
                running.add(executor.submit(run_chunk, work, chunk))
            if not running:
                return
            finished = wait(running, timeout=_LONGEST_WAIT, return_when=FIRST_COMPLETED).done
            running -= finished
            for future in finished:
                yield future.result()
    finally:
        for future in running:
            future.cancel()
