"""What is stated for a design and cannot be used is named, before anything is simulated."""

from typing import Any

import numpy as np
import pytest

import jointid as jid

JOINT = jid.Joint(inertia=2.0, model=jid.Model("coulomb_viscous")).with_parameters(
    {"coulomb": 5.0, "viscous": 3.0}
)
LIMITS = {"position": (-1.0, 1.0), "velocity": 2.0, "torque": 40.0}
QUICK = jid.DesignSearch(evaluations=64, rehearsals=10, joints=1)
PRIOR = {"torque_offset": (-1.0, 1.0)}


@pytest.mark.parametrize(
    ("changes", "says"),
    [
        ({"controller": "pd"}, "controller is 'pd': one of AdaptiveRobust, CompensatedPid"),
        ({"controller": jid.OpenLoop()}, "controller is 'open_loop': a motion is designed for"),
        ({"sensors": {"encoder_counts": 8000}}, "a Sensors value is expected"),
        (
            {"sensors": jid.Sensors(torque_noise=0.5)},
            "sensors.torque_noise is 0.5: the joint has no torque sensor",
        ),
        ({"parameters": "viscous"}, "parameters is 'viscous': a list of names is expected"),
        ({"callback": 3}, "callback is 3: a callable is expected"),
        ({"prior": 0.3}, "prior is 0.3: a range by parameter, or values of joints, are expected"),
        ({"prior": "viscous"}, "prior is 'viscous': a range by parameter"),
        ({"prior": PRIOR | {"viscous": (-5.0, 2.0)}}, "prior: viscous is [-5.0, 2.0]: it cannot"),
        ({"limits": LIMITS | {"acceleration": 1e-6}}, "no motion was found from which the joint"),
    ],
)
def test_what_cannot_be_used_is_named(changes: dict[str, Any], says: str) -> None:
    given: dict[str, Any] = {"limits": LIMITS, "duration": 2.0, "prior": PRIOR, "search": QUICK}
    with pytest.raises(jid.InputError) as refused:
        jid.design_excitation(JOINT, **given | changes)
    assert says in str(refused.value)


def test_a_window_may_be_an_array() -> None:
    limits = LIMITS | {"position": np.array([-1.0, 1.0]), "velocity": np.float32(2.0)}
    found = jid.design_excitation(JOINT, limits, 2.0, prior=PRIOR, search=QUICK)
    assert found.limits.position == (-1.0, 1.0)
