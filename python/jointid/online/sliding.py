"""From the samples of the last seconds to an estimate: what the identifier's thread does."""

from __future__ import annotations

import time
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from jointid import _core
from jointid.errors import InputError
from jointid.identification.covariance import parameter_covariance
from jointid.identification.inference import freedom_of, joint_of, parameters_of
from jointid.identification.inner_products import columns_with, size
from jointid.identification.model_terms import Request, choose_terms
from jointid.identification.problem import Problem
from jointid.identification.search_domain import SearchDomain, domain_for
from jointid.joint.joint import Joint
from jointid.joint.parameters import Parameter
from jointid.online.online_estimate import OnlineEstimate
from jointid.online.samples import Samples
from jointid.recording.recording import Recording

Array = NDArray[np.float64]

# Before and after a stretch, so that its ends know whether the joint stands still [s].
CONTEXT = 0.15
# Of the speed seen: room before the table of shapes has to be made anew.
_FASTER = 1.5
_LARGE_ERROR = 0.05
# Error of the compressed penalty, of the columns' squared size: the direct sum is not there to help.
_ROUGH = 1e-11


@dataclass(frozen=True, slots=True, kw_only=True)
class Settings:
    """What an on-line identification is told; see `OnlineIdentifier`."""

    joint: Joint | None
    window: float
    update: float
    request: Request
    parameters: Mapping[str, float | Mapping[str, object] | Parameter] | None
    windows: float | None
    torque_hold: str | None
    mask_standstill: bool


@dataclass(slots=True, kw_only=True)
class _Plan:
    """What the first seconds decided: terms, bounds, length of a window."""

    problem: Problem
    frame: _core.Penalty
    domain: SearchDomain
    penalty: _core.SlidingPenalty
    speed: float
    made: float


class Sliding:
    """Digests samples a stretch at a time and estimates from the last `window` seconds."""

    def __init__(self, settings: Settings, signals: tuple[str, ...]) -> None:
        self._settings = settings
        self._samples = Samples(signals)
        self._plan: _Plan | None = None
        self._digested = 0  # samples before the first that is still to be digested
        self._updates = 0

    def append(self, given: Mapping[str, Array]) -> None:
        """Add samples, in order."""
        self._samples.append(given)

    def estimate(self, dropped: int) -> OnlineEstimate | None:
        """Digest what is complete; the estimate after it, or None while there is nothing new or too little."""
        began = time.perf_counter()
        if self._plan is None:
            self._plan = self._made_plan()
            if self._plan is None:
                self._trim(len(self._samples))
                return None
        if not self._digest():
            return None
        self._plan.penalty.forget(self._plan.penalty.end - self._settings.window)
        self._trim(self._digested)
        found = self._solve(self._plan, began, dropped)
        if found is not None and self._outgrown(self._plan, found):
            self._plan = None  # the next stretch begins with bounds from all that is remembered
        return found

    def _recording(self, begin: int, end: int) -> Recording:
        signals: dict[str, Any] = self._samples.stretch(begin, end)
        kind = self._settings.joint.kind if self._settings.joint is not None else "revolute"
        return Recording(**signals, kind=kind)

    def _made_plan(self) -> _Plan | None:
        """Terms, bounds and windows from what is there; None while it does not suffice."""
        settings = self._settings
        if len(self._samples) < 3 or np.ptp(self._samples.time) < 2.0 * settings.update:
            return None
        recording = self._recording(0, len(self._samples))
        choice = choose_terms((recording,), settings.joint, settings.request)
        problem = Problem(
            recordings=(recording,),
            joint=settings.joint,
            choice=choice,
            torque_hold=settings.torque_hold,
            mask_standstill=settings.mask_standstill,
        )
        speed = _FASTER * problem.peak_speed
        if speed == 0.0:
            return None
        try:
            frame = problem.penalty(settings.windows)
            domain = domain_for(frame, settings.joint, settings.parameters, problem.peak_speed)
        except InputError:
            if np.ptp(self._samples.time) >= settings.window:
                raise  # more of the same will not mend it
            return None
        penalty = _core.SlidingPenalty(
            terms=list(choice.terms),
            residual=_core.Residual[choice.residual],
            gear_ratio=choice.gear_ratio,
            window_duration=frame.window_duration,
            mask_standstill=settings.mask_standstill,
            lower=domain.lower,
            upper=domain.upper,
            speed=speed,
        )
        self._digested = 0
        return _Plan(
            problem=problem,
            frame=frame,
            domain=domain,
            penalty=penalty,
            speed=speed,
            made=float(self._samples.time[-1]),
        )

    def _digest(self) -> bool:
        """Digest every complete stretch; whether there was one."""
        plan, settings = self._plan, self._settings
        assert plan is not None
        fresh = False
        times = self._samples.time
        while True:
            begin = self._digested
            end = int(np.searchsorted(times, times[begin] + settings.update))
            after = int(np.searchsorted(times, times[min(end, len(times) - 1)] + CONTEXT)) + 1
            if after > len(times):
                return fresh
            before = max(0, int(np.searchsorted(times, times[begin] - CONTEXT)) - 1)
            recording = self._recording(before, after)
            if float(np.abs(recording.velocity).max()) > plan.speed:
                made = self._made_plan()  # what is remembered is digested again
                if made is None:
                    raise InputError("on-line: the last seconds cannot be identified any more")
                self._plan = plan = made
                continue
            core = Problem(
                recordings=(recording,),
                joint=settings.joint,
                choice=plan.problem.choice,
                torque_hold=settings.torque_hold,
                mask_standstill=settings.mask_standstill,
            ).in_core[0]
            plan.penalty.append(core, begin - before, end - before)
            self._digested = end
            fresh = True

    def _outgrown(self, plan: _Plan, found: OnlineEstimate) -> bool:
        """Whether a bound that came from the first seconds holds a value that the rest would free."""
        held = set(found.at_bound) & set(plan.domain.from_data)
        return bool(held) and found.end - plan.made >= 0.5 * self._settings.window

    def _trim(self, digested: int) -> None:
        """Forget samples that are older than the window and its context."""
        times = self._samples.time
        if len(times) == 0:
            return
        oldest = times[-1] - self._settings.window - self._settings.update - 2.0 * CONTEXT
        count = min(int(np.searchsorted(times, oldest)), digested)
        self._samples.forget(count)
        self._digested = max(0, self._digested - count)

    def _solve(self, plan: _Plan, began: float, dropped: int) -> OnlineEstimate | None:
        form = plan.penalty.compressed()
        domain = plan.domain
        if form is None or plan.penalty.window_count <= 2 * len(domain.names):
            return None
        if form.error > _ROUGH:
            raise InputError(f"on-line: {form.reason}")
        best = _core.minimise_separable(form, domain.lower, domain.upper, threads=1).best
        penalty, residual, jacobian = plan.penalty.linearised(best)
        sizes = np.linalg.norm(jacobian, axis=0)
        noise = size(residual) / np.sqrt(max(1, residual.size - best.size))
        alone = noise / np.where(sizes > 0.0, sizes, 1.0)
        freedom = freedom_of(domain, best, columns_with(jacobian, residual), alone)
        free = list(freedom.indices)
        spread = parameter_covariance(
            jacobian[:, free], residual, self._centre(plan, free), threads=1
        )
        parameters = parameters_of(
            plan.problem, plan.frame, domain, best, freedom, spread, residual.size, (None, None)
        )
        self._updates += 1
        return OnlineEstimate(
            parameters=parameters,
            undetermined=tuple(
                p.name
                for p in parameters.values()
                if p.stderr is not None and p.stderr > _LARGE_ERROR * abs(p.value)
            ),
            at_bound=tuple(p.name for p in parameters.values() if p.at_bound is not None),
            begin=plan.penalty.begin,
            end=plan.penalty.end,
            windows=plan.penalty.window_count,
            penalty=float(penalty),
            joint=joint_of(plan.problem, parameters),
            update=self._updates,
            seconds=time.perf_counter() - began,
            dropped=dropped,
        )

    @staticmethod
    def _centre(plan: _Plan, free: list[int]) -> tuple[int, int, float] | None:
        names = [plan.frame.names[i] for i in free]
        if not {"sensor_gain", "sensor_offset"} <= set(names):
            return None
        reading = plan.penalty.total(plan.frame.names.index("sensor_gain"))
        mean = reading / plan.penalty.usable_duration
        return names.index("sensor_gain"), names.index("sensor_offset"), mean
