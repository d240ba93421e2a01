"""What an estimate says of its parameters: held by a bound, how certain, named; each at its limit."""

from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from fake_evidence import RUN, parameter

import jointid as jid
from jointid import _core
from jointid.balance.covariance import parameter_covariance
from jointid.identification import conclusion
from jointid.identification.inference.inference import (
    Freedom,
    freedom_of,
    joint_of,
    parameters_of,
    statistics_of,
)
from jointid.identification.search.domain import SearchDomain
from jointid.joint.parameters import Parameter
from jointid.problem.window_table import WindowTable


def domain(low: float, high: float) -> SearchDomain:
    return SearchDomain(
        names=("viscous",), lower=np.array([low]), upper=np.array([high]), from_data=()
    )


def held(
    value: float, alone: float, gradient: float = 1.0, low: float = 0.0, high: float = 1e4
) -> Any:
    found = freedom_of(domain(low, high), *(np.array([x]) for x in (value, gradient, alone)))
    assert (found.indices == ()) == (found.at_bound[0] is not None or low == high)
    return found.at_bound[0]


@pytest.mark.parametrize(
    ("value", "alone", "bound"),
    [
        (0.99e-3, 1.0, "min"),  # a thousandth of its error by noise
        (1.01e-3, 1.0, None),
        (0.99e-2, 1e3, "min"),  # a millionth of the domain, however noisy
        (1.01e-2, 1e3, None),
        (0.99e-10, 0.0, "min"),  # rounding of the domain, without noise
        (1.01e-10, 0.0, None),
        (1e4 - 0.99e-3, 1.0, None),
    ],
)
def test_a_value_near_its_bound_is_held(value: float, alone: float, bound: str | None) -> None:
    assert held(value, alone) == bound


def test_a_bound_holds_only_what_would_go_beyond() -> None:
    assert held(0.0, 1.0, gradient=1.0) == "min"
    assert held(0.0, 1.0, gradient=0.0) == "min"
    assert held(0.0, 1.0, gradient=-1.0) is None
    assert held(1e4, 1.0, gradient=-1.0) == "max"
    assert held(1e4, 1.0, gradient=0.0) == "max"
    assert held(1e4, 1.0, gradient=1.0) is None
    assert held(5.0, 1.0, low=5.0, high=5.0) is None


def test_shares_of_what_was_left_out() -> None:
    """Intervals between samples of two recordings, of which there are two less; standing counts samples."""
    residual = np.array([1.0, -1.0, 2.0])
    table = WindowTable(
        recording=np.zeros(3, dtype=np.int64),
        start=np.zeros(3),
        stop=np.ones(3),
        duration=np.full(3, 0.5),
        measured=residual,
        fitted=np.zeros(3),
        velocity=np.ones(3),
        friction=np.zeros(3),
    )
    penalty: Any = SimpleNamespace(
        total_samples=12,
        window_count=3,
        window_duration=0.5,
        noise_share=0.0,
        unusable_intervals=4,
        standing_samples=3,
    )
    found = statistics_of(SimpleNamespace(recordings=(RUN, RUN)), penalty, table)  # type: ignore[arg-type]
    assert found.left_out == pytest.approx(0.4)
    assert found.standing == 0.25
    assert found.rms == pytest.approx(np.sqrt((4.0 + 4.0 + 16.0) / 3.0))
    assert found.autocorrelation == pytest.approx((-1.0 - 2.0) / 6.0)


@pytest.mark.parametrize(
    ("freedom", "systematic", "half"),
    [
        (1e12, {}, 1.959964),
        (5.0, {}, 2.570582),  # Student's t
        (1e12, {"windows": 2.0}, 1.959964 * np.hypot(1.0, 2.0)),
        (1e12, {"windows": 2.0, "curvature": 1.0}, 1.959964 * np.sqrt(6.0)),
        (1e12, {"residual_side": 5.0, "given": 7.0}, 1.959964),  # beside the interval
        (1e12, {"sampling": 100.0}, 100.0 + 1.644854),  # an error within known limits
    ],
)
def test_an_interval_is_chance_and_what_the_recording_shows(
    freedom: float, systematic: dict[str, float], half: float
) -> None:
    model = jid.Model("coulomb_viscous").resolved
    problem: Any = SimpleNamespace(
        recordings=(RUN,), choice=SimpleNamespace(model=SimpleNamespace(resolved=model))
    )
    penalty: Any = SimpleNamespace(names=["viscous"], terms=[_core.term("viscous")])
    spread: Any = SimpleNamespace(stderr=np.array([1.0]), freedom=np.array([freedom]))
    found = parameters_of(
        problem,
        penalty,
        domain(0.0, 1e3),
        np.array([20.0]),
        Freedom(indices=(0,), at_bound=(None,)),
        spread,
        {name: np.array([size]) for name, size in systematic.items()},
        (None, np.array([0.5])),
    )["viscous"]
    assert found.interval is not None
    assert found.interval[0] == pytest.approx(20.0 - half)
    assert found.interval[1] == pytest.approx(20.0 + half)
    assert (found.shift_halved, found.shift_doubled) == (None, 0.5)


def _joint(joint: jid.Joint | None, *found: Any) -> jid.Joint:
    choice = SimpleNamespace(
        sensor=joint is None or joint.sensor, terms=(), model=jid.Model("coulomb_viscous")
    )
    problem: Any = SimpleNamespace(choice=choice, recordings=(RUN,), joint=joint)
    return joint_of(problem, {each.name: each for each in found})


def test_a_joint_s_bounds_make_room_for_what_was_found() -> None:
    known = jid.Joint(
        parameters={"viscous": Parameter(name="viscous", value=5.0, min=1.0, max=10.0)}
    )
    for value, low, high in ((5.5, 1.0, 10.0), (0.5, 0.5, 10.0), (12.0, 1.0, 12.0)):
        found = _joint(known, parameter("viscous", value)).parameters["viscous"]
        assert (found.value, found.min, found.max) == (value, low, high)


def test_an_inertia_that_was_found_is_the_drive_s() -> None:
    """With the sensor at the link the link's inertia is apart; without one it is part of what was found."""
    link = jid.Link(mass=3.0, centre_of_mass=0.25, inertia=0.25)
    for sensor, own in ((True, 2.0), (False, 1.75)):
        joint = jid.Joint(inertia=1.0, link=link, sensor=sensor)
        assert _joint(joint, parameter("inertia", 2.0)).inertia == pytest.approx(own)
    joint = jid.Joint(inertia=1.0, link=link, sensor=False)
    assert _joint(joint, parameter("inertia", 0.2)).inertia == 1.0  # less than the link alone
    assert _joint(joint, parameter("inertia", 2.0, None, vary=False)).inertia == 1.0


@pytest.mark.parametrize(("share", "named"), [(0.305, True), (0.295, False)])
def test_the_weakest_direction_names_its_large_parts(
    share: float, named: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    def covariance(*arguments: Any, **options: Any) -> Any:
        found = parameter_covariance(*arguments, **options)
        weakest = np.zeros_like(found.weakest)
        weakest[:2] = 1.0, -share
        return replace(found, weakest=weakest)

    monkeypatch.setattr(conclusion, "parameter_covariance", covariance)
    time = np.arange(3000) * 1e-3
    velocity = np.cos(5.0 * time) + 0.3 * np.cos(17.0 * time)
    acceleration = -5.0 * np.sin(5.0 * time) - 5.1 * np.sin(17.0 * time)
    run = jid.Recording(
        time=time,
        position=np.sin(5.0 * time) / 5.0 + 0.3 * np.sin(17.0 * time) / 17.0,
        velocity=velocity,
        torque=2.0 * acceleration + 20.0 * velocity + 5.0 * np.sign(velocity),
    )
    estimate = jid.identify(run, jid.Joint(), model="coulomb_viscous", search="separable")
    assert len(estimate.weakest) == 1 + named
