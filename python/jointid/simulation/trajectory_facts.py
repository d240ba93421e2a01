"""Short descriptions of a trajectory: a line at the prompt, a table in a notebook."""

from __future__ import annotations

import numpy as np

from jointid import _core
from jointid.base.html import Html, element, table

_INSTANTS = 2001  # samples that give the extremes


def line_of(form: str, trajectory: _core.Trajectory) -> str:
    """Return one line about a trajectory; see `repr`."""
    (low, high), speed, _ = _extremes(trajectory)
    return (
        f"<Trajectory: {form}, {trajectory.duration:.6g} s, position {low:.4g} to {high:.4g}, "
        f"speed up to {speed:.4g}>"
    )


def html_facts(form: str, trajectory: _core.Trajectory) -> Html:
    """Return the trajectory's facts as a table. Units are those of a revolute joint."""
    (low, high), speed, acceleration = _extremes(trajectory)
    rows: list[list[Html | str]] = [
        ["form", form],
        ["duration", f"{trajectory.duration:.6g} s"],
        ["position", f"{low:.4g} … {high:.4g} rad"],
        ["largest speed", f"{speed:.4g} rad/s"],
        ["largest acceleration", f"{acceleration:.4g} rad/s²"],
    ]
    return element("div", element("b", "jointid trajectory"), table(rows))


def _extremes(trajectory: _core.Trajectory) -> tuple[tuple[float, float], float, float]:
    time = np.linspace(0.0, trajectory.duration, _INSTANTS)
    position, velocity, acceleration = trajectory.sample(time).T
    span = (float(position.min()), float(position.max()))
    return span, float(np.abs(velocity).max()), float(np.abs(acceleration).max())
