"""When a torque sensor is sampled against the steps of a held torque, and stops shorter than a sample."""

from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray
from plants import Bench, Law, Log, Plant, simulate, thesis

import jointid as jid
from jointid import _core
from jointid.identification.refinements.sensor_instant import without_early_reading
from jointid.problem.problem import Problem

Array = NDArray[np.float64]
JOINT = jid.Joint(inertia=1.8, sensor=True, model=jid.Model("stribeck"))


@pytest.fixture(scope="module")
def runs() -> dict[float, list[jid.Recording]]:
    """Two joints for each noise; their controller reads before it commands."""
    noises = (0.0, 0.01, 0.02, 3.0)
    benches = [
        Bench(
            motion=thesis(np.radians([60.0, 55.0]), [3.0, 3.4]),
            plant=Plant(inertia=1.8, link_inertia=0.3, gravity=7.0),
            law=Law(
                inertia=1.8,
                stiffness=60.0,
                on_reference=1.0,
                coulomb=18.0,
                static=8.0,
                feedback=2.0,
            ),
            log=Log(sensor_noise=noise),
        )
        for noise in noises
    ]
    found = simulate(Bench.stack(benches), duration=5.0, seed=3, finer=10)
    return {noise: found[2 * k : 2 * k + 2] for k, noise in enumerate(noises)}


def of_middle(run: jid.Recording, share: float = 0.5) -> jid.Recording:
    """The recording as if it were sampled in the middle of each step, or after it."""
    assert run.torque is not None
    assert run.sensor is not None
    change = np.diff(run.torque, prepend=run.torque[0])
    step = share * 0.3 / 2.1 / 2.4 * change
    signals = {name: getattr(run, name) for name in run.signals}
    return jid.Recording(
        **signals | {"sensor": run.sensor + step}, torque_hold="zoh", truth=run.truth
    )


def found(run: jid.Recording) -> jid.Estimate:
    return jid.identify(run, JOINT, search="separable")


@pytest.mark.parametrize("noise", [0.0, 0.02])
def test_a_reading_before_the_command_is_moved_to_the_middle_of_its_step(
    runs: dict[float, list[jid.Recording]], noise: float
) -> None:
    for run in runs[noise]:
        estimate = found(run)
        assert estimate.settings["sensor_before_step"] == 1.0
        gain = estimate.parameters["sensor_gain"]
        assert gain.value == pytest.approx(2.4, rel=1e-3)
        assert gain.interval is not None
        assert gain.interval[0] < 2.4 < gain.interval[1]
        assert not estimate.warnings


def test_a_reading_in_the_middle_or_after_the_step_is_known_as_such(
    runs: dict[float, list[jid.Recording]],
) -> None:
    for run in runs[0.01]:
        middle, after = found(of_middle(run)), found(of_middle(run, 1.0))
        assert abs(middle.settings.get("sensor_before_step", 0.0)) < 0.3
        assert after.settings["sensor_before_step"] == -1.0
        for estimate in (middle, after):
            assert estimate.parameters["sensor_gain"].value == pytest.approx(2.4, rel=2e-3)


def test_folds_measure_the_instant_only_where_all_data_lack_a_part_of_the_step(
    runs: dict[float, list[jid.Recording]], monkeypatch: pytest.MonkeyPatch
) -> None:
    measured: list[int] = []

    def counted(problem: Problem, *rest: Any) -> Any:
        measured.append(len(problem.recordings[0]))
        return without_early_reading(problem, *rest)

    monkeypatch.setattr("jointid.identification.prepared.without_early_reading", counted)
    early = runs[0.01][0]
    for run, times in ((early, 4), (of_middle(early), 1)):  # all data, and three folds
        measured.clear()
        jid.compare_models(run, JOINT, models=("stribeck",), folds=3)
        assert len(measured) == times


def test_a_reading_that_is_noise_is_left_as_it_is(runs: dict[float, list[jid.Recording]]) -> None:
    run = runs[3.0][0]
    assert "sensor_before_step" not in found(run).settings


def usable(velocity: Array) -> NDArray[np.bool_]:
    """Usable intervals of a motion with this velocity."""
    time = np.arange(len(velocity)) * 1e-3
    position = np.concatenate([[0.0], np.cumsum(0.5e-3 * (velocity[1:] + velocity[:-1]))])
    core = _core.Recording(
        time=time,
        position=position,
        velocity=velocity,
        torque=np.sin(9.0 * time),
        sensor=None,
        torque_hold=_core.Hold.linear,
        gap_after=[],
    )
    return np.asarray(_core.usable_intervals(core, True), dtype=bool)


def test_a_stop_shorter_than_a_sample_is_left_out() -> None:
    steps = np.arange(-2000, 2001)
    away = np.abs(steps - 0.05) * 5e-4 + 1e-7 * steps**2  # comes to rest, and goes on
    kept = usable(away)
    assert not kept[1999:2001].any()
    assert kept[:1990].all()
    assert kept[2010:].all()
    slower = away + 5e-4  # never at rest
    assert usable(slower).all()
    turned = np.sign(steps - 0.05) * away  # passes rest without a stop
    assert usable(turned).all()
    rest = np.where(np.abs(steps - 0.5) < 1.0, 0.1, 1.0) * turned  # stays there for a moment
    assert not usable(rest)[1999:2001].any()
