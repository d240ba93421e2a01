"""A servo's answer in a few lines: the verdict, its values, the first finding, and its advice."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from jointid.base.advice import Action
from jointid.base.error_text import printable
from jointid.estimate.answers import findings, purposes, values
from jointid.servo.layout import MOTOR
from jointid.servo.record import ServoEstimateRecord
from jointid.servo.verdict import judged_servo

_FINDINGS = 1
# Values that a simulator needs come first, then the values from which they are derived.
_FIRST, _LAST = (*MOTOR, "inertia"), ("torque_per_voltage", "back_emf")


def answer(
    estimate: ServoEstimateRecord,
    action: Callable[[Action], str] = str,
    saved: str = "",
    rollout_error: float | None = None,
) -> str:
    """Return the answer in at most 15 lines.

    `action` gives the text of an advice. `saved` is the file of the estimate. `rollout_error` is the median error of
    the runs' simulations [rad], if there are any.
    """
    count = len(estimate.runs)
    verdict, runs = judged_servo(estimate), f"{count} run{'s' * (count != 1)}"
    parameters = estimate.parameters
    ordered = dict.fromkeys([*_FIRST, *(n for n in parameters if n not in _LAST), *_LAST])
    lines = [
        f"{estimate.joint.name or 'servo'}, {runs}: {verdict.level}",
        *purposes(verdict),
        *values([parameters[name] for name in ordered]),
    ]
    if rollout_error is not None:
        lines.append(f"rollout: position error {np.degrees(rollout_error):.2f}°, median of {runs}")
    lines += findings(estimate.findings, action, _FINDINGS, saved)
    return printable("\n".join(lines))
