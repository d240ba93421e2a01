"""Computation of estimates from the samples of the last seconds, on the identifier's thread."""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from jointid import _core
from jointid.balance.covariance import parameter_covariance
from jointid.base.errors import InputError
from jointid.identification.inference.inference import freedom_of, joint_of, parameters_of
from jointid.identification.inference.offset_or_asymmetry import divided, with_undivided
from jointid.online.online_estimate import OnlineEstimate
from jointid.online.pieces import SHORTEST, next_piece
from jointid.online.plan import Plan, make_plan, outdated
from jointid.online.samples import Samples
from jointid.online.settings import OnlineSettings
from jointid.problem.constant_torque import balanced, undivided
from jointid.problem.inner_products import columns_with, size
from jointid.recording.recording import Recording

Array = NDArray[np.float64]

_LARGE_ERROR = 0.05
# Largest error of the compressed penalty over the columns' squared size, because no direct sum can verify it.
_ROUGH = 1e-11
# The plan is checked whenever the samples in memory have grown by this share.
_GROWTH = 0.4
# Duration of samples kept in addition to the window while there is no plan [s].
_ROOM = 0.3


class Sliding:
    """Processes samples piece by piece and estimates from the last `window` seconds.

    Parameters
    ----------
    settings : OnlineSettings
    signals : tuple of str
        Names of the signals, "time" among them.
    closed : callable, optional
        Function that returns whether to stop; called once per piece. Default: never.
    """

    def __init__(
        self,
        settings: OnlineSettings,
        signals: tuple[str, ...],
        closed: Callable[[], bool] = lambda: False,
    ) -> None:
        self._settings = settings
        self._closed = closed
        self._samples = Samples(signals)
        self._plan: Plan | None = None
        self._look = -np.inf  # time of the plan's next check or attempt [s]
        self._digested = 0  # index of the first unprocessed sample
        self._updates = 0

    def append(self, given: Mapping[str, Array]) -> None:
        """Add samples, in order."""
        self._samples.append(given)

    def estimate(self, dropped: int) -> OnlineEstimate | None:
        """Process complete pieces, and return the estimate; None without a new piece or with too few windows."""
        began = time.perf_counter()
        self._trim()
        if self._plan is None:
            self._first_plan()
        else:
            self._review(self._plan)
        if not self._digest() or self._plan is None:
            return None
        self._plan.penalty.forget(self._plan.penalty.end - self._settings.window)
        found = self._solve(self._plan, began, dropped)
        if found is not None and self._outgrown(self._plan, found):
            self._plan.made = found.end
            self._renew(self._remembered())  # the next piece uses bounds from all samples
        return found

    def _recording(self, begin: int, end: int) -> Recording:
        signals: dict[str, Any] = self._samples.stretch(begin, end)
        kind = self._settings.joint.kind if self._settings.joint is not None else "revolute"
        return Recording(**signals, kind=kind)

    def _remembered(self) -> Recording:
        return self._recording(0, len(self._samples))

    def _adopt(self, plan: Plan) -> None:
        """Start with a new plan; the samples in memory are processed again."""
        self._plan = plan
        self._digested = 0
        self._look_later()

    def _look_later(self) -> None:
        times, window = self._samples.time, self._settings.window
        now = float(times[-1])
        span = now - float(times[0])
        self._look = now + (window if span >= window else min(_GROWTH * span, window - span))

    def _first_plan(self) -> None:
        times, update = self._samples.time, self._settings.update
        if len(times) < SHORTEST or times[-1] - times[0] < 2.0 * update or times[-1] < self._look:
            return
        # Without a pause, every call would examine all samples while the joint is at rest.
        self._look = float(times[-1]) + update
        plan = make_plan(self._settings, self._remembered(), 0.0)
        if plan is not None:
            self._adopt(plan)

    def _review(self, plan: Plan) -> None:
        """Replace the plan if the samples in memory need another one."""
        if self._samples.time[-1] < self._look:
            return
        self._look_later()
        remembered = self._remembered()
        if outdated(plan, self._settings, remembered):
            self._renew(remembered)

    def _renew(self, remembered: Recording) -> None:
        """Adopt a new plan, if one can be made."""
        try:
            made = make_plan(self._settings, remembered, 0.0)
        except InputError:
            return  # the motion is too small for a new plan; the present plan stays
        if made is not None:
            self._adopt(made)

    def _digest(self) -> bool:
        """Process all complete pieces, and return whether there was one."""
        fresh = False
        while self._plan is not None and not self._closed():
            plan = self._plan
            piece = next_piece(self._samples.time, self._digested, plan)
            if piece is None:
                return fresh
            if piece.end > piece.begin:
                recording = self._recording(piece.before, piece.after)
                inside = slice(piece.begin - piece.before, piece.end - piece.before)
                # Without the context, because a derived velocity is several times noisier at the ends.
                fastest = float(np.abs(recording.velocity[inside.start : inside.stop + 1]).max())
                if fastest > plan.speed:
                    fresh = False
                    self._replan_for(fastest)
                    continue
                core = self._settings.problem(recording, plan.problem.choice).in_core[0]
                plan.penalty.append(core, inside.start, inside.stop)
                fresh = True
            self._digested = piece.next
        return fresh

    def _replan_for(self, fastest: float) -> None:
        self._plan = None
        plan = make_plan(self._settings, self._remembered(), fastest)
        if plan is not None:
            self._adopt(plan)

    def _outgrown(self, plan: Plan, found: OnlineEstimate) -> bool:
        """Return whether a parameter ended on a bound from earlier samples, and new bounds may release it."""
        held = set(found.at_bound) & set(plan.domain.from_data)
        return bool(held) and found.end - plan.made >= 0.5 * self._settings.window

    def _trim(self) -> None:
        """Remove samples older than the window and its context, processed or not."""
        times, settings, plan = self._samples.time, self._settings, self._plan
        if len(times) == 0:
            return
        room = _ROOM + settings.update if plan is None else plan.stretch + 2.0 * plan.context
        count = int(np.searchsorted(times, times[-1] - settings.window - room))
        self._samples.forget(count)
        self._digested = max(0, self._digested - count)

    def _solve(self, plan: Plan, began: float, dropped: int) -> OnlineEstimate | None:
        form = plan.penalty.compressed()
        domain = plan.domain
        if form is None or plan.penalty.window_count <= 2 * len(domain.names):
            return None
        if form.error > _ROUGH:
            raise InputError(form.reason, place="on-line identification")
        found = _core.minimise_separable(form, domain.lower, domain.upper, threads=1).best
        best = balanced(domain.names, domain.lower, domain.upper, found)
        penalty, residual, jacobian = plan.penalty.linearised(best)
        sizes = np.linalg.norm(jacobian, axis=0)
        noise = size(residual) / np.sqrt(max(1, residual.size - best.size))
        alone = noise / np.where(sizes > 0.0, sizes, 1.0)
        freedom = freedom_of(domain, best, columns_with(jacobian, residual), alone)
        free = list(freedom.indices)
        names = list(domain.names)
        groups = undivided([names[index] for index in free])
        kept = divided(free, names, groups)
        centre = self._centre(plan, kept)
        spread = parameter_covariance(jacobian[:, kept], residual, centre, threads=1)
        spread = with_undivided(spread, kept, free, names, groups)
        parameters = parameters_of(
            plan.problem, plan.frame, domain, best, freedom, spread, {}, (None, None)
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
    def _centre(plan: Plan, free: list[int]) -> tuple[int, int, float] | None:
        names = [plan.frame.names[i] for i in free]
        if not {"sensor_gain", "sensor_offset"} <= set(names):
            return None
        reading = plan.penalty.total(plan.frame.names.index("sensor_gain"))
        mean = reading / plan.penalty.usable_duration
        return names.index("sensor_gain"), names.index("sensor_offset"), mean
