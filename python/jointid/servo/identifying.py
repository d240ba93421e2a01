"""`identify_servo`: identify a servo without a torque signal, from many runs, in milliseconds."""

from __future__ import annotations

import time
from collections.abc import Sequence
from dataclasses import replace
from itertools import pairwise
from typing import Unpack

import numpy as np
from numpy.typing import NDArray

from jointid.base.errors import InputError
from jointid.base.options import takes
from jointid.joint.checks import finite_number, positive_number
from jointid.joint.joint import Joint
from jointid.joint.model import AUTO, Model
from jointid.recording.recording import Recording
from jointid.servo.back_emf_share import share_of
from jointid.servo.estimate import ServoEstimate
from jointid.servo.findings import findings_of
from jointid.servo.fitted_servo import FittedServo
from jointid.servo.layout import DEFAULT_MODEL, HELD, KNOWN, LAYOUTS, LOAD_FRICTION, Layout
from jointid.servo.named_causes import causes_of_servo
from jointid.servo.options import ServoOptions
from jointid.servo.resampling import drawn, units_of
from jointid.servo.row_lead import lead_of
from jointid.servo.signals import ServoSignals, signals_of
from jointid.servo.solving import Unknowns, fixed_point, weights
from jointid.servo.tables import parameters_of
from jointid.servo.windows import ServoGrid, grid_of

Array = NDArray[np.float64]

_FEWEST = 20  # smallest number of windows
_LEAD_ERROR = 2e-4  # s
_DECIDING, _DOUBT = 200, 0.025  # number of draws, and the share of them that may disagree
_DIVISIONS = 3  # rounds: the share of back-EMF hardly depends on the values that follow from it


@takes(ServoOptions)
def identify_servo(
    recordings: Recording | Sequence[Recording],
    joint: Joint,
    **options: Unpack[ServoOptions],
) -> ServoEstimate:
    """Identify a servo that logs a duty instead of a torque: motor, friction and inertia, from all runs at once.

    The torque balance is integrated over windows, so no acceleration is needed. Velocity is the derivative of the
    position, because the logged velocity of a servo has a delay. The balance is linear in k_t/R, k_t²/R, inertia and
    friction.

    Parameters
    ----------
    recordings : Recording or sequence of Recording
        Runs with a signal "duty" in `extra`, or a `reference` and a known position loop; see `VoltageDrive`. Motion
        with a freely turning motor separates back-EMF and viscous friction: a signal "driven" with zeros.
    joint : Joint
        The joint with its `voltage` drive, and with the known load as its `link`. Known values of `inertia`,
        `torque_constant`, resistance and parameters with ``vary=False`` are not identified.
    **options

    Returns
    -------
    ServoEstimate

    Raises
    ------
    InputError
        A signal is missing, the model is not possible for a servo, or there is too little motion.

    Examples
    --------
    >>> loop = jid.PositionLoop(gain=0.0028774)
    >>> drive = jid.VoltageDrive(supply=7.4, position_loop=loop)
    >>> link = jid.Link(mass=0.49, centre_of_mass=0.1, angle=-np.pi / 2)
    >>> servo = jid.Joint(link=link, voltage=drive)
    >>> found = jid.identify(servo_runs, servo)
    >>> found["torque_per_voltage"] > 0.0
    True
    """
    started = time.perf_counter()
    runs = signals_of(recordings, joint)
    layout, load_friction = _terms(Model.of(options["model"]).over(joint.model))
    window = positive_number("", "window", options["window"])
    slowest = positive_number("", "slowest", options["slowest"])
    lead, draws, seed = options["lead"], options["draws"], options["seed"]
    if isinstance(draws, bool) or not isinstance(draws, int) or draws < 0:
        raise InputError("a whole number of at least 0 is expected", argument="draws", value=draws)
    found_lead = lead_of(runs, joint) if lead is None else None
    shift = (found_lead or 0.0) if lead is None else finite_number("", "lead", lead)

    def grid_with(window: float) -> ServoGrid:
        grid = grid_of(runs, joint, layout.friction, window=window, slowest=slowest, lead=shift)
        return _usable(grid, window, slowest)

    grid = grid_with(window)
    unknowns = _unknowns(joint, grid, layout, load_friction=load_friction)
    values = _fitted(grid, unknowns)
    if not unknowns.divided:
        unknowns, values = _divided(joint, runs, grid, unknowns, values)
    moved: dict[str, Array] = {}
    filled = grid.with_load(grid.side(values))
    if unknowns.held and not _shown(_products_of_units(grid, filled), unknowns, values, seed):
        moved["command"] = values
        unknowns = replace(unknowns, held=False)
        values = _fitted(grid, unknowns, np.append(values[:HELD], 0.0))
        filled = grid.with_load(grid.side(values))
    each = _products_of_units(grid, filled)
    others = drawn(each, unknowns, values, draws, seed) if draws else np.empty((0, len(values)))
    if draws:
        # Resampled runs do not show effects that all of them share: the windows' length, and the rows' lead.
        moved["windows"] = _fitted(grid_with(2.0 * window), unknowns, values)
        moved["lag"] = _fitted(grid.with_lead(runs, joint, shift + _LEAD_ERROR), unknowns, values)
    durations = grid.integrals(np.ones(len(grid.velocity)))[:, 0]
    residual = filled @ weights(values) / durations
    measured = grid.columns[:, KNOWN] / durations
    estimate = ServoEstimate(
        joint=joint,
        parameters=parameters_of(values, others, unknowns, len(each), moved),
        model=layout.model,
        draws=others[:, :HELD],
        values=values[:HELD],
        load_friction=load_friction,
        separable=unknowns.separable,
        lead=shift,
        lead_found=found_lead is not None,
        command_lag=0.5 * _row(runs) * float(values[HELD]) if grid.late.any() else None,
        windows=len(grid.start),
        window=window,
        slowest=slowest,
        runs=tuple(run.name for run in runs),
        moving=_moving(grid, runs),
        rms=float(np.sqrt(np.mean(residual**2))),
        relative_residual=float(
            np.linalg.norm(residual) / max(float(np.linalg.norm(measured)), 1e-300)
        ),
        findings=(),
        seconds=0.0,
    )
    causes = None
    if draws:  # without errors, the effect of a cause on the values is unknown
        fit = FittedServo.of(joint, runs, grid, filled, unknowns, values)
        causes = causes_of_servo(fit, estimate)
    found = findings_of(estimate, unknowns, causes)
    return replace(estimate, findings=found, seconds=time.perf_counter() - started)


def _usable(grid: ServoGrid, window: float, slowest: float) -> ServoGrid:
    """Return a grid; refuse one with too few windows."""
    if len(grid.start) < _FEWEST:
        raise InputError(
            f"only {len(grid.start)} windows of {1e3 * window:g} ms are faster than {slowest:g} rad/s throughout, "
            f"and at least {_FEWEST} are needed",
            argument="recordings",
            remedy="record more motion",
        )
    return grid


def _fitted(grid: ServoGrid, unknowns: Unknowns, start: Array | None = None) -> Array:
    """Return the parameters, shape (size,); `start` is a solution of nearly the same problem, if available."""

    def products_of(side: Array | None) -> Array:
        filled = grid.columns if side is None else grid.with_load(side)
        return filled.T @ filled

    return fixed_point(grid.side, products_of, unknowns, start)


def _divided(
    joint: Joint, runs: Sequence[ServoSignals], grid: ServoGrid, unknowns: Unknowns, values: Array
) -> tuple[Unknowns, Array]:
    """Return the unknowns with the share of back-EMF, and the parameters with this share."""
    for _ in range(_DIVISIONS):
        share = share_of(joint, runs, unknowns.layout, values)
        if share == unknowns.share:
            break
        unknowns = replace(unknowns, share=share)
        values = _fitted(grid, unknowns, values)
    return unknowns, values


def _shown(products: Array, unknowns: Unknowns, values: Array, seed: int) -> bool:
    """Return whether resampled runs agree that the command is held between rows; otherwise this is not assumed."""
    held = drawn(products, unknowns, values, _DECIDING, seed)[:, HELD]
    return bool(np.quantile(held, _DOUBT) > 0.0)


def _products_of_units(grid: ServoGrid, filled: Array) -> Array:
    """Return the products of a table's columns for each unit of resampling, shape (units, columns, columns)."""
    units = units_of(grid)
    order = np.argsort(units, kind="stable")
    bounds = np.searchsorted(units[order], np.arange(int(units.max()) + 2)).tolist()
    rows = filled[order]
    return np.stack([rows[a:b].T @ rows[a:b] for a, b in pairwise(bounds)])


def _row(runs: Sequence[ServoSignals]) -> float:
    """Return the median time between rows [s]."""
    return float(np.median([np.median(np.diff(run.time)) for run in runs]))


def _unknowns(joint: Joint, grid: ServoGrid, layout: Layout, *, load_friction: bool) -> Unknowns:
    driven = grid.driven[grid.start]
    fixed = {
        name: float(parameter.value)
        for name, parameter in joint.parameters.items()
        if name in layout.names and parameter.vary is False and parameter.value is not None
    }
    if joint.reflected_inertia is not None:
        fixed["inertia"] = joint.reflected_inertia
    k_t = joint.torque_constant
    assert joint.voltage is not None
    return Unknowns(
        layout=layout,
        separable=bool(0.0 < driven.mean() < 1.0),
        load_friction=load_friction and LOAD_FRICTION.name not in fixed,
        held=bool(grid.late.any()),
        torque_constant=None if k_t is None else abs(k_t * joint.gear_ratio),
        resistance=joint.voltage.resistance,
        fixed=fixed,
    )


def _terms(model: Model) -> tuple[Layout, bool]:
    """Return the layout, and whether friction grows with the gear's torque; refuse models that a servo cannot have."""
    stated = dict(model.stated())
    name = stated.pop("name", AUTO)
    name = DEFAULT_MODEL if name == AUTO else name
    load = stated.pop(LOAD_FRICTION.option, True)
    gravity = stated.pop("gravity", "known")
    if name not in LAYOUTS:
        raise InputError(
            f"a servo without a torque signal is identified with {' or '.join(LAYOUTS)}, with or without load_friction",
            argument="model",
            value=name,
        )
    if gravity == "free":
        raise InputError(
            "the load's gravity is the servo's only known torque, so gravity cannot be free",
            argument="gravity",
            value=gravity,
        )
    for key, value in stated.items():
        if value:
            raise InputError(
                "a servo without a torque signal has no such term", argument=key, value=value
            )
    return LAYOUTS[name], bool(load)


def _moving(grid: ServoGrid, runs: Sequence[ServoSignals]) -> tuple[float, ...]:
    """Return the share of each run that is in any window."""
    shares = []
    for number, run in enumerate(runs):
        starts, ends = grid.start[grid.run == number], grid.end[grid.run == number]
        covered = np.zeros(len(grid.velocity) + 1)
        np.add.at(covered, starts, 1.0)
        np.add.at(covered, ends, -1.0)
        inside = np.cumsum(covered)[:-1] > 0.0
        shares.append(float((inside * grid.step).sum() / float(run.time[-1] - run.time[0])))
    return tuple(shares)
