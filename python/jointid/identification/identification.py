"""`identify`: from recordings and a joint to an estimate."""

from __future__ import annotations

import time
from collections.abc import Sequence
from dataclasses import replace
from typing import Unpack

from jointid.base.options import takes
from jointid.estimate.estimate import Estimate
from jointid.identification.chosen_model import unfit_in
from jointid.identification.options import IdentifyOptions
from jointid.identification.prepared import prepare
from jointid.identification.search.run import run_search
from jointid.identification.search.search import Search
from jointid.identification.warnings.load_scale import LOAD_SCALE
from jointid.joint.joint import Joint
from jointid.problem.recordings import listed
from jointid.problem.settings import Settings
from jointid.problem.terms import loads
from jointid.recording.recording import Recording


@takes(IdentifyOptions)
def identify(
    recordings: Recording | Sequence[Recording],
    joint: Joint | None = None,
    **options: Unpack[IdentifyOptions],
) -> Estimate:
    """Identify a joint's friction, and its torque sensor if it has one, from ordinary motion.

    The penalty is the sum of squared window residuals of the integrated torque balance (thesis 4-21 to
    4-24). It needs no acceleration.

    Parameters
    ----------
    recordings : Recording or sequence of Recording
        One recording, or several that share all parameters except those of `per_recording`.
    joint : Joint, optional
        Known values, bounds and the model. Without a joint, `identify` estimates inertia, friction and an offset,
        and the sensor if the recording has one. The bounds then come from the data.
    **options

    Returns
    -------
    Estimate

    Raises
    ------
    InputError
        Invalid input. The error names the argument and the reason.
    KeyboardInterrupt
        Ctrl-C; raised within 0.1 s.

    Examples
    --------
    >>> estimate = jid.identify(jid.load("run.csv"), joint, model="stribeck")
    >>> round(estimate["coulomb"].value)
    25
    >>> windows = jid.WindowOptions(duration=0.02)
    >>> estimate = jid.identify(recording, joint, windows=windows, parameters={"viscous": {"min": 0.0, "max": 40.0}})
    """
    return identified(recordings, joint, Settings.of(options), Search.of(options["search"]))


def identified(
    recordings: Recording | Sequence[Recording],
    joint: Joint | None,
    settings: Settings,
    search: Search,
    *,
    attribute: bool = True,
) -> Estimate:
    """Identify with checked options; see `identify`.

    Parameters
    ----------
    attribute : bool
        Whether to search for the causes of the residual. A comparison of models needs them for one model only.
        A drift that can be removed is searched in any case. Default True.
    """
    runs = listed(recordings)
    merged = settings.model.over(joint.model) if isinstance(joint, Joint) else settings.model
    tried = [settings]
    if merged.load_friction is True:
        choices = loads(merged, runs, joint)
        models = [settings.model.replace(load_friction=load) for load in choices]
        tried = [replace(settings, model=model) for model in models]
    found: list[Estimate] = []
    for own in tried:
        started, unfit = time.perf_counter(), dict[str, str]()
        while True:
            prepared = prepare(runs, joint, own, threads=search.threads, choose=True, unfit=unfit)
            outcome = run_search(search, prepared.penalty, prepared.domain)
            estimate = prepared.estimate(search, outcome, started, attribute)
            reason, fitted = unfit_in(estimate), str(estimate.settings["model"])
            if not reason or fitted in unfit:
                break
            unfit[fitted] = reason  # held-out windows did not show this: try the next model
        found.append(estimate)
    # A load that scales all values fits any data.
    return min(found, key=lambda each: (_blocked(each), each.residuals.relative))


def _blocked(estimate: Estimate) -> bool:
    return LOAD_SCALE.code in {finding.code for finding in estimate.findings}
