"""Changes of values in words: no share of a value near zero, and of a wrong scale both readings."""

import dataclasses
import re

import pytest
from example_recordings import WELL_EXCITED

import jointid as jid
from jointid.estimate.causes import Cause
from jointid.estimate.findings import TITLE
from jointid.estimate.statistics import ParameterEstimate
from jointid.identification.causes.changes import from_to
from jointid.identification.causes.families import BY_NAME


@pytest.fixture(scope="module")
def recording() -> jid.Recording:
    """The torque and the position, and nothing else."""
    full = jid.load(WELL_EXCITED)
    return jid.Recording(time=full.time, position=full.position, torque=full.torque)


def estimated(value: float, error: float = 0.1, at_bound: str | None = None) -> ParameterEstimate:
    return ParameterEstimate(
        name="coulomb",
        meaning="",
        unit="N·m",
        value=value,
        stderr=error,
        interval=(value - 2.0 * error, value + 2.0 * error),
        min=0.0,
        max=10.0,
        vary=True,
        at_bound=at_bound,
        shift_halved=None,
        shift_doubled=None,
    )


@pytest.mark.parametrize(
    ("parameter", "words"),
    [
        (estimated(1e-18, at_bound="min"), "from 0 to 0.5 N·m"),
        (estimated(0.05), "from 0.05 to 0.55 N·m"),
        (estimated(0.04, error=0.001), "from 0.04 to 0.54 N·m"),
    ],
    ids=["at its bound", "less than its error", "more than ten times"],
)
def test_a_change_of_a_value_near_zero_is_no_share(
    parameter: ParameterEstimate, words: str
) -> None:
    assert parameter.stderr is not None
    share = 0.5 / parameter.value
    found = from_to(
        {"coulomb": parameter}, {"coulomb": 0.5}, {"coulomb": share}, {"coulomb": parameter.stderr}
    )
    assert found == {"coulomb": words}
    cause = Cause(
        name="gravity", share=0.8, scale=0.1, relative={"coulomb": share}, near_zero=found
    )
    assert f"coulomb {words}" in cause.title
    assert "%" not in cause.title


def test_a_title_has_the_changes_that_fit_into_a_line_and_the_details_have_all() -> None:
    cause = Cause(
        name="inertia_varies",
        meaning=BY_NAME["inertia_varies"].meaning,
        detail="2 × angle",
        size="±18 %",
        share=0.9,
        scale=0.1,
        relative={"gravity_cos": -1.01, "inertia": 0.18},
        near_zero={"gravity_cos": "from 4.56 to -0.0558 N·m"},
    )
    assert cause.title.endswith("(2 × angle, ±18 %): with it, inertia +18 %")
    assert len(cause.title) <= TITLE
    assert "gravity_cos changes from 4.56 to -0.0558 N·m, inertia by +18 %" in cause.details
    short = dataclasses.replace(cause, near_zero={}, relative={"inertia": 0.18})
    assert short.title == cause.title
    assert "inertia" not in short.details  # it is not said twice


def test_a_change_of_a_known_value_is_a_share() -> None:
    assert not from_to(
        {"coulomb": estimated(2.0)}, {"coulomb": 0.5}, {"coulomb": 0.25}, {"coulomb": 0.1}
    )


def test_what_was_taken_away_had_changed_the_value_before() -> None:
    found = from_to(
        {"coulomb": estimated(0.05)},
        {"coulomb": 0.5},
        {"coulomb": 10.0},
        {"coulomb": 0.1},
        before=True,
    )
    assert found == {"coulomb": "from -0.45 to 0.05 N·m"}


def test_a_wrong_inertia_is_told_with_what_it_did_to_the_friction(recording: jid.Recording) -> None:
    """Without the given inertia the friction hardly changes; if the torque is wrong, all of it does."""
    model = jid.Model("stribeck", gravity="free")
    free = jid.identify(recording, model=model).parameters
    given = 1.04 * free["inertia"].value
    wrong = jid.identify(
        recording, model=model, parameters={"inertia": {"value": given, "vary": False}}
    )
    cause = next(each for each in wrong.causes().found if each.name == "wrong_scale")
    text = str(cause)
    shown = re.search(r"with the inertia that fits the torque \((\S+) kg·m²\)", text)
    assert shown is not None
    assert float(shown[1]) == pytest.approx(free["inertia"].value, rel=5e-3)
    moved = re.search(r"coulomb (?:changes )?by ([+−])(\S+) %", text)
    assert moved is not None
    truth = free["coulomb"].value / wrong.parameters["coulomb"].value - 1.0
    assert abs(float(moved[2]) / 100.0 - abs(truth)) < 5e-3
    assert "if the torque is wrong instead, the friction changes by +4 %" in text


def test_an_inertia_at_its_bound_was_not_given(recording: jid.Recording) -> None:
    inertia = (
        jid.identify(recording, model=jid.Model("stribeck", gravity="free"))
        .parameters["inertia"]
        .value
    )
    held = jid.identify(
        recording,
        model=jid.Model("stribeck", gravity="free"),
        parameters={"inertia": {"max": 0.95 * inertia}},
    )
    assert held.parameters["inertia"].at_bound == "max"
    assert "wrong_scale" not in held.causes().tried


def test_the_table_has_the_bound_and_not_what_rounding_left_of_it() -> None:
    assert estimated(2.7e-17, at_bound="min").shown_value == 0.0
    assert estimated(2.7e-17).shown_value == 2.7e-17
