"""Cost of the general Stribeck model against the plain one: CPU time of whole calls and per candidate, in turn."""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping
from typing import Final, Literal

import numpy as np
from numpy.typing import NDArray
from peers.contest import Contest
from projections import given
from store import Record

import jointid as jid
from jointid import _core

REPEATS = 7
GENERAL: Final = "stribeck_general"
WIDE = {
    "stribeck_velocity": jid.Parameter(name="stribeck_velocity", min=1e-5, max=10.0),
    "stribeck_exponent": jid.Parameter(name="stribeck_exponent", min=0.1, max=8.0),
}
PLAIN = "`stribeck`"


def measure(contest: Contest) -> list[Record]:
    """Record, per row, the whole call and its ratio to the plain model's."""

    def call(
        model: Literal["stribeck", "stribeck_general"],
        search: Literal["ga", "separable"] = "separable",
        parameters: Mapping[str, float | jid.Parameter] | None = None,
    ) -> Callable[[], object]:
        return lambda: jid.identify(
            contest.recording, contest.joint, model=model, search=search, parameters=parameters
        )

    calls = {
        PLAIN: call("stribeck"),
        "`stribeck_general`": call(GENERAL),
        '`stribeck_general`, `search="ga"`': call(GENERAL, "ga"),
        "`stribeck_general`, wide bounds": call(GENERAL, parameters=WIDE),
        "`stribeck_general`, exponent fixed at 2": call(
            GENERAL, parameters={"stribeck_exponent": 2.0}
        ),
    }
    for model in ("stribeck", GENERAL):
        problem = given(model, (contest.recording,), contest.joint, model)
        middle = 0.5 * (problem.domain.lower + problem.domain.upper)
        calls[f"100 candidates of the direct penalty, `{model}`"] = _hundred(problem.direct, middle)
    spent = dict.fromkeys(calls, float("inf"))
    for _ in range(REPEATS):
        for name, each in calls.items():
            began = time.process_time()
            each()
            spent[name] = min(spent[name], time.process_time() - began)
    return [
        {"kind": "model", "name": name, "seconds": seconds, "ratio": seconds / spent[PLAIN]}
        for name, seconds in spent.items()
    ]


def _hundred(penalty: _core.Penalty, theta: NDArray[np.float64]) -> Callable[[], object]:
    return lambda: [penalty(theta) for _ in range(100)]


if __name__ == "__main__":
    from peers.contest import make_contest

    for record in measure(make_contest()):
        print(record)
