"""A model that nobody names is chosen by the torque that it predicts, and the estimate says how."""

import json
import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import jointid as jid
from jointid.cli.demonstration import data_folder
from jointid.estimate.selection import Selection
from jointid.identification.selection.selecting import excess

EXAMPLES = Path(__file__).resolve().parents[2] / "examples" / "data"
TIME = np.arange(0.0, 12.0, 0.002)


def motion(seed: int = 0) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Position, velocity and acceleration of a multisine."""
    rng = np.random.default_rng(seed)
    rate = 2.0 * np.pi * np.array([0.15, 0.35, 0.6])
    phase = rng.uniform(0.0, 2.0 * np.pi, 3)
    angle = np.outer(TIME, rate) + phase
    size = np.array([0.4, 0.2, 0.1])
    return np.sin(angle) @ size, np.cos(angle) @ (size * rate), -np.sin(angle) @ (size * rate**2)


def recording(
    *, static: float = 0.0, gravity: float = 0.0, seed: int = 0, noise: float = 0.3
) -> jid.Recording:
    position, velocity, acceleration = motion(seed)
    dry = 8.0 + static * np.exp(-60.0 * velocity**2)
    torque = 1.5 * acceleration + dry * np.sign(velocity) + 6.0 * velocity + 0.7
    torque += gravity * np.sin(position)
    torque += np.random.default_rng([seed, 1]).normal(0.0, noise, TIME.size)
    return jid.Recording(time=TIME, position=position, velocity=velocity, torque=torque)


@pytest.fixture(scope="module")
def home() -> jid.Estimate:
    return jid.identify(jid.load(EXAMPLES / "well_excited.csv.gz"))


def chosen(*arguments: Any, **keywords: Any) -> Selection:
    estimate: jid.Estimate = jid.identify(*arguments, **{"search": "separable", **keywords})
    assert estimate.selection is not None
    return estimate.selection


def test_a_strain_wave_joint_is_found_by_the_plainest_call(home: jid.Estimate) -> None:
    assert home.selection is not None
    assert home.selection.model == home.settings["model"] == home.joint.model.name == "stribeck"
    assert home.parameters["sensor_gain"].value == pytest.approx(2.4, rel=0.01)
    (line,) = [each for each in home.report(verbose=True).splitlines() if each.startswith("chosen")]
    wanted = (
        r"stribeck has a residual of 0\.2\d+ % of the held-out torque, coulomb_viscous has 4\.11 %"
    )
    assert re.search(wanted, line)
    assert line.split(maxsplit=1)[1] in home._repr_html_()


def test_it_is_repeated_by_naming_what_was_chosen(home: jid.Estimate) -> None:
    again = jid.identify(jid.load(EXAMPLES / "well_excited.csv.gz"), model=home.settings["model"])
    assert again.selection is None
    assert [p.value for p in again.parameters.values()] == [
        p.value for p in home.parameters.values()
    ]


@pytest.mark.parametrize("static", [0.0, 5.0])
@pytest.mark.parametrize("gravity", [0.0, 4.0])
def test_the_truth_is_chosen(static: float, gravity: float) -> None:
    name = "stribeck" if static else "coulomb_viscous"
    expected = f"{name}:gravity=free" if gravity else name
    found = [chosen(recording(static=static, gravity=gravity, seed=s)).model for s in range(8)]
    assert found.count(expected) >= 7, found


def test_what_is_stated_stays() -> None:
    loaded = recording(static=5.0, gravity=4.0)
    assert chosen(loaded, model=":gravity=none").model == "stribeck"
    assert chosen(loaded, model="auto:gravity=free").model == "stribeck:gravity=free"
    assert chosen(loaded, model=":harmonics=1").model == "stribeck:harmonics=1"
    assert chosen(
        loaded, jid.Joint(model=jid.Model("coulomb_viscous")), model="auto"
    ).model.startswith("stribeck")
    assert (
        jid.identify(
            loaded, jid.Joint(model=jid.Model("coulomb_viscous")), search="separable"
        ).selection
        is None
    )


def test_a_described_link_has_its_weight_where_the_log_shows_it() -> None:
    weight = jid.Link(mass=1.0, centre_of_mass=4.0 / 9.80665, angle=-np.pi / 2.0)
    hanging = chosen(recording(static=5.0, gravity=4.0), jid.Joint(link=weight))
    assert hanging.model == "stribeck:gravity=known"
    upright = chosen(recording(static=5.0), jid.Joint(link=weight))
    assert upright.model == "stribeck"
    stated = jid.Joint(link=weight, model=jid.Model(gravity="none"))
    assert chosen(recording(static=5.0, gravity=4.0), stated).model == "stribeck"


def test_a_link_that_is_described_wrongly_does_not_win_and_is_named() -> None:
    for mass, angle in ((10.0, -np.pi / 2.0), (1.0, 0.0)):
        link = jid.Link(mass=mass, centre_of_mass=4.0 / 9.80665, angle=angle)
        loaded, joint = recording(gravity=4.0), jid.Joint(link=link)
        found = jid.identify(loaded, joint, search="separable")
        assert found.settings["model"] == "coulomb_viscous:gravity=free"
        assert found["coulomb"].value == pytest.approx(8.0, rel=0.02)
        known = jid.identify(
            loaded, joint, model=jid.Model("coulomb_viscous", gravity="known"), search="separable"
        )
        assert "gravity" in {each.code for each in known.warnings}


def test_a_parameter_of_the_call_has_its_model() -> None:
    plain = recording()
    found = jid.identify(plain, parameters={"static": 0.5}, search="separable")
    assert found.settings["model"] == "stribeck"
    assert found.parameters["static"].value == 0.5


def test_the_joint_names_what_was_chosen(tmp_path: Path) -> None:
    joint = jid.Joint(name="elbow", inertia=1.5, model=jid.Model("auto"))
    found = jid.identify(recording(static=5.0), joint, search="separable")
    assert str(found.joint.model) == "stribeck:gravity=none"
    assert found.parameters["inertia"].value == 1.5
    joint.save(tmp_path / "joint.toml")
    assert jid.Joint.load(tmp_path / "joint.toml") == joint


def test_few_windows_leave_the_simplest_model() -> None:
    found = jid.identify(recording(static=5.0), windows=7, search="separable")
    assert found.settings["model"] == "coulomb_viscous"
    assert found.selection is not None
    assert found.selection.sentence == "coulomb_viscous: no other model could be compared"


def test_the_same_bits_for_any_number_of_threads() -> None:
    loaded = recording(static=5.0, gravity=4.0)
    found = [
        chosen(loaded, search=jid.Search("separable", threads=threads)) for threads in (1, 2, 5)
    ]
    assert found[0] == found[1] == found[2]


def test_blocks_are_compared_by_ratio_and_by_square() -> None:
    best = np.linspace(1.0, 1.2, 10)
    assert excess(best, best) == 0.0
    one_slow_block = best * np.array([1000.0, *np.full(9, 3.0)])
    assert excess(one_slow_block, best) > 2.0  # by its square alone it is 1: one block of ten
    assert abs(excess(best + np.tile([0.3, -0.3], 5), best)) < 1.0
    quiet = np.array([0.01] * 5 + [10.0] * 5)
    both_miss = quiet + np.array([-0.0099] * 5 + [3.0, 3.5, 4.0, 3.0, 3.5])
    assert excess(both_miss, quiet) > 2.0  # by its ratios alone it is better


def test_it_is_saved_and_read(home: jid.Estimate) -> None:
    document = json.loads(home.to_json())
    assert jid.Estimate.from_json(home.to_json()).selection == home.selection
    del document["selection"]
    assert jid.Estimate.from_json(json.dumps(document)).selection is None
    document["selection"] = {"model": "x", "runner_up": None, "candidates": [], "blocks": 2}
    with pytest.raises(jid.InputError, match=r"selection\.candidates"):
        jid.Estimate.from_json(json.dumps(document))


def test_what_needs_one_model_for_all_refuses_auto() -> None:
    with pytest.raises(jid.InputError, match="needs a name"):
        jid.compare_models(recording(), models=("auto", "stribeck"))
    with pytest.raises(jid.InputError, match="name the model"):
        jid.OnlineIdentifier(model="auto", window=2.0)
    with pytest.raises(jid.InputError, match="only identify can choose"):
        jid.sweep(recording(), grid={"model": ["auto"]}, trials=1)


def test_a_known_torque_contains_its_gravity() -> None:
    # Free gravity beside it fits the log better, with an inertia of 0 and an offset that gravity cancels.
    folder = data_folder()
    columns = {"coriolis": "model_coriolis_torque_Nm", "arm": "model_inertia_kgm2"}
    recording = jid.load(folder / "kr300_joint1.csv.gz", extra=columns)
    joint = jid.Joint(gear_ratio=256.86)
    estimate = jid.identify(recording, joint, terms={"coriolis": "known", "arm": "inertia"})
    assert "gravity_cos" not in estimate.parameters
    interval = estimate.parameters["viscous"].interval
    assert interval is not None
    lower, upper = interval
    assert lower < 2050.0 < upper
