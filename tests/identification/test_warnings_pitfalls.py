"""What went wrong once, or would: wide bounds, all at bounds, constant signals, odd arguments."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from example_recordings import WELL_EXCITED

import jointid as jid


def moving(noise: float = 0.0, sign: float = 1.0) -> jid.Recording:
    time = np.arange(0.0, 6.0, 1e-3)
    position = np.sin(1.7 * time) + 0.4 * np.sin(4.1 * time)
    velocity = 1.7 * np.cos(1.7 * time) + 1.64 * np.cos(4.1 * time)
    acceleration = -2.89 * np.sin(1.7 * time) - 6.724 * np.sin(4.1 * time)
    torque = 0.5 * acceleration + 2.0 * np.sign(velocity) + 3.0 * velocity
    torque += np.random.default_rng(3).normal(0.0, noise, time.size) if noise else 0.0
    return jid.Recording(time=time, position=position, velocity=velocity, torque=sign * torque)


def test_very_wide_bounds_hold_nothing() -> None:
    wide = {name: {"min": 0.0, "max": 1e9} for name in ("coulomb", "viscous")}
    estimate = jid.identify(moving(0.1), parameters=wide)
    assert estimate.parameters["coulomb"].value == pytest.approx(2.0, rel=0.01)
    for name in wide:
        assert estimate.parameters[name].at_bound is None
        assert estimate.parameters[name].stderr is not None


@pytest.mark.parametrize("method", ["ga", "separable"])
def test_reversed_torque_is_reported_and_no_crash(method: Any) -> None:
    joint = jid.Joint(torque_offset=False)
    estimate = jid.identify(moving(0.1, sign=-1.0), joint, search=method)
    assert {p.at_bound for p in estimate.parameters.values()} == {"min"}
    assert "at_bound" in {warning.code for warning in estimate.warnings}
    assert "poor_fit" in {warning.code for warning in estimate.warnings}
    assert "poor_fit" in estimate.report(verbose=True)
    assert jid.Estimate.from_json(estimate.to_json()).free == ()


def test_a_sensor_that_is_dead_is_refused() -> None:
    well = jid.load(WELL_EXCITED)
    dead = jid.Recording(
        time=well.time, position=well.position, torque=well.torque, sensor=np.full(len(well), 3.0)
    )
    with pytest.raises(jid.InputError, match="the reading never changes"):
        jid.identify(dead)


def test_white_noise_explains_nothing() -> None:
    base = moving()
    noise = np.random.default_rng(4).normal(50.0, 5.0, len(base))
    estimate = jid.identify(
        jid.Recording(time=base.time, position=base.position, velocity=base.velocity, torque=noise)
    )
    assert estimate.residuals.r_squared < 0.05
    assert "poor_fit" in {warning.code for warning in estimate.warnings}


def test_a_search_without_polish_says_that_it_just_ended() -> None:
    well = jid.load(WELL_EXCITED)
    rough = jid.GaOptions(population=20, generations=3, polish=False)
    estimate = jid.identify(well, jid.thesis_joint(), search=jid.Search(ga=rough))
    assert estimate.status == "stopped"
    assert "stopped" in {warning.code for warning in estimate.warnings}


def test_as_many_windows_as_parameters_know_no_error() -> None:
    estimate = jid.identify(moving(0.1), windows=4, search="separable")
    assert estimate.residuals.windows == 4
    assert all(p.stderr == np.inf for p in estimate.parameters.values())
    assert "undetermined" in {warning.code for warning in estimate.warnings}


def test_numpy_whole_numbers_are_whole_numbers() -> None:
    estimate = jid.identify(  # type: ignore[call-overload]
        moving(),
        windows=np.int64(100),
        search=jid.Search(seed=np.int64(3), threads=np.int32(1)),  # type: ignore[arg-type]
    )
    assert '"seed": 3' in estimate.to_json()


BAD = {
    "seed -1": ({"seed": -1}, "seed"),
    "seed too large": ({"seed": 2**64}, "seed"),
    "threads as text": ({"threads": "all"}, "threads"),
    "threads -1": ({"threads": -1}, "threads"),
    "half a thread": ({"threads": 2.5}, "threads"),
    "ga as a mapping": ({"ga": {}}, "GaOptions"),
    "callback as a number": ({"callback": 3}, "callback"),
    "windows beyond reason": ({"windows": 10**20}, "windows"),
    "windows nan": ({"windows": float("nan")}, "windows"),
    "windows as a word": ({"windows": "many"}, "cumulative"),
    "joint as a path": ({"joint": "joint.toml"}, "Joint.load"),
    "mask as text": ({"mask_standstill": "no"}, "mask_standstill"),
    "gain across zero": ({"parameters": {"sensor_gain": {"min": -5.0, "max": 5.0}}}, "sensor_gain"),
}


@pytest.mark.parametrize(("options", "wording"), BAD.values(), ids=BAD.keys())
def test_odd_arguments_get_one_sentence(options: dict[str, Any], wording: str) -> None:
    well = jid.load(WELL_EXCITED)
    searched = {n: v for n, v in options.items() if n in ("seed", "threads", "ga", "callback")}
    others = {n: v for n, v in options.items() if n not in searched}
    with pytest.raises(jid.InputError, match=wording) as refused:
        jid.identify(well, **{"joint": jid.thesis_joint(), **others}, search=jid.Search(**searched))
    assert "\n" not in str(refused.value)


@pytest.mark.parametrize("recordings", [None, 3, "run.csv", [], ["run.csv"]])
def test_what_is_no_recording_is_refused(recordings: object) -> None:
    with pytest.raises(jid.InputError, match=r"[Rr]ecording"):
        jid.identify(recordings)  # type: ignore[call-overload]


def test_prediction_asks_for_the_same_kind() -> None:
    estimate = jid.identify(moving(), search="separable")
    base = moving()
    axis = jid.Recording(
        time=base.time,
        position=base.position,
        velocity=base.velocity,
        torque=base.torque,
        kind="prismatic",
    )
    with pytest.raises(jid.InputError, match="prismatic"):
        estimate.predict(axis)


def test_bounds_free_a_known_inertia_and_the_joint_learns_it() -> None:
    joint = jid.Joint(rotor_inertia=0.008, gear_ratio=10.0)  # 0.8 at the output, truly 0.5
    free = {"inertia": {"min": 0.1, "max": 2.0}}
    estimate = jid.identify(moving(), joint, parameters=free, search="separable")
    assert estimate.parameters["inertia"].value == pytest.approx(0.5, rel=0.01)
    assert estimate.joint.reflected_inertia == estimate.parameters["inertia"].value


def test_bursts_of_stamps_are_refused() -> None:
    base = moving()
    time = base.time.copy()
    time[1::2] = time[:-1:2] + 1e-6
    assert base.torque is not None
    bursts = jid.Recording(time=time, position=base.position, torque=base.torque)
    with pytest.raises(jid.InputError, match="bursts"):
        jid.identify(bursts)


def test_an_estimate_is_not_saved_over_a_folder(tmp_path: Path) -> None:
    from jointid.report.saving import save_report

    with pytest.raises(IsADirectoryError, match="folder"):
        save_report(jid.identify(moving(), search="separable"), tmp_path)
    assert list(tmp_path.iterdir()) == []
