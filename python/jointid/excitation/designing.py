"""Design the motion that identifies a joint best."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from jointid import _core
from jointid.base.argument_checks import require_kind
from jointid.base.errors import InputError
from jointid.base.values import dataclass
from jointid.excitation.balance_noise import assumed_sensors
from jointid.excitation.checks import check_arguments, check_gain, check_length, check_signs
from jointid.excitation.default_law import default_controller
from jointid.excitation.design import Design
from jointid.excitation.design_fields import COMPLETE, CRITERIA
from jointid.excitation.design_search import DesignProgress, DesignSearch
from jointid.excitation.expectation import expected_errors, what_limits
from jointid.excitation.holding import shrunk
from jointid.excitation.information import Known
from jointid.excitation.judging import Situation, alike, fade_of
from jointid.excitation.motion_limits import MotionLimits
from jointid.excitation.prior import Prior, ranges_of, with_room
from jointid.excitation.rehearsal import Rehearsal, rehearse
from jointid.excitation.request import request_of
from jointid.joint.joint import Joint
from jointid.simulation.arguments import Controller, positive
from jointid.simulation.peaks import Peaks
from jointid.simulation.plant import torque_limit
from jointid.simulation.trajectory import Trajectory

Array = NDArray[np.float64]
Callback = Callable[[DesignProgress], object]

_RUNS = 2  # number of searches; rehearsals decide between their motions
_COARSE = 2  # multiple of the control period, in the search
_FIRST = 48  # random motions that show which parameters of which joint count
_DETERMINED = 0.15  # relative error that one of these motions must reach
_TRIED = 0.2  # share of the rehearsals, to compare the motions found
_CONTRADICTED = 1.25  # times the information's error: the information misses an effect
_OVERSTATED = 1.5  # ratio to the counted error; a smaller one may be chance with few rehearsals
_USUAL = math.radians(20.0)  # amplitude of the thesis's motion [rad]
_CYCLE = 6.0  # cycle of the thesis's motion [s]
_SAME_TORQUE = 1.01  # 8 A of current are 159.984 of 160 N·m


def design_excitation(
    joint: Joint,
    limits: MotionLimits | Mapping[str, Any] | None = None,
    duration: float = 12.0,
    *,
    controller: Controller | None = None,
    sensors: _core.Sensors | None = None,
    parameters: Sequence[str] | None = None,
    criterion: str = "worst",
    prior: Prior = None,
    search: DesignSearch | None = None,
    control_period: float = 1e-3,
    known: Known | None = None,
    callback: Callback | None = None,
) -> Design:
    """Return the motion that identifies a joint best within limits.

    Motions are sums of sines that start and end at rest. A genetic algorithm searches for the motion with the
    most information about the parameters. It uses noise-free simulations of several joints drawn from the
    prior. The best motions are then simulated with noise and identified, which gives the expected errors.

    Parameters
    ----------
    joint : Joint
        The joint; the motion is for the free parameters of its model.
    limits : MotionLimits or mapping, optional
        Position (low, high) [rad], velocity [rad/s], acceleration [rad/s²], torque [N·m] and sensor range
        [N·m]. Every joint drawn from the prior keeps them. Default: the joint's limits.
    duration : float
        Duration of the motion [s]. Default 12.
    controller : controller, optional
        The controller that will move the joint. Default: an adaptive-robust law with the nominal joint's
        values and without torque feedback.
    sensors : Sensors, optional
        Default: a torque sensor with noise of 0.3 % of the torque limit; without a torque sensor, an
        encoder of 8000 counts per motor revolution.
    parameters : sequence of str, optional
        Parameters to identify. Default: all free parameters.
    criterion : {"worst", "determinant"}
        Error to minimize: the largest relative error, or the product of all. Default "worst". For a value
        near 0, the error is relative to a tenth of its range.
    prior : mapping of str to (low, high), or sequence of mappings, optional
        Ranges of the free parameters, or values of several joints, the nominal one first.
        Default: the joint's bounds; ±30 % of a value without bounds.
    search : DesignSearch, optional
    control_period : float
        The controller's period [s]. Default 0.001.
    known : Known, optional
        Information about parameters from existing recordings.
    callback : callable, optional
        Called with a `DesignProgress` during the search. Return True to end the search early.

    Returns
    -------
    Design

    Raises
    ------
    InputError
        An argument is invalid, a parameter has no range, the limits allow no motion, or the control loop is
        unstable for a joint drawn from the prior.
    KeyboardInterrupt
        After Ctrl-C, within 0.1 s.

    Examples
    --------
    >>> limits = {"position": (-1.0, 1.0), "velocity": 3.4, "torque": 160.0}
    >>> search = jid.DesignSearch(evaluations=64, joints=2, rehearsals=10)  # the default takes seconds
    >>> design = design_excitation(known, limits, duration=4.0, search=search)
    >>> design.save("new_motion.toml")
    """
    require_kind("joint", joint, Joint)
    check_arguments(joint, controller, sensors, parameters, callback)
    settings = DesignSearch() if search is None else search
    require_kind("search", settings, DesignSearch)
    limits = MotionLimits.of(limits, joint)
    drive = torque_limit(joint)
    if drive is not None and limits.torque is not None and limits.torque > _SAME_TORQUE * drive:
        raise InputError(
            f"this is above the drive's own limit of {drive:g}",
            argument="torque",
            value=limits.torque,
            place="limits",
        )
    if criterion not in CRITERIA:
        raise InputError(
            f"choose one of {', '.join(CRITERIA)}", argument="criterion", value=criterion
        )
    check_length(positive("duration", duration), positive("control_period", control_period))
    joint = _with_model(joint)
    request = request_of(joint, parameters)
    ranges = ranges_of(joint, request.names, prior)
    check_signs(request, ranges)
    joint = with_room(joint, ranges.ranges)
    check_gain(joint, request)
    nominal = joint.with_parameters(ranges.nominal)
    assert limits.torque is not None
    situation = Situation(
        joint=joint,
        request=request,
        ranges=ranges,
        limits=limits,
        controller=default_controller(nominal, limits.torque) if controller is None else controller,
        sensors=assumed_sensors(joint, limits.torque) if sensors is None else sensors,
        duration=float(duration),
        control_period=float(control_period),
        criterion=criterion,
        known=_matrix(known, request.names),
    )
    return _Designing(situation, settings, callback).design(nominal)


@dataclass(frozen=True, slots=True)
class _Final:
    """A motion at its final size: peaks, reason against its use, rehearsals and criterion."""

    trajectory: Trajectory
    peaks: Peaks
    problem: str
    rehearsal: Rehearsal
    worth: float


class _Designing:
    """One design: the judges, the search, and the choice among the motions found."""

    def __init__(
        self, situation: Situation, settings: DesignSearch, callback: Callback | None
    ) -> None:
        self._situation = situation
        self._settings = settings
        self._callback = callback
        self._values = situation.ranges.joints(settings.joints, settings.seed)
        self._fine = situation.judge(self._values)
        self._genes = self._fine.genes
        self._evaluations = 0
        self._counted: tuple[str, ...] = situation.request.wanted

    def design(self, nominal: Joint) -> Design:
        """Search, choose, and keep the limits for many joints."""
        situation, settings = self._situation, self._settings
        judge = self._judge_of_the_search()
        self._counted = self._counting(judge)
        motions = self._searched(judge)
        usual = self._usual()
        motions += [] if usual is None else [usual]
        tried = max(8, round(_TRIED * settings.rehearsals))
        rehearsals = [
            rehearse(situation, each, self._values[0], tried, threads=settings.threads)
            for each in motions
        ]
        worth = [
            self._worth(motion, each) for motion, each in zip(motions, rehearsals, strict=True)
        ]
        chosen = motions[int(np.argmin(worth))]
        final = self._shrunk(chosen)
        if usual is not None and chosen is not usual:
            # Few rehearsals may give too small errors. All rehearsals, at the final size, decide.
            final = min(
                final, self._shrunk(usual), key=lambda each: (bool(each.problem), each.worth)
            )
        trajectory, rehearsal = final.trajectory, final.rehearsal
        judgements = self._fine.judge(trajectory.core)
        errors = expected_errors(situation, judgements, self._values, rehearsal)
        weakest = max(errors, key=lambda name: errors[name].relative)
        made = Design(
            status=COMPLETE if not final.problem else "limits exceeded",
            reason=final.problem,
            trajectory=trajectory,
            joint=nominal,
            believed=dict(situation.ranges.ranges),
            controller=situation.controller,
            sensors=situation.sensors,
            limits=situation.limits,
            peaks=final.peaks,
            parameters=errors,
            reference={} if usual is None else self._relative(rehearsals[-1].rms()),
            criterion=situation.criterion,
            joints=len(self._values),
            evaluations=self._evaluations,
            seed=settings.seed,
            duration=situation.duration,
            control_period=situation.control_period,
            weakest=weakest,
            limited_by="",
        )
        return replace(made, limited_by=what_limits(made, situation, judgements[0]))

    def _shrunk(self, motion: Trajectory) -> _Final:
        """Return the motion at a size with which many joints keep the limits, and all its rehearsals."""
        situation, settings = self._situation, self._settings
        trajectory, peaks, problem = shrunk(situation, motion, settings.seed, settings.threads)
        rehearsal = rehearse(
            situation,
            trajectory,
            self._values[0],
            settings.rehearsals,
            first=1000,
            threads=settings.threads,
        )
        worth = self._worth(trajectory, rehearsal)
        return _Final(trajectory, peaks, problem, rehearsal, worth)

    def _counting(self, judge: _core.Excitation) -> tuple[str, ...]:
        """Return the wanted parameters that some motion determines for the nominal joint, or all parameters."""
        request = self._situation.request
        kept = dict(zip(request.names, judge.joints[0].weight.tolist(), strict=True))
        return tuple(name for name in request.wanted if kept[name] > 0.0) or request.wanted

    def _relative(self, errors: Mapping[str, float]) -> dict[str, float]:
        """Return the errors of the wanted parameters divided by the parameters' sizes."""
        situation, values = self._situation, self._values[0]
        return {
            n: errors[n] / situation.ranges.scale(n, values[n]) for n in situation.request.wanted
        }

    def _worth(self, motion: Trajectory, rehearsal: Rehearsal) -> float:
        """Return the criterion that the search minimizes, for the nominal joint.

        The information's errors scatter less than the errors of few rehearsals. The rehearsals' mean adds the
        bias, which the information lacks. Counted errors that contradict both decide: without a torque sensor,
        position errors cancel between windows, and the information's errors are several times too large.
        """
        judgement = self._fine.judge(motion.core)[0]
        bias, counted = self._relative(rehearsal.bias()), self._relative(rehearsal.rms())
        shares = []
        for place, name in enumerate(self._situation.request.names):
            if name in self._counted:
                own = float(judgement.bias[place])
                unexplained = max(bias[name] ** 2 - own**2, 0.0)
                expected = math.sqrt(float(judgement.errors[place]) ** 2 + unexplained)
                low, high = counted[name] / _CONTRADICTED, counted[name] * _OVERSTATED
                shares.append(min(max(expected, low), high))
        if self._situation.criterion == "worst":
            return float(max(shares))
        return float(np.mean(np.log(np.maximum(shares, 1e-12))))

    def _judge_of_the_search(self) -> _core.Excitation:
        """Return a judge with a longer control period if it gives the same result for some motions."""
        situation, threads = self._situation, self._settings.threads
        random = np.random.default_rng(self._settings.seed)
        first = random.random((self._genes, _FIRST))
        fine = situation.judge(self._values, believed=True)
        judge = situation.judge(self._values, coarse=_COARSE, believed=True)
        for column in range(3):
            motion = _trajectory(fine, first[:, column])
            if not alike(_judged(fine, motion), _judged(judge, motion)):
                judge = fine
                break
        judge.leave_out(first, largest=_DETERMINED, threads=threads)
        if not any(np.any(each.weight > 0.0) for each in judge.joints):
            judge = situation.judge(self._values, believed=True)
        return judge

    def _searched(self, judge: _core.Excitation) -> list[Trajectory]:
        """Return the best motion of each search."""
        options = self._settings.options(1.0 / _RUNS)
        total = _RUNS * options.population * (options.generations + 1)
        motions = []
        for run in range(_RUNS):
            done = self._evaluations

            def observe(generation: _core.Generation, done: int = done) -> bool:
                if self._callback is None:
                    return False
                step = DesignProgress(
                    number=min(done + generation.evaluations, total),
                    total=total,
                    best=generation.best,
                )
                return self._callback(step) is True

            found = judge.search(
                options=options,
                seed=self._settings.seed,
                trial=run,
                threads=self._settings.threads,
                callback=observe,
            )
            self._evaluations += found.evaluations
            # A motion far beyond a limit costs as much as an unstable loop.
            if (
                found.penalty >= _UNSTABLE
                and _judged(judge, _trajectory(judge, found.best)) is None
            ):
                raise InputError(
                    "in each tried motion, the control loop is unstable for at least one joint of the prior",
                    argument="controller",
                    remedy="narrow the prior, or give the joint's own controller",
                )
            motions.append(_trajectory(judge, found.best))
            if found.stop == _core.Stop.observer:
                break
        return motions

    def _usual(self) -> Trajectory | None:
        """Return the thesis's motion, ending at rest, if every joint keeps the limits. The design must not be worse."""
        situation = self._situation
        low, high = situation.limits.position
        if not low <= -_USUAL <= _USUAL <= high:
            return None
        rate, size = 2.0 * math.pi / _CYCLE, _USUAL / 1.3
        motion = Trajectory.sines(
            amplitude=(size, -0.5 * size),
            frequency=(rate, 2.0 * rate),
            phase=(0.0, 0.0),
            fade=fade_of(situation.duration),
            duration=situation.duration,
        )
        judged = _judged(self._fine, motion)
        if judged is None or any(each.excess > 0.0 for each in judged):
            return None
        time = np.linspace(0.0, situation.duration, 5000)
        most = situation.limits.acceleration
        if most is not None and np.abs(motion.sample(time)[2]).max() > most:
            return None
        return motion


_UNSTABLE = 1e100  # value of the criterion, a relative error


def _trajectory(judge: _core.Excitation, genes: Array) -> Trajectory:
    return Trajectory.sines(**judge.motion(genes))


def _judged(judge: _core.Excitation, motion: Trajectory) -> list[_core.MotionJudgement] | None:
    """Return the judgements; None if the loop is unstable."""
    try:
        return list(judge.judge(motion.core))
    except InputError:
        return None


def _with_model(joint: Joint) -> Joint:
    """Return the joint with a named friction model; the richest usual model if it has none."""
    return joint if joint.model.named else joint.replace(model=joint.model.replace(name="stribeck"))


def _matrix(known: Known | None, names: tuple[str, ...]) -> Array:
    """Return the known information in the order of the free parameters."""
    matrix = np.zeros((len(names), len(names)))
    if known is None:
        return matrix
    require_kind("known", known, Known)
    at = [names.index(name) for name in known.names if name in names]
    own = [place for place, name in enumerate(known.names) if name in names]
    matrix[np.ix_(at, at)] = known.information[np.ix_(own, own)]
    return matrix
