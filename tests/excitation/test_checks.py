"""Arguments of a design that cannot be used are named, before anything is simulated."""

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
        ({"controller": jid.OpenLoop()}, "controller is 'open_loop': a design needs a controller"),
        ({"sensors": {"encoder_counts": 8000}}, "a Sensors value is expected"),
        (
            {"sensors": jid.Sensors(torque_noise=0.5)},
            "sensors.torque_noise is 0.5: the joint has no torque sensor",
        ),
        ({"parameters": "viscous"}, "parameters is 'viscous': a list of names is expected"),
        ({"duration": 1e-3}, "duration is 0.001: 8 to 1000000 control periods of 0.001 s"),
        ({"control_period": 3.0}, "duration is 2.0: 8 to 1000000 control periods of 3 s"),
        ({"duration": 1e6}, "duration is 1000000.0: 8 to 1000000 control periods of 0.001 s"),
        ({"parameters": 5}, "parameters is 5: a list of names is expected"),
        ({"callback": 3}, "callback is 3: a callable is expected"),
        ({"prior": 0.3}, "prior is 0.3: a mapping from parameters to ranges, or a list"),
        ({"prior": "viscous"}, "prior is 'viscous': a mapping from parameters"),
        ({"prior": PRIOR | {"viscous": (-5.0, 2.0)}}, "prior: viscous is [-5.0, 2.0]: it cannot"),
        (
            {"limits": LIMITS | {"acceleration": 1e-6}},
            "no motion was found that identifies the joint",
        ),
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


@pytest.mark.parametrize("believed", [(-1.0, 1.0), (-3.0, -1.0), (0.0, 1.0)])
def test_a_gain_that_may_be_0_is_named_before_the_search(believed: tuple[float, float]) -> None:
    with pytest.raises(jid.InputError, match=r"prior: sensor_gain is .* contain 0"):
        jid.design_excitation(
            jid.thesis_joint(),
            {"position": (-1.0, 1.0), "velocity": 3.4, "torque": 160.0},
            2.0,
            prior={"sensor_gain": believed},
            search=QUICK,
        )


@pytest.mark.parametrize(
    ("narrow", "says"),
    [
        ({"velocity": 1e-6}, "the velocity reaches"),
        ({"position": (0.0, 1e-5)}, "the position reaches"),
    ],
)
def test_a_limit_far_too_narrow_is_named_and_not_the_loop(
    narrow: dict[str, Any], says: str
) -> None:
    joint = jid.thesis_joint()
    limits = {"position": (-1.0, 1.0), "velocity": 3.4, "torque": 160.0} | narrow
    prior = {"coulomb": (20.0, 30.0), "static": (16.0, 24.0), "stribeck": (80.0, 120.0)}
    prior |= {"viscous": (16.0, 24.0), "sensor_gain": (1.9, 2.9), "sensor_offset": (12.0, 18.0)}
    sensors = jid.Sensors(torque_noise=0.5)
    design = jid.design_excitation(joint, limits, 3.0, prior=prior, sensors=sensors, search=QUICK)
    assert design.status == "limits exceeded"
    assert says in design.reason


def test_one_joint_is_one_joint() -> None:
    design = jid.design_excitation(JOINT, LIMITS, 2.0, prior=PRIOR, search=QUICK)
    assert "judged with 1 joint drawn from" in design.summary()
