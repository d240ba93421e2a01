"""`sweep`: identify again and again, over settings and seeds."""

from __future__ import annotations

import os
import time
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from concurrent.futures import FIRST_COMPLETED, BrokenExecutor, Executor, Future, wait
from contextlib import nullcontext
from dataclasses import dataclass, replace
from typing import Any

from jointid.base.advice import Action
from jointid.base.argument_checks import require_path, whole_number
from jointid.base.errors import InputError
from jointid.identification.prepared import require_joint
from jointid.identification.search.search import Search
from jointid.joint.joint import Joint
from jointid.joint.model import Model
from jointid.problem.problem import Windows, listed
from jointid.recording.recording import Recording
from jointid.simulation.scenario import Scenario
from jointid.study.grid import cells_of
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
            f"a worker of the executor ended unexpectedly after {len(study.rows)} of "
            f"{len(study.cells) * study.trials} trials, perhaps for lack of memory. A study with an output file can be "
            "resumed"
        )
        self.study = study


def sweep(
    subject: Recording | Sequence[Recording] | Scenario,
    joint: Joint | None = None,
    *,
    grid: Mapping[str, Any] | None = None,
    trials: int = 10,
    model: Model | str | Mapping[str, Any] | None = None,
    parameters: Mapping[str, Any] | None = None,
    search: Search | str | None = None,
    residual: str | None = None,
    windows: Windows = None,
    torque_hold: str | None = None,
    mask_standstill: bool = True,
    standard_errors: bool = False,
    tracking: bool = False,
    truth: Mapping[str, float] | None = None,
    executor: Executor | None = None,
    callback: Callable[[StudyStep], object] | None = None,
    output: str | os.PathLike[str] | None = None,
    resume: bool = False,
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
        (``"windows"``, ``"model"``, ``"model.FIELD"``, …), of the search ``"method"``, ``"ga"`` and
        ``"ga.FIELD"``, ``"parameters.NAME"`` (fixed), and of a
        scenario its fields, ``"sensors.FIELD"``, ``"controller.FIELD"``, ``"truth.NAME"``.
        Default: one cell.
    trials : int
        Of each combination. Default 10.
    model, parameters, residual, windows, torque_hold, mask_standstill
        As in `identify`, for all cells.
    search : Search or str, optional
        As in `identify`. Trial t has its seed + t, in every cell: for the search, and for the noise of a
        simulated recording; `identify` with a row's seed gives the row. Its threads, where 0, are all here
        and 1 each in an executor. Callback, checkpoint and resume are not for a sweep.
    standard_errors : bool
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
    callback : callable, optional
        Called with a `StudyStep` whenever trials are done; returning True stops.
    output : path, optional
        A file (.jsonl) that keeps each row as it is done.
    resume : bool
        Whether to go on with an existing `output`; also with more trials. Default False.

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
    common = {
        "model": model,
        "parameters": parameters,
        "residual": residual,
        "windows": windows,
        "torque_hold": torque_hold,
        "mask_standstill": mask_standstill,
    }
    chosen = _searched(Search.of(search))
    work = _work(subject, joint, grid, chosen, common, standard_errors, tracking)
    if chosen.threads == 0 and executor is not None:
        work = replace(work, threads=1)
    trials = whole_number("trials", trials, 1, 10**9)
    whole_number("seed", work.seed + trials - 1, 0, 2**64 - 1)
    if callback is not None and not callable(callback):
        raise InputError("a function is expected", argument="callback", value=callback)
    if executor is not None and not hasattr(executor, "submit"):
        raise InputError(
            "a concurrent.futures.Executor is expected", argument="executor", value=executor
        )
    header = header_of_work(work, trials, truth)
    file = None
    if output is not None:
        output = require_path("output", output)
        if output.suffix != ".jsonl":
            raise InputError(
                "a file that ends in .jsonl is expected",
                argument="output",
                value=str(output),
                remedy="save the study as a table when it is done",
            )
        file = StudyFile(output, header, resume=resume)
    elif resume:
        raise InputError(
            "there is no file to continue",
            argument="resume",
            value=True,
            remedy=Action("call", {"output": ...}, text="the file of the study", function="sweep"),
        )
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
        # A row has only the error's text: run its trial again for the error itself.
        list(Runner(work, strict=True).run([rows[0].place]))
        raise InputError(rows[0].message)
    return study_of(header, rows, time.perf_counter() - began)


def _searched(search: Search) -> Search:
    """The search of a sweep: what belongs to a single run is refused."""
    for name in ("callback", "checkpoint", "resume"):
        if getattr(search, name) is not None:
            raise InputError(
                "a sweep has its own callback and its own file",
                argument=f"search.{name}",
                remedy="leave it out of the search",
            )
    return search


def _work(
    subject: Recording | Sequence[Recording] | Scenario,
    joint: Joint | None,
    grid: Mapping[str, Any] | None,
    search: Search,
    common: dict[str, Any],
    standard_errors: bool,
    tracking: bool,
) -> Work:
    for name, flag in (("standard_errors", standard_errors), ("tracking", tracking)):
        if not isinstance(flag, bool):
            raise InputError("true or false is expected", argument=name, value=flag)
    require_joint(joint)
    scenario = subject if isinstance(subject, Scenario) else None
    if tracking:
        if scenario is None:
            raise InputError(
                "the tracking error after identification needs a simulation, and recordings are given",
                argument="tracking",
                value=True,
                remedy="give a scenario instead of recordings",
            )
        scenario.believing(scenario.joint)
    work = Work(
        subject=scenario if scenario is not None else listed(subject),  # type: ignore[arg-type]
        joint=joint,
        common=common | {"model": Model.of(common["model"])},
        search=search,
        cells=cells_of(grid or {}, scenario),
        standard_errors=standard_errors,
        tracking=tracking,
        threads=search.threads,
    )
    for cell in work.cells:  # what is wrong in itself is reported before the work
        cell.search(search, search.seed, search.threads)
        cell.options(work.common)
    return work


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
