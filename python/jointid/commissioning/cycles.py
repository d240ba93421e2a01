"""Commissioning on a bench: run with assumed parameters, identify, run with the estimate."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager, suppress
from dataclasses import replace
from pathlib import Path

import numpy as np

from jointid.base.errors import InputError
from jointid.base.files import make_folder
from jointid.commissioning.result import BenchRun, Commissioning, blocking
from jointid.estimate.estimate import Estimate
from jointid.hardware.bench.bench import Bench
from jointid.hardware.bench.emulated_joints import true_joint
from jointid.hardware.bench.opened_drive import open_drive
from jointid.hardware.session.session import Session
from jointid.identification.identification import identify
from jointid.identification.search.search import Search
from jointid.joint.joint import Joint
from jointid.joint.model import Model
from jointid.recording.recording import Recording
from jointid.simulation.arguments import Controller
from jointid.simulation.scenario import believing

Observer = Callable[..., object]
_ENVELOPE = 2.0  # multiple of the torque that an identified joint needs


def commission(
    bench: Bench,
    *,
    cycles: int = 2,
    emulate: bool = False,
    seed: int = 0,
    threads: int = 0,
    output: str | Path | None = None,
    observer: Observer | None = None,
    callback: Callable[[str], object] | None = None,
    agree: Callable[[Estimate], bool] | None = None,
) -> Commissioning:
    """Move the joint, identify it from the recording, and move it again with the estimate.

    If an estimate has a blocking finding, the commissioning ends before the joint moves with this estimate. See
    `Commissioning.blocked`.

    Parameters
    ----------
    bench : Bench
        Bench. The parameter values of its joint are the controller's initial assumptions.
    cycles : int
        Number of cycles of identification and motion. Default 2. With 0, the joint moves once and is recorded. Any
        controller may then be used.
    emulate : bool
        Whether to move an emulated joint in virtual time. The last run then uses the true parameters. Default False:
        the real joint.
    seed : int
        Seed of the emulated sensor's noise and of the search. Default 0.
    threads : int
        Number of threads of the search. Default 0: all processors.
    output : path, optional
        Folder of recordings, frame logs and estimates; it is created if needed.
    observer : callable, optional
        As in `Session`.
    callback : callable, optional
        Function that is called with a text before each step.
    agree : callable, optional
        Function that is called with each estimate before the joint moves with it. If it returns False, the
        commissioning ends.

    Raises
    ------
    InputError
        The controller uses no estimates, `cycles` is negative, or the bench cannot be emulated.
    SessionRefusedError, SessionStoppedError
        As in `Session.run`. The folder has all recordings up to the error.
    Exception
        Any error of a session or a callable. Its attribute `recordings` maps each run's name, e.g. "initial", to its
        recording. The last recording may be incomplete. Its attribute `outcome` is the `Commissioning` up to the
        error, or None if nothing was recorded.
    """
    if cycles < 0:
        raise InputError("at least 0 is expected", argument="cycles", value=cycles)
    search = Search(seed=seed, threads=threads)
    controller = bench.controller
    if cycles or "coulomb" in controller.asdict():
        controller = believing(controller, bench.joint)
    report = callback if callback is not None else lambda _: None
    folder = None if output is None else Path(output)
    fresh = False
    if folder is not None:
        fresh = not folder.exists()
        make_folder(folder)
    runs: list[BenchRun] = []
    estimates: list[Estimate] = []
    true_run: BenchRun | None = None
    recordings: dict[str, Recording] = {}
    laws: dict[str, Controller] = {}
    truth = bench.emulation.truth if emulate and bench.emulation is not None else {}
    with (
        _no_empty_folder(folder if fresh else None),
        open_drive(bench, emulate=emulate, seed=seed) as drive,
    ):

        def run(name: str, law: Controller, found: Joint | None = None) -> BenchRun:
            report(f"run: {name}")
            laws[name] = law
            place = None if folder is None else folder / f"{name.replace(' ', '_')}.csv"
            limits = bench.limits
            if found is not None and limits.torque_envelope is None:
                limits = replace(limits, torque_envelope=_ENVELOPE)
            session = Session(
                drive,
                law,
                bench.trajectory,
                limits,
                options=bench.options,
                output=place,
                observer=observer,
                real_time=None if emulate else bench.real_time,
                joint=found,
                designed_for=bench.designed_for,
            )
            try:
                recording = session.run()
            finally:
                if session.recording is not None:
                    recordings[name] = session.recording
            assert recording is not None, "only a dry run has no recording"
            return _assessed(name, recording, law)

        try:
            runs.append(run("initial", controller))
            for cycle in range(1, cycles + 1):
                report(f"identify: cycle {cycle}")
                before = [each.recording for each in runs]
                estimate = identify(before, bench.joint, search=search)
                estimates.append(estimate)
                if folder is not None:
                    estimate.save(folder / f"cycle_{cycle}.json")
                if blocking(estimate) is not None:
                    break
                if agree is not None and not agree(estimate):
                    break
                found = estimate.joint
                runs.append(run(f"cycle {cycle}", believing(controller, found), found))
            if emulate and cycles and blocking(estimates[-1]) is None:
                true_run = run("true parameters", believing(controller, true_joint(bench)))
        except (Exception, KeyboardInterrupt) as error:
            _keep(error, recordings)
            ended = [
                _assessed(name, recording, laws[name])
                for name, recording in recordings.items()
                if name not in {each.name for each in runs} and recording.reference is not None
            ]
            until_then = Commissioning(
                runs=(*runs, *ended), estimates=tuple(estimates), truth=truth
            )
            vars(error)["outcome"] = until_then if until_then.runs else None
            raise
    plain = None
    usable = bool(estimates) and blocking(estimates[-1]) is None
    if usable and bench.joint.model.resolved.ripple:
        before = [each.recording for each in runs[: len(estimates)]]
        plain = identify(before, bench.joint, model=Model(ripple=()), search=search)
    return Commissioning(
        runs=tuple(runs),
        estimates=tuple(estimates),
        truth=truth,
        true_run=true_run,
        without_ripple=plain,
    )


@contextmanager
def _no_empty_folder(folder: Path | None) -> Iterator[None]:
    """Remove an empty folder that was created for a session that did not start."""
    try:
        yield
    finally:
        if folder is not None:
            with suppress(OSError):  # the folder is not empty
                folder.rmdir()


def _keep(error: BaseException, recordings: Mapping[str, Recording]) -> None:
    """Attach the recordings to an exception, because without a folder they would be lost."""
    vars(error)["recordings"] = dict(recordings)
    if recordings:
        error.add_note(
            f"the attribute `recordings` holds the recordings up to the error: {', '.join(recordings)}"
        )


def _assessed(name: str, recording: Recording, controller: Controller) -> BenchRun:
    assert recording.reference is not None, "a session records it"
    elapsed = recording.time - recording.time[0]
    later = elapsed >= elapsed[-1] / 6.0
    error = (recording.position - recording.reference)[later]
    return BenchRun(
        name=name,
        recording=recording,
        controller=controller,
        tracking_error=float(np.sqrt(np.mean(error**2))),
        peak_error=float(np.abs(error).max()),
    )
