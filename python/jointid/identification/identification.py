"""`identify`: from recordings and a joint to an estimate."""

from __future__ import annotations

import time
from collections.abc import Collection, Mapping, Sequence

from jointid import _core
from jointid.estimate.estimate import Estimate
from jointid.identification.prepared import prepare
from jointid.identification.search.search import Callback, Search, StatePath
from jointid.joint.joint import Joint
from jointid.joint.parameters import Parameter
from jointid.problem.problem import Windows, whole_number
from jointid.recording.recording import Recording


def identify(
    recordings: Recording | Sequence[Recording],
    joint: Joint | None = None,
    *,
    model: str | None = None,
    asymmetric: bool | None = None,
    ripple: Collection[float] | None = None,
    harmonics: Collection[float] | None = None,
    load_friction: bool | None = None,
    per_recording: Collection[str] = (),
    parameters: Mapping[str, float | Mapping[str, object] | Parameter] | None = None,
    method: str = "ga",
    ga: _core.GaOptions | None = None,
    residual: str | None = None,
    windows: Windows = None,
    torque_hold: str | None = None,
    mask_standstill: bool = True,
    seed: int = 0,
    threads: int = 0,
    callback: Callback | None = None,
    checkpoint: StatePath | None = None,
    resume: StatePath | None = None,
) -> Estimate:
    """Identify a joint's friction, and its torque sensor if it has one, from ordinary motion.

    The penalty is the sum of squared window residuals of the integrated torque balance (thesis 4-21 to
    4-24): it needs no acceleration.

    Parameters
    ----------
    recordings : Recording or sequence of Recording
        One run, or several that share all parameters but those of `per_recording`.
    joint : Joint, optional
        Known facts, bounds and the model. Without one, inertia, Coulomb and viscous friction and an
        offset are identified with bounds from the data, and the sensor if the recording has one.
    model : str, optional
        "coulomb_viscous" (2-1), "stribeck" (4-1) or "stribeck_general" (2-3, with exponent). Default:
        the joint's, else "coulomb_viscous".
    asymmetric : bool, optional
        Friction coefficients for each direction apart; takes the place of a torque offset.
    ripple : collection of float, optional
        Orders of torque or sensor ripple over the motor's angle, e.g. (2,) for a strain-wave gear;
        each is a sine and a cosine [N·m]. Needs the joint's gear ratio.
    harmonics : collection of float, optional
        Orders of a torque over the joint's own angle.
    load_friction : bool, optional
        Friction in proportion to the magnitude of the drive's torque.
    per_recording : collection of str
        Coefficients that each recording has for itself, e.g. ("torque_offset",).
    parameters : mapping, optional
        Changes by name: a number fixes; {"value", "min", "max", "vary"} or a `Parameter` change those
        fields. Values in SI.
    method : str
        "ga" (default): genetic algorithm, then a local polish. "separable": linear parameters
        eliminated exactly, a search over the shapes alone. "random": random search with the genetic
        algorithm's budget and no polish, for comparison.
    ga : GaOptions, optional
        Settings of the genetic algorithm.
    residual : str, optional
        "sensor" (default with a sensor) or "torque".
    windows : int, float, "cumulative" or WindowOptions, optional
        An int is about how many (gaps and several recordings round it), a float their duration [s];
        "cumulative" compares the running integral at each sample, as the thesis's MATLAB does.
        Default: the shortest that the noise of the velocity allows.
    torque_hold : str, optional
        "zoh" when the torque is a command held between samples, "linear" when it is measured.
        Default: the recording's, else the joint's, else "linear".
    mask_standstill : bool
        Leave out runs in which the joint sticks or stands still (default), where friction is
        set-valued and the model says nothing.
    seed : int
        Same seed, same bits, whatever `threads` is.
    threads : int
        0 (default): all.
    callback : callable, optional
        Called with each `Generation`; returning True stops the search. Not with "separable".
    checkpoint : path, optional
        The genetic search's state is kept in this file, written whole, every 50 generations.
    resume : path, optional
        A checkpoint to go on from; the result has the same bits as an uninterrupted search.

    Returns
    -------
    Estimate

    Raises
    ------
    InputError
        Anything that cannot be used, in one sentence.
    KeyboardInterrupt
        Ctrl-C, within 0.1 s.
    """
    started = time.perf_counter()
    threads = whole_number("threads", threads, 0, 1024)
    search = Search(
        method=method,
        options=ga if ga is not None else _core.GaOptions(),
        seed=whole_number("seed", seed, 0, 2**64 - 1),
        threads=threads,
        callback=callback,
        checkpoint=checkpoint,
        resume=resume,
    )
    prepared = prepare(
        recordings,
        joint,
        model=model,
        asymmetric=asymmetric,
        ripple=ripple,
        harmonics=harmonics,
        load_friction=load_friction,
        per_recording=per_recording,
        parameters=parameters,
        residual=residual,
        windows=windows,
        torque_hold=torque_hold,
        mask_standstill=mask_standstill,
        threads=threads,
    )
    return prepared.estimate(search, search.run(prepared.penalty, prepared.domain), started)
