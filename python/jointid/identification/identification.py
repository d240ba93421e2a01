"""`identify`: from recordings and a joint to an estimate."""

from __future__ import annotations

import time
from collections.abc import Mapping, Sequence
from typing import Any

from jointid.estimate.estimate import Estimate
from jointid.identification.chosen_model import unfit_in
from jointid.identification.prepared import prepare
from jointid.identification.search.run import run_search
from jointid.identification.search.search import Method, Search
from jointid.identification.warnings.load_scale import LOAD_SCALE
from jointid.joint.joint import Joint
from jointid.joint.model import Model, ModelName
from jointid.joint.parameters import Parameter
from jointid.problem.recordings import listed
from jointid.problem.terms import Residual, loads
from jointid.problem.windows import Windows
from jointid.recording.recording import Recording
from jointid.recording.signals import TorqueHold


def identify(
    recordings: Recording | Sequence[Recording],
    joint: Joint | None = None,
    *,
    model: Model | ModelName | Mapping[str, Any] | None = None,
    parameters: Mapping[str, float | Mapping[str, object] | Parameter] | None = None,
    search: Search | Method | None = None,
    residual: Residual | None = None,
    windows: Windows = None,
    torque_hold: TorqueHold | None = None,
    mask_standstill: bool = True,
    shift: Mapping[str, float] | None = None,
    min_speed: float | None = None,
    terms: Mapping[str, str] | None = None,
) -> Estimate:
    """Identify a joint's friction, and its torque sensor if it has one, from ordinary motion.

    The penalty is the sum of squared window residuals of the integrated torque balance (thesis 4-21 to
    4-24), so no acceleration is needed.

    Parameters
    ----------
    recordings : Recording or sequence of Recording
        One recording, or several that share all parameters but those of `per_recording`.
    joint : Joint, optional
        Known values, bounds and the model. Without one, inertia, friction and an offset are identified with
        bounds from the data, and the sensor if the recording has one.
    model : Model, str or mapping, optional
        Terms of the torque balance, e.g. ``"stribeck:ripple=2"``; each stated field overrides that of the
        joint's model. Default: the joint's. Where neither names one, or the name is "auto", the model is
        chosen by held-out prediction: "coulomb_viscous" or "stribeck", with gravity free or none where that
        is neither stated nor known; `Estimate.selection` has the scores.
    parameters : mapping, optional
        Changes by name: a number fixes the parameter; {"value", "min", "max", "vary"} or a `Parameter`
        changes those fields. Values in SI units.
    search : Search or str, optional
        Settings of the search, or a method: "separable" (default), "ga" or "random".
    residual : str, optional
        "instruments" (default with a sensor): the gain from the part of the reading that gravity and
        inertia of a rigid link explain, which neither the reading's noise nor friction that the model
        lacks biases. "sensor" (the thesis) compares the reading with what the torque leaves for it,
        "torque" (default without a sensor) the torque with the reading. Where instruments are weak the
        default is "sensor", and `settings` says why.
    windows : int, float, "cumulative" or WindowOptions, optional
        An int is the approximate number of windows (gaps and several recordings change it), a float
        their duration [s]; "cumulative" compares the running integral at each sample, as the thesis's
        MATLAB program does. Default: the shortest windows that the noise of the velocity allows.
    torque_hold : str, optional
        "zoh" for a torque command held between samples, "linear" for a measured torque.
        Default: the recording's, else the joint's, else "linear".
    mask_standstill : bool
        Whether to leave out the parts in which the joint sticks or stands still, where friction is
        set-valued and the model does not apply. Default True.
    shift : mapping of str to float, optional
        Delays of "torque", "sensor" and "velocity" against the position [s], to be taken away; positive:
        the signal is late. An empty mapping shifts nothing. Default: the delays that are certain, but for a
        torque that is early by more than a sample, as it seems beside a late or coarse position; the
        estimate's `delays` and its report tell them.
    min_speed : float, optional
        Motion slower than this is left out [rad/s or m/s]; 0 leaves out nothing. Default: chosen; 0 unless
        slow motion contradicts the friction that faster motion shows (creep), and 0 for models whose
        friction depends on slow motion, such as "stribeck". The estimate's `slow_motion` tells it.
    terms : mapping of str to str, optional
        Own terms: extra signals of the recordings and how they enter, e.g. ``{"q6_rate": "viscous+coulomb",
        "tau_model": "known"}``; the same as the field `terms` of the model. Default: the model's.

    Returns
    -------
    Estimate

    Raises
    ------
    InputError
        Input that cannot be used: the error names the argument and the reason.
    KeyboardInterrupt
        Ctrl-C; it is raised within 0.1 s.

    Examples
    --------
    >>> estimate = jid.identify(jid.load("run.csv"), joint, model="stribeck")
    >>> round(estimate["coulomb"].value)
    25
    >>> windows = jid.WindowOptions(duration=0.02)
    >>> estimate = jid.identify(recording, joint, windows=windows, parameters={"viscous": {"min": 0.0, "max": 40.0}})
    """
    stated = Model.of(model)
    if terms is not None:
        stated = stated.replace(terms=terms)
    options = {
        "parameters": parameters,
        "residual": residual,
        "windows": windows,
        "torque_hold": torque_hold,
        "mask_standstill": mask_standstill,
        "shift": shift,
        "min_speed": min_speed,
    }
    return identified(recordings, joint, stated, Search.of(search), options)


def identified(
    recordings: Recording | Sequence[Recording],
    joint: Joint | None,
    model: Model,
    search: Search,
    options: Mapping[str, Any],
    *,
    attribute: bool = True,
) -> Estimate:
    """Identify with options that are checked; see `identify`.

    Parameters
    ----------
    options : mapping of str to object
        Further arguments of `prepare`.
    attribute : bool
        Whether the causes of a misfit are looked for: what compares models needs those of one of them. A drift that
        is taken away is looked for in any case. Default True.
    """
    started = time.perf_counter()
    merged = model.over(joint.model) if isinstance(joint, Joint) else model
    if merged.load_friction is True:
        found = [
            identified(
                recordings,
                joint,
                model.replace(load_friction=load),
                search,
                options,
                attribute=attribute,
            )
            for load in loads(merged, listed(recordings), joint)
        ]
        # A load that scales all values fits anything.
        return min(found, key=lambda each: (_blocked(each), each.residuals.relative))
    unfit: dict[str, str] = {}
    while True:
        prepared = prepare(
            recordings,
            joint,
            model=model,
            threads=search.threads,
            choose=True,
            unfit=unfit,
            **options,
        )
        outcome = run_search(search, prepared.penalty, prepared.domain)
        estimate = prepared.estimate(search, outcome, started, attribute)
        reason, fitted = unfit_in(estimate), str(estimate.settings["model"])
        if not reason or fitted in unfit:
            return estimate
        unfit[fitted] = reason  # held-out windows did not show it: the next best model


def _blocked(estimate: Estimate) -> bool:
    return LOAD_SCALE.code in {finding.code for finding in estimate.findings}
