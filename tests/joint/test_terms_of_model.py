"""The text of own terms: what it says, what it refuses, and that nothing is lost on the way."""

import copy
import pickle
from pathlib import Path
from typing import Any

import pytest

import jointid as jid
from jointid.base.errors import InputError
from jointid.joint.model import Model
from jointid.joint.own_terms import OwnTerms

TEXT = "stribeck:asymmetric:ripple=2,4:terms=q6=viscous@rate+coulomb@rate,tau_model=known"


def test_a_model_says_the_same_as_text_mapping_and_joint_file(tmp_path: Path) -> None:
    terms = {"q6": "viscous@rate+coulomb@rate", "tau_model": "known"}
    model = Model("stribeck", asymmetric=True, ripple=(2, 4), terms=terms)
    assert str(model) == TEXT
    assert Model.parse(TEXT) == model == eval(repr(model))
    assert (
        Model.of({"name": "stribeck", "asymmetric": True, "ripple": [2, 4], "terms": terms})
        == model
    )
    assert hash(Model.parse(TEXT)) == hash(model)
    assert pickle.loads(pickle.dumps(model)) == copy.deepcopy(model) == model
    assert model.terms == terms
    assert str(model.resolved) == TEXT
    joint = jid.Joint(model=model, gear_ratio=50.0)
    joint.save(tmp_path / "joint.toml")
    text = (tmp_path / "joint.toml").read_text(encoding="utf-8")
    assert '[model.terms]\nq6 = "viscous@rate+coulomb@rate"\ntau_model = "known"\n' in text
    assert jid.Joint.load(tmp_path / "joint.toml") == joint
    changed = joint.replace(model=model.replace(terms={"tau_model": "scaled"}))
    changed.save(tmp_path / "joint.toml")
    assert jid.Joint.load(tmp_path / "joint.toml") == changed


def test_a_list_of_kinds_and_a_centre() -> None:
    own = OwnTerms.of({"q2": ["torque_over(-0.35)", "viscous@rate"], "position": "inertia_over"})
    assert str(own) == "q2=torque_over(-0.35)+viscous@rate,position=inertia_over"
    assert OwnTerms.parse(str(own)) == own
    assert own.signals == ("q2",)
    assert own.keys_in_core == (
        *("torque_cos_of_q2", "torque_sin_of_q2", "viscous_of_q2_rate"),
        *("inertia_cos_of_position", "inertia_sin_of_position"),
    )
    wide = OwnTerms.of({"q2": "torque_over(123456)"})
    assert OwnTerms.parse(str(wide)) == wide
    assert Model("stribeck", terms={}).resolved == Model("stribeck").resolved
    assert Model.parse(":terms=none").terms == {}


def test_a_call_without_terms_has_the_joints() -> None:
    base = Model.parse(":terms=a=viscous")
    assert Model("stribeck").over(base).terms == {"a": "viscous"}
    assert Model(terms={"b": "known"}).over(base).terms == {"b": "known"}


@pytest.mark.parametrize(
    ("terms", "message"),
    [
        ({"q6": "viscos"}, "did you mean 'viscous'"),
        ({"q6": ""}, "no such kind"),
        ({"q6": "viscous@rat"}, "did you mean 'viscous@rate'"),
        ({"q6": 3}, "text like viscous"),
        ({"q6": []}, "text like viscous"),
        ({"q 6": "viscous"}, "letters, digits"),
        ({"6q": "viscous"}, "letters, digits"),
        ({"q6": "viscous+viscous"}, "viscous_of_q6 is given twice"),
        ({"q6": "viscous@rate", "q6_rate": "viscous"}, "viscous_of_q6_rate is given twice"),
        ({"q6": "inertia+inertia_own"}, "known_inertia_of_q6 is given twice"),
        ({"q6": "viscous(0.3)"}, "have a centre"),
        ({"q6": "torque_over(west)"}, "have a centre"),
        ({"position": "viscous"}, "own position"),
        ({"position": "torque_over@rate"}, "own position"),
        (["q6"], "mapping from signals"),
    ],
)
def test_bad_terms_are_refused(terms: Any, message: str) -> None:
    with pytest.raises(InputError, match=message):
        Model(terms=terms)


@pytest.mark.parametrize("text", [":terms=q6", ":terms=q6=viscous,q6=known", ":terms=q6=viscous,"])
def test_bad_text_is_refused(text: str) -> None:
    with pytest.raises(InputError):
        Model.parse(text)
