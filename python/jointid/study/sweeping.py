"""Identify over settings and seeds: the function `sweep`."""

from __future__ import annotations

import os
import time
from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import BrokenExecutor, Executor
from contextlib import nullcontext
from dataclasses import dataclass, replace
from typing import Any, Unpack

from jointid.base.advice import Action
from jointid.base.argument_checks import require_path, whole_number
from jointid.base.errors import InputError
from jointid.base.options import takes
from jointid.identification.options import IdentifyOptions
from jointid.identification.search.search import Search
from jointid.joint.joint import Joint
from jointid.recording.recording import Recording
from jointid.simulation.scenario import Scenario
from jointid.study import study_file
from jointid.study.execution import finished_rows
from jointid.study.header import header_of_work
from jointid.study.planning import work_of
from jointid.study.row import REFUSED, Row
from jointid.study.runner import Runner
from jointid.study.study_file import StudyFile
from jointid.study.study_result import Study, study_of


@dataclass(frozen=True, slots=True, kw_only=True)
class StudyStep:
    """Progress of a study, for the callback.

    Attributes
    ----------
    number, total : int
        Number of finished trials, and total number of trials.
    rows : tuple of Row
        Rows of the trials that finished since the previous call.

    Examples
    --------
    >>> done = []
    >>> study = jid.sweep(recording, joint, grid={"windows": [100, 400]}, trials=1, callback=done.append)
    >>> isinstance(done[-1], jid.StudyStep)
    True
    """

    number: int
    total: int
    rows: tuple[Row, ...]


class StudyInterruptedError(KeyboardInterrupt):
    """Ctrl-C in a sweep. `study` contains the rows of the finished trials.

    Parameters
    ----------
    study : Study

    Examples
    --------
    >>> try:
    ...     study = jid.sweep(recording, joint, grid={"windows": [100]}, trials=1)
    ... except jid.StudyInterruptedError as stop:  # Ctrl-C
    ...     print(stop)
    """

    def __init__(self, study: Study) -> None:
        super().__init__(f"{len(study.rows)} of {len(study.cells) * study.trials} trials were done")
        self.study = study


class StudyBrokenError(RuntimeError):
    """A worker of a sweep's executor ended unexpectedly. `study` contains the rows of the finished trials.

    Parameters
    ----------
    study : Study

    Examples
    --------
    >>> try:
    ...     study = jid.sweep(recording, joint, grid={"windows": [100]}, trials=1)
    ... except jid.StudyBrokenError as error:  # a process of `executor` died
    ...     print(error)
    """

    def __init__(self, study: Study) -> None:
        super().__init__(
            f"a worker of the executor ended unexpectedly after {len(study.rows)} of "
            f"{len(study.cells) * study.trials} trials, perhaps for lack of memory. A study with an output file can be "
            "resumed"
        )
        self.study = study


_TRIALS = 10  # number of trials if trials differ


@takes(IdentifyOptions)
def sweep(
    subject: Recording | Sequence[Recording] | Scenario,
    joint: Joint | None = None,
    *,
    grid: Mapping[str, Any] | None = None,
    trials: int | None = None,
    standard_errors: bool = True,
    tracking: bool = False,
    truth: Mapping[str, float] | None = None,
    executor: Executor | None = None,
    callback: Callable[[StudyStep], object] | None = None,
    output: str | os.PathLike[str] | None = None,
    resume: bool = False,
    **options: Unpack[IdentifyOptions],
) -> Study:
    """Identify with every combination of some settings, several times each.

    All cells have the same unswept options of `identify`. A model without a name is "coulomb_viscous". In every
    cell, trial t uses the seed of `search` plus t, for the search and for the noise of a simulated recording.
    `identify` with a row's seed reproduces the row. If `search` has 0 threads, this process uses all processors,
    and an executor uses one thread per trial. A grid over "ga" or its fields implies the method "ga", unless the
    call names another method. `search` must not have a callback, checkpoint or resume.

    Parameters
    ----------
    subject : Recording, sequence of Recording, or Scenario
        Recordings for the identification, or a scenario. A scenario is simulated once per trial, with the trial's
        seed.
    joint : Joint, optional
        As in `identify`. Default with a scenario: the simulated joint. The search uses the joint's bounds and known
        values, but not its parameters' values.
    grid : mapping of str to sequence or mapping, optional
        Values of each setting by the setting's name, or a mapping from labels to values. Settings are: arguments of
        `identify` (``"windows"``, ``"model"``, ``"model.FIELD"``, …); ``"method"``, ``"ga"`` and ``"ga.FIELD"`` of
        the search; fixed parameters ``"parameters.NAME"``; and a scenario's fields, ``"sensors.FIELD"``,
        ``"controller.FIELD"`` and ``"truth.NAME"``. Default: one cell.
    trials : int, optional
        Number of trials of each combination. Default: 10 with a scenario's noise or a random search, otherwise 1.
    standard_errors : bool
        Whether to compute standard errors (some milliseconds per trial). Default True.
    tracking : bool
        Whether to simulate again with the identified and with the true parameters. The subject must be a scenario
        with a controller that compensates friction. Default False.
    truth : mapping of str to float, optional
        True parameters [SI], for bias and share of successful trials. Default: true parameters of the recordings or
        the scenario.
    executor : concurrent.futures.Executor, optional
        Executor of the trials: a process pool, or a cluster's executor, such as Dask's ``client.get_executor()``.
        It is not shut down. Default: this process.
    callback : callable, optional
        Function that is called with a `StudyStep` whenever trials finish. If the function returns True, the sweep
        stops.
    output : path, optional
        File (.jsonl) that receives each row when its trial finishes.
    resume : bool
        Whether to continue the study in an existing `output`, also with more trials. Default False.
    **options

    Returns
    -------
    Study
        The study. Its rows are bit-identical for any executor and number of threads, also after resuming.

    Raises
    ------
    InputError
        Input is invalid. The message names the argument and the reason. Settings that cannot be used with a
        recording give rows with the status "refused". The sweep raises an error only if all rows are refused.
    StudyBrokenError
        A worker of the executor ended unexpectedly.
    StudyInterruptedError
        After Ctrl-C, within 0.1 s. The error is a `KeyboardInterrupt`; its `study` contains the rows of the
        finished trials.

    Examples
    --------
    >>> study = jid.sweep(recording, joint, grid={"ga.population": [10, 20]}, trials=2)
    >>> len(study.rows)
    4
    """
    began = time.perf_counter()
    search = Search.of(options.pop("search"))
    work = work_of(subject, joint, grid, search, options, standard_errors, tracking)
    if work.threads == 0 and executor is not None:
        work = replace(work, threads=1)
    if trials is None:
        trials = _TRIALS if work.trials_differ else 1
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
                remedy="save the study as a table when the sweep is done",
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
            for done in finished_rows(work, places, executor):
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
        if output is not None:  # the file may hold rows that were written during Ctrl-C
            rows = study_file.read(output)[1]
        study = study_of(header, rows, time.perf_counter() - began)
        raise StudyInterruptedError(study) from interrupt
    if rows and all(row.status == REFUSED for row in rows):
        # A row has only the error's text, so the trial runs again to raise the error.
        list(Runner(work, strict=True).run([rows[0].place]))
        raise InputError(rows[0].message)
    return study_of(header, rows, time.perf_counter() - began)
