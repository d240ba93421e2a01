"""The separable method: by projection where that is certain, else from the compressed penalty."""

import numpy as np
import pytest
from example_recordings import WELL_EXCITED
from simulated_joint import simulate

import jointid as jid
from jointid.identification.search.run import Engine


@pytest.fixture(scope="module")
def run() -> jid.Recording:
    return simulate(1, duration=9.0, seed=5)[0]


@pytest.fixture(scope="module")
def well_excited() -> jid.Recording:
    return jid.load(WELL_EXCITED)


def values(estimate: jid.Estimate) -> dict[str, float]:
    return {name: parameter.value for name, parameter in estimate.parameters.items()}


@pytest.mark.parametrize("model", ["stribeck", "stribeck_general"])
@pytest.mark.parametrize("residual", ["instruments", "sensor", "torque"])
def test_projection_agrees_with_the_genetic_search(
    well_excited: jid.Recording, model: str, residual: str
) -> None:
    projected, genetic = (
        jid.identify(  # type: ignore[call-overload]
            well_excited,
            jid.thesis_joint(),
            model=jid.Model.parse(model),
            residual=residual,
            search=method,
        )
        for method in ("separable", "ga")
    )
    assert projected.status == "converged"
    assert projected.message.endswith("shapes, by projection")
    assert projected.penalty <= genetic.penalty * (1.0 + 1e-12)
    # The line search of the default knows a shape to about the root of the rounding of a value.
    assert values(projected) == pytest.approx(values(genetic), rel=1e-7)


def test_it_compresses_nothing(
    well_excited: jid.Recording, monkeypatch: pytest.MonkeyPatch
) -> None:
    def refused(*_: object) -> Engine:
        raise AssertionError("compressed")

    monkeypatch.setattr(Engine, "of", refused)
    estimate = jid.identify(well_excited, jid.thesis_joint(), search="separable")
    assert estimate.status == "converged"


@pytest.mark.parametrize(
    ("options", "reason"),
    [
        (
            {"parameters": {"stribeck": {"min": 1.0, "max": 20.0}}},
            "near the end of a shape's range",
        ),
        ({"parameters": {"static": {"max": 1e-3}}}, "hardly depends on the shapes"),
        ({"windows": 60}, "few windows"),
        ({"windows": "cumulative"}, "running sums"),
        ({"model": "stribeck:load_friction"}, "not linear"),
    ],
)
def test_what_projection_cannot_tell_is_compressed_and_said(
    well_excited: jid.Recording, options: dict[str, object], reason: str
) -> None:
    joint = jid.thesis_joint()
    estimate = jid.identify(well_excited, joint, search="separable", **options)  # type: ignore[call-overload]
    assert "not by projection: " in estimate.message
    assert reason in estimate.message
    genetic = jid.identify(well_excited, joint, search="ga", **options)  # type: ignore[call-overload]
    assert estimate.penalty <= genetic.penalty * (1.0 + 1e-6)


def test_without_a_shape_it_is_least_squares(well_excited: jid.Recording) -> None:
    fixed = {"stribeck": 100.0}
    estimate = jid.identify(well_excited, jid.thesis_joint(), parameters=fixed)
    assert estimate.message == "linear least squares, because the model has no free shape parameter"
    genetic = jid.identify(well_excited, jid.thesis_joint(), parameters=fixed, search="ga")
    assert estimate.penalty <= genetic.penalty * (1.0 + 1e-12)


@pytest.mark.parametrize("model", ["stribeck", "stribeck_general"])
def test_the_same_bits_for_any_number_of_threads(run: jid.Recording, model: str) -> None:
    found = [
        jid.identify(
            run,
            jid.thesis_joint(),
            model=jid.Model.parse(model),
            search=jid.Search("separable", threads=threads),
        )
        for threads in (1, 2, 5)
    ]
    assert "by projection" in found[0].message
    assert values(found[0]) == values(found[1]) == values(found[2])


def test_several_recordings_with_offsets_of_their_own(well_excited: jid.Recording) -> None:
    halves = list(well_excited.split(2))
    model = jid.Model(per_recording=("sensor_offset",))
    projected, genetic = (
        jid.identify(halves, jid.thesis_joint(), model=model, search=method)
        for method in ("separable", "ga")
    )
    assert "by projection" in projected.message
    assert values(projected) == pytest.approx(values(genetic), rel=1e-6)
    assert np.isfinite(projected.penalty)
