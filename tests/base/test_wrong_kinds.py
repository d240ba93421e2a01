"""Arguments of the wrong kind raise an error of one sentence with the value and what is expected."""

from collections.abc import Callable
from typing import Any

import pytest
from example_recordings import WELL_EXCITED as PATH

import jointid as jid
from jointid.report.saving import save_report

JOINT = jid.thesis_joint()
GRID = {"windows": [100]}


@pytest.fixture(scope="module")
def run() -> jid.Recording:
    return jid.load(PATH)


@pytest.fixture(scope="module")
def estimate(run: jid.Recording) -> jid.Estimate:
    return jid.identify(run, JOINT)


def message_of(call: Callable[[], Any]) -> str:
    with pytest.raises(jid.InputError) as refused:
        call()
    sentence = str(refused.value)
    assert "\n" not in sentence
    return sentence


@pytest.mark.parametrize("wrong", [["coulomb"], "coulomb", 5])
def test_mappings(run: jid.Recording, wrong: Any) -> None:
    shown = repr(wrong)
    for name, call in (
        ("parameters", lambda: jid.identify(run, JOINT, parameters=wrong)),
        ("columns", lambda: jid.load(PATH, columns=wrong)),
        ("units", lambda: jid.load(PATH, units=wrong)),
        ("scale", lambda: jid.load(PATH, scale=wrong)),
        ("where", lambda: jid.load(PATH, where=wrong)),
        ("values", lambda: JOINT.with_parameters(wrong)),
        ("parameters", lambda: jid.sweep(run, JOINT, grid=GRID, parameters=wrong)),
        ("parameters", lambda: jid.sweep(run, JOINT, grid={"parameters": {"a": wrong}})),
        ("truth", lambda: jid.sweep(run, JOINT, grid=GRID, truth=wrong)),
    ):
        assert message_of(call).startswith(f"{name} is {shown}: a mapping"), name


def test_parameters_as_a_list_of_a_grid(run: jid.Recording) -> None:
    assert message_of(lambda: jid.sweep(run, JOINT, grid={"parameters": [1]})).startswith(
        "parameters is 1: a mapping"
    )


def test_swept_parameters_are_laid_over_the_studys(run: jid.Recording) -> None:
    study = jid.sweep(
        run,
        JOINT,
        grid={"parameters": {"free": None, "fixed": {"viscous": 21.0}}},
        parameters={"coulomb": 24.0},
        trials=1,
    )
    assert [row.values["coulomb"] for row in study.rows] == [24.0, 24.0]
    free, fixed = (row.values["viscous"] for row in study.rows)
    assert (free != 21.0, fixed) == (True, 21.0)


@pytest.mark.parametrize("wrong", [5, None, b"run.csv"])
def test_names_of_files(run: jid.Recording, estimate: jid.Estimate, wrong: Any) -> None:
    for call in (
        lambda: jid.load(wrong),
        lambda: jid.load_runs(wrong, by=0),
        lambda: run.save(wrong),
        lambda: jid.Joint.load(wrong),
        lambda: JOINT.save(wrong),
        lambda: estimate.save(wrong),
        lambda: save_report(estimate, wrong),
        lambda: jid.Study.load(wrong),
    ):
        assert message_of(call) == f"path is {wrong!r}: the name of a file is expected".replace(
            repr(b"run.csv"), "a bytes"
        )


@pytest.mark.parametrize("name", ["checkpoint", "resume"])
def test_names_of_a_searchs_files(run: jid.Recording, name: str) -> None:
    given: dict[str, Any] = {name: 5}
    assert message_of(lambda: jid.identify(run, JOINT, search=jid.Search(**given))).startswith(
        f"{name} is 5: the name"
    )


def test_one_for_the_other(run: jid.Recording, estimate: jid.Estimate) -> None:
    wrong: Any = run
    swapped: Any = estimate
    assert (
        message_of(lambda: jid.control_estimates(wrong))
        == "joint is a Recording: a Joint is expected"
    )
    assert message_of(lambda: jid.plot.friction_map(swapped, wrong)) == (
        "recording is an Estimate: a Recording is expected"
    )
    for call in (
        lambda: jid.plot.friction_map(run, wrong),
        lambda: jid.plot.tracking_error(swapped),
        lambda: jid.plot.signal({"run": swapped}, "torque"),
        lambda: jid.plot.sensitivity(wrong, "coulomb"),
        lambda: jid.plot.torque_over_velocity(swapped),
        lambda: jid.plot.friction_curves(wrong),
        lambda: jid.plot.friction_curves({"run": wrong}),
        lambda: jid.plot.sweep(wrong),
        lambda: estimate.predict(swapped),
        lambda: jid.compare_models(run, JOINT, models=5),  # type: ignore[call-overload]
        lambda: jid.compare_models(run, "joint.toml"),  # type: ignore[call-overload]
        lambda: jid.Estimate.from_json(5),  # type: ignore[arg-type]
    ):
        assert "expected" in message_of(call)


@pytest.mark.parametrize("wrong", ["sensor_offset", 5])
def test_per_recording_is_a_list(run: jid.Recording, wrong: Any) -> None:
    sentence = message_of(
        lambda: jid.identify([run, run], JOINT, model=jid.Model(per_recording=wrong))
    )
    assert sentence == (
        f"per_recording is {wrong!r}: a list of coefficients like [sensor_offset] is expected"
    )


def test_an_unknown_truth_is_not_passed_over(run: jid.Recording) -> None:
    sentence = message_of(lambda: jid.sweep(run, JOINT, grid=GRID, trials=1, truth={"colomb": 3.0}))
    assert sentence == "truth: colomb: there is no such parameter; did you mean 'coulomb'?"


@pytest.mark.parametrize("wrong", [None, 3])
def test_a_model_is_parsed_from_text(wrong: Any) -> None:
    sentence = message_of(lambda: jid.Model.parse(wrong))
    assert sentence == f"model is {wrong}: text is expected, like stribeck:ripple=2,4"


def test_friction_at_what_is_no_number(estimate: jid.Estimate) -> None:
    wrong: Any = "a"
    assert message_of(lambda: estimate.friction(wrong)) == "velocity is 'a': numbers are expected"
    assert message_of(lambda: estimate.friction(1.0, load=wrong)) == (
        "load is 'a': a number is expected"
    )


@pytest.mark.parametrize("wrong", [10**400, [0.0, 10**400], "fast", [None, [1]]])
def test_numbers_that_no_array_holds(estimate: jid.Estimate, wrong: Any) -> None:
    for call in (
        lambda: estimate.friction(wrong),
        lambda: jid.Trajectory.thesis().sample(wrong),
        lambda: jid.Trajectory.from_samples(time=wrong, position=[0.0, 1.0]),
        lambda: jid.load(PATH, gear_ratio=wrong),
    ):
        message_of(call)
