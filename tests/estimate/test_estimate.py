"""What an estimate offers: JSON, notebook, friction map with its band, joint file, report, pictures."""

import dataclasses
import json
from pathlib import Path

import matplotlib
import numpy as np
import pytest
from example_recordings import WELL_EXCITED

import jointid as jid
from jointid.cli.demonstration import data_folder

matplotlib.use("Agg")


@pytest.fixture(scope="module")
def estimate() -> jid.Estimate:
    recording = jid.load(WELL_EXCITED)
    return jid.identify(
        recording, jid.thesis_joint(), search=jid.Search(ga=jid.GaOptions(generations=30))
    )


@pytest.fixture(scope="module")
def robot() -> jid.Estimate:
    recording = jid.load(data_folder() / "kr300_joint1.csv.gz")
    joint = jid.Joint.load(data_folder() / "kr300_joint1.toml")
    return jid.identify(recording, joint, search="separable")


def test_json_holds_everything(estimate: jid.Estimate) -> None:
    again = jid.Estimate.from_json(estimate.to_json())
    for item in dataclasses.fields(jid.Estimate):
        before, after = getattr(estimate, item.name), getattr(again, item.name)
        if isinstance(before, np.ndarray):
            assert np.array_equal(before, after), item.name
        elif dataclasses.is_dataclass(before) and item.name in ("windows", "convergence"):
            for part in dataclasses.fields(before):
                assert np.array_equal(getattr(before, part.name), getattr(after, part.name)), (
                    part.name
                )
        elif item.name == "follow_up":
            assert before is not None
            assert after is None
        else:
            assert before == after, item.name
    assert again.report(verbose=True) == estimate.report(verbose=True)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("{", "not JSON"),
        ("[]", "not a jointid estimate"),
        ('{"kind": "jointid estimate", "schema": 99}', "99"),
        ('{"kind": "jointid estimate", "schema": 1}', "parameters: this is missing"),
    ],
)
def test_json_that_is_none_is_refused(text: str, message: str) -> None:
    with pytest.raises(jid.InputError, match=message):
        jid.Estimate.from_json(text)


def test_report_shows_values_and_warnings(estimate: jid.Estimate, robot: jid.Estimate) -> None:
    text = estimate.report(verbose=True)
    for name in estimate.parameters:
        assert name in text
    assert "no warnings" in text
    assert "inertia_varies" in robot.report(verbose=True)
    assert "coulomb" in robot._repr_html_()


def test_friction_is_the_model_and_odd(estimate: jid.Estimate) -> None:
    value = {name: p.value for name, p in estimate.parameters.items()}
    velocity = np.linspace(-3.0, 3.0, 61)
    expected = (
        value["coulomb"] + value["static"] * np.exp(-value["stribeck"] * velocity**2)
    ) * np.sign(velocity) + value["viscous"] * velocity
    curve = estimate.friction(velocity)
    np.testing.assert_allclose(curve.torque, expected, rtol=1e-12, atol=1e-12)
    np.testing.assert_allclose(np.asarray(curve), -np.asarray(estimate.friction(-velocity)))
    assert np.all(curve.lower <= curve.torque)
    assert np.all(curve.torque <= curve.upper)


def test_friction_band_is_the_interval_of_a_single_parameter(estimate: jid.Estimate) -> None:
    # Far above the Stribeck velocity, df/dviscous = v dominates once coulomb is fixed.
    recording = jid.load(WELL_EXCITED)
    fixed = {name: p.value for name, p in estimate.parameters.items() if name != "viscous"}
    single = jid.identify(recording, jid.thesis_joint(), parameters=fixed, search="separable")
    curve = single.friction(2.0)
    interval = single.parameters["viscous"].interval
    assert interval is not None
    assert curve.upper[0] - curve.lower[0] == pytest.approx(
        2.0 * (interval[1] - interval[0]), rel=1e-6
    )


def test_friction_of_each_recording_for_itself_is_their_mean() -> None:
    run = jid.load(data_folder() / "kr300_joint1.csv.gz")
    joint = jid.Joint.load(data_folder() / "kr300_joint1.toml")
    runs = [run.crop(0.0, 5.0), run.crop(5.0, 10.0)]
    model = jid.Model(per_recording=("coulomb",))
    own = jid.identify(runs, joint, model=model, search="separable")
    first, second = (own.parameters[f"coulomb[{i}]"].value for i in (0, 1))
    expected = 0.5 * (first + second) + own.parameters["viscous"].value * 0.3
    assert own.friction([0.3]).torque[0] == pytest.approx(expected)
    assert jid.Estimate.from_json(own.to_json()).friction([0.3]).upper[0] > expected


def test_saving_into_a_joint_file_keeps_what_was_there(robot: jid.Estimate, tmp_path: Path) -> None:
    path = tmp_path / "joint.toml"
    path.write_text((data_folder() / "kr300_joint1.toml").read_text())
    robot.save(path)
    joint = jid.Joint.load(path)
    assert joint.parameters["viscous"].value == robot.parameters["viscous"].value
    assert joint.gear_ratio == 256.86
    assert path.read_text().startswith("# Joint 1 of a KUKA")
    recording = jid.load(data_folder() / "kr300_joint1.csv.gz")
    again = jid.identify(recording, joint, search="separable")
    assert again.parameters["viscous"].value == pytest.approx(
        robot.parameters["viscous"].value, rel=1e-9
    )


def test_saving_as_json_reads_back(robot: jid.Estimate, tmp_path: Path) -> None:
    robot.save(tmp_path / "estimate.json")
    text = (tmp_path / "estimate.json").read_text()
    assert json.loads(text)["kind"] == "jointid estimate"
    assert jid.Estimate.from_json(text).penalty == robot.penalty
    with pytest.raises(jid.InputError, match="pdf"):
        robot.save(tmp_path / "estimate.pdf")


def test_joint_of_an_estimate_without_a_joint_identifies_again() -> None:
    time = np.arange(0.0, 10.0, 2e-3)
    position = np.sin(1.7 * time) + 0.4 * np.sin(4.1 * time)
    velocity = 1.7 * np.cos(1.7 * time) + 1.64 * np.cos(4.1 * time)
    acceleration = -2.89 * np.sin(1.7 * time) - 6.724 * np.sin(4.1 * time)
    torque = 0.5 * acceleration + 2.0 * np.sign(velocity) + 3.0 * velocity - 0.7
    recording = jid.Recording(time=time, position=position, velocity=velocity, torque=torque)
    first = jid.identify(recording)
    second = jid.identify(recording, first.joint, search="separable")
    for name, truth in {
        "inertia": 0.5,
        "coulomb": 2.0,
        "viscous": 3.0,
        "torque_offset": -0.7,
    }.items():
        assert first.parameters[name].value == pytest.approx(truth, rel=2e-3), name
        assert second.parameters[name].value == pytest.approx(
            first.parameters[name].value, rel=1e-6
        )


def test_every_plot_draws_into_given_axes(estimate: jid.Estimate) -> None:
    from matplotlib import pyplot

    figure, axes = pyplot.subplots(4, 1)
    recording = jid.load(WELL_EXCITED)
    drawn = [
        jid.plot.friction_map(recording, estimate, axes[0]),
        jid.plot.window_means(estimate, axes[1]),
        jid.plot.residuals(estimate, axes[2]),
        jid.plot.convergence(estimate, axes[3]),
    ]
    assert [a is b for a, b in zip(drawn, axes, strict=True)] == [True] * 4
    for a in axes:
        assert "[" in a.get_xlabel() or a.get_xlabel() == "generation"
        assert "[" in a.get_ylabel()
    pyplot.close(figure)
    own = jid.plot.friction_map(None, estimate)
    assert own.figure is not figure
    pyplot.close("all")


def test_convergence_needs_a_genetic_search(robot: jid.Estimate) -> None:
    with pytest.raises(ValueError, match="without a genetic search"):
        jid.plot.convergence(robot)


def test_holds_no_view_of_what_it_was_made_from(estimate: jid.Estimate) -> None:
    # A view of one column would keep the whole penalty, as large as the recording.
    for field in dataclasses.fields(estimate.windows):
        assert getattr(estimate.windows, field.name).base is None, field.name
