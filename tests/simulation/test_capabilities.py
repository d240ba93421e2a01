"""A term that a simulation or a controller does not have is refused by name, never dropped."""

from types import SimpleNamespace
from typing import Any

import pytest

import jointid as jid
from jointid import _core
from jointid.base.advice import Action
from jointid.simulation import plant
from jointid.simulation.terms import terms_of

FRICTION = {"coulomb": 4.0, "viscous": 1.0}
# Options that switch terms on, and values for their parameters.
OPTIONS: dict[str, tuple[dict[str, Any], dict[str, float]]] = {
    "gravity": ({"model": jid.Model(gravity="free")}, {"gravity_cos": 1.0, "gravity_sin": 0.5}),
    "torque_offset": ({}, {"torque_offset": 0.3}),
    "load_friction": ({"model": jid.Model(load_friction=True)}, {"load_friction": 0.1}),
    "harmonics": (
        {"model": jid.Model(harmonics=(3,))},
        {"position_cos_3": 0.1, "position_sin_3": 0.2},
    ),
    "ripple": (
        {"model": jid.Model(ripple=(2,)), "gear_ratio": 50.0},
        {"ripple_cos_2": 0.1, "ripple_sin_2": 0.2},
    ),
    "sensor": ({"sensor": True}, {"sensor_gain": 2.0, "sensor_offset": 1.0}),
}


def joint(option: str | None = None, **changes: Any) -> jid.Joint:
    fields, values = OPTIONS[option] if option is not None else ({}, {})
    return jid.Joint(inertia=2.0, **fields, **changes).with_parameters(FRICTION | values)


def drag(**changes: Any) -> Any:
    """A term as the core would give it if somebody added the row and nothing else."""
    row = {
        "key": "drag",
        "name": "drag",
        "meaning": "quadratic drag",
        "option": "name",
        "shapes": [],
        "family": False,
        "friction": False,
        "simulated": False,
        "control": _core.Control.refused,
    }
    return SimpleNamespace(**row | changes)


def with_term(monkeypatch: pytest.MonkeyPatch, term: Any) -> None:
    monkeypatch.setattr(plant, "terms_of", lambda joint: (*terms_of(joint), term))


def run(subject: jid.Joint) -> jid.Recording:
    return jid.simulate(subject, jid.OpenLoop(), jid.Trajectory.step(1.0, duration=0.01))


def test_a_joint_has_the_terms_of_its_model_and_options() -> None:
    keys = [term.key for term in terms_of(joint())]
    assert keys == ["inertia", "coulomb", "viscous"]
    for option in OPTIONS:
        added = {term.key for term in terms_of(joint(option))} - set(keys)
        # Load friction has a row for each definition of the load, of which a joint has one.
        rows = {term.key for term in _core.terms() if term.option == option}
        assert added == rows - {"load_friction_link"}, option
    apart = [term.key for term in terms_of(jid.Joint(model=jid.Model("stribeck", asymmetric=True)))]
    assert apart[1:3] == ["coulomb_positive", "coulomb_negative"]
    assert len(apart) == 7


def test_every_option_of_the_table_is_known_to_a_joint() -> None:
    # Own terms need signals that a simulation does not have: refused, see test_own_terms.py.
    assert {term.option for term in _core.terms()} == {"", "name", "terms", *OPTIONS}


@pytest.mark.parametrize("option", OPTIONS)
def test_what_is_said_to_be_simulated_is_simulated(option: str) -> None:
    found = run(joint(option)).truth
    assert found is not None
    assert set(OPTIONS[option][1]) <= set(found)


def test_a_term_that_cannot_be_simulated_is_named(monkeypatch: pytest.MonkeyPatch) -> None:
    with_term(monkeypatch, drag())
    with pytest.raises(jid.InputError, match="a simulation does not have the term 'drag'") as error:
        run(joint())
    assert (error.value.argument, error.value.value) == ("model", "coulomb_viscous")
    with_term(monkeypatch, drag(option="load_friction"))
    with pytest.raises(jid.InputError, match="set the joint with model=':load_friction=false'"):
        run(joint())


def test_a_term_that_a_controller_does_not_have_is_named(monkeypatch: pytest.MonkeyPatch) -> None:
    with_term(monkeypatch, drag(simulated=True))
    with pytest.raises(jid.InputError, match="do not compensate the term 'drag', quadratic drag"):
        jid.control_estimates(joint())
    with_term(monkeypatch, drag(control=_core.Control.feedback))
    assert "drag" not in jid.control_estimates(joint())


def test_a_capability_without_its_arithmetic_stops(monkeypatch: pytest.MonkeyPatch) -> None:
    with_term(monkeypatch, drag(simulated=True, control=_core.Control.compensated))
    for use in (run, jid.control_estimates):
        with pytest.raises(NotImplementedError, match="'drag' is not used"):
            use(joint())


def test_a_controller_refuses_friction_that_it_does_not_have() -> None:
    with pytest.raises(jid.InputError, match="'load_friction'") as error:
        jid.control_estimates(joint("load_friction"))
    assert error.value.argument == "load_friction"
    (remedy,) = error.value.remedy
    assert isinstance(remedy, Action)
    assert remedy.arguments == {"model": ":load_friction=false"}
    for option in set(OPTIONS) - {"load_friction"}:  # known, and left to the feedback
        assert jid.control_estimates(joint(option))["coulomb"] == 4.0


@pytest.mark.parametrize("option", ["gravity", "load_friction", "harmonics", "ripple"])
def test_the_advice_for_a_simulation_can_be_obeyed(
    option: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(
        plant,
        "terms_of",
        lambda made: tuple(
            drag(option=term.option) if term.option == option else term for term in terms_of(made)
        ),
    )
    subject = joint(option)
    with pytest.raises(jid.InputError, match="'drag'") as error:
        run(subject)
    (remedy,) = error.value.remedy
    assert isinstance(remedy, Action)
    assert remedy.function == "Joint"
    run(subject.replace(**remedy.arguments))


def test_the_advice_for_a_controller_can_be_obeyed() -> None:
    subject = joint("load_friction", gear_ratio=50.0)
    subject = subject.replace(model=subject.model.replace(ripple=(2,)))
    recording = jid.simulate(
        subject.with_parameters(OPTIONS["ripple"][1]),
        jid.Pd(stiffness=300.0, damping=20.0),
        jid.Trajectory.thesis(0.5, cycle=2.0, duration=4.0),
        seed=0,
    )
    with pytest.raises(jid.InputError) as error:
        jid.control_estimates(subject)
    (remedy,) = error.value.remedy
    assert isinstance(remedy, Action)
    assert remedy.function == "identify"
    found = jid.identify(recording, subject, search="separable", **remedy.arguments)
    assert found.settings["model"] == "coulomb_viscous:ripple=2"
    assert "coulomb" in jid.control_estimates(found.joint)


def test_the_capabilities_of_the_terms_of_today() -> None:
    """A change of one is a decision; a term of tomorrow needs no line here."""
    general = {f"static_general{side}" for side in ("", "_positive", "_negative")}
    sides = [f"{name}{side}" for name in FRICTION for side in ("", "_positive", "_negative")]
    decided = {
        _core.Control.refused: {"load_friction", *general},
        _core.Control.compensated: {"inertia", *sides, "sensor_gain", "sensor_offset"},
    }
    for control, keys in decided.items():
        assert {_core.term(key).control for key in keys} == {control}
        assert all(_core.term(key).simulated for key in keys)
    left = [t for t in _core.terms() if t.option in {*OPTIONS} - {"load_friction", "sensor"}]
    assert {(t.control, t.simulated) for t in left} == {(_core.Control.feedback, True)}
