"""The search domain: bounds that cannot be used are refused, and every shape has bounds from the data."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest

import jointid as jid
from jointid import _core
from jointid.base.advice import Action
from jointid.identification.search.computed_bounds import shape_bounds

TIME = np.arange(0.0, 2.0, 0.002)
MOTION: dict[str, Any] = {"time": TIME, "position": np.sin(7.0 * TIME)}
PLAIN = jid.Recording(**MOTION, torque=np.cos(7.0 * TIME))


def refused(*arguments: Any, **keywords: Any) -> jid.InputError:
    with pytest.raises(jid.InputError) as caught:
        jid.identify(*arguments, **keywords)
    return caught.value


def test_every_shape_of_the_core_has_bounds() -> None:
    for shape in _core.shapes():
        low, high = shape_bounds(shape.name, 2.0)
        assert 0.0 <= low < high
        assert low > 0.0 or shape.name in ("load_friction", "link_share")  # a joint may have none
    with pytest.raises(ValueError, match="'viscous'"):
        shape_bounds("viscous", 2.0)


@pytest.mark.parametrize(
    ("parameters", "argument", "reason", "remedy"),
    [
        (
            {"static_positive": 1.0},
            "static_positive",
            "this identification has no such parameter; its",
            None,
        ),
        ({"coulomb": {"min": 2.0, "max": 2.0}}, "coulomb", "min 2 is not below its max 2", "widen"),
        ({"coulomb": {"min": 2.0, "max": 1.0}}, "min", "above max", "swap"),
    ],
)
def test_parameters_that_cannot_be_used(
    parameters: dict[str, Any], argument: str, reason: str, remedy: str | None
) -> None:
    error = refused(PLAIN, parameters=parameters)
    assert error.argument == argument
    assert reason in error.reason
    assert error.place in ("parameters", "parameter 'coulomb'")
    assert remedy is None or str(error.remedy[0]).startswith(remedy)


def test_parameters_are_a_mapping() -> None:
    error = refused(PLAIN, parameters=[("coulomb", 1.0)])
    assert error.argument == "parameters"
    assert error.reason == "a mapping from names to values is expected"


def test_something_is_left_to_identify() -> None:
    fixed = dict.fromkeys(("inertia", "coulomb", "viscous", "torque_offset"), 1.0)
    error = refused(PLAIN, model="coulomb_viscous", parameters=fixed)
    assert error.argument == "parameters"
    assert "leave at least one free" in error.reason


def test_a_term_that_the_motion_does_not_excite() -> None:
    forwards = jid.Recording(
        time=TIME, position=7.0 * TIME + 0.1 * np.sin(7.0 * TIME), torque=2.0 + np.cos(7.0 * TIME)
    )
    error = refused(forwards, model=":asymmetric")
    name = "coulomb_negative"
    assert (error.argument, error.place) == (name, "parameters")
    assert error.remedy == (Action("call", {"parameters": {name: ...}}, text="which fixes it"),)
    assert str(error).endswith(f"identify with parameters={{'{name}': ...}} (which fixes it)")
    fixed = {f"{term}_negative": 0.0 for term in ("coulomb", "viscous")}
    jid.identify(
        forwards, model=jid.Model.parse(":asymmetric"), parameters=fixed, search="separable"
    )


def test_signals_without_information() -> None:
    silent = jid.Recording(**MOTION, torque=np.zeros(TIME.size))
    assert refused(silent).argument == "torque"
    constant = jid.Recording(**MOTION, torque=np.cos(7.0 * TIME), sensor=np.ones(TIME.size))
    error = refused(constant)
    assert (error.argument, error.place) == ("sensor", "recording")
    assert "never changes" in error.reason


def test_a_gain_of_zero(repo: Path) -> None:
    recording = jid.load(repo / "examples" / "data" / "well_excited.csv.gz").crop(0.0, 3.0)
    error = refused(recording, jid.thesis_joint(), parameters={"sensor_gain": {"min": -1.0}})
    assert (error.argument, error.place) == ("sensor_gain", "parameters")
    assert "-1 to 5, contain 0" in error.reason
    call = error.remedy[-1]
    assert isinstance(call, Action)
    assert dict(call.arguments) == {"residual": "torque"}
    jid.identify(
        recording,
        jid.thesis_joint(),
        parameters={"sensor_gain": {"min": -1.0}},
        search="separable",
        **call.arguments,
    )


def test_a_checkpoint_is_refused_before_the_search(tmp_path: Path) -> None:
    nowhere = tmp_path / "nowhere" / "search.state"
    error = refused(PLAIN, search=jid.Search(checkpoint=nowhere))
    assert (error.argument, error.value) == ("checkpoint", str(nowhere))
    error = refused(PLAIN, search=jid.Search(resume=nowhere))
    assert (error.argument, error.place) == ("resume", str(nowhere))
    foreign = tmp_path / "README.md"
    foreign.write_text("not a checkpoint")
    error = refused(PLAIN, search=jid.Search(resume=foreign))
    assert (error.argument, error.place) == ("resume", str(foreign))
    assert "not a checkpoint file" in error.reason


def test_an_error_in_the_callback_is_not_bad_input() -> None:
    def broken(_: jid.Generation) -> None:
        raise ValueError("the user's own")

    with pytest.raises(ValueError, match="the user's own") as caught:
        jid.identify(PLAIN, search=jid.Search(callback=broken))
    assert not isinstance(caught.value, jid.InputError)
