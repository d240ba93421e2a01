"""The one value of a model: what is written reads back, what is nonsense is refused, everywhere alike."""

import pickle
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from jointid import _core
from jointid.base.errors import InputError
from jointid.joint.model import FIELDS, Model, ResolvedModel


@pytest.mark.parametrize(
    ("model", "text"),
    [
        (Model("stribeck"), "stribeck"),
        (Model("coulomb_viscous", asymmetric=True), "coulomb_viscous:asymmetric"),
        (Model("stribeck", ripple=(2, 4), asymmetric=True), "stribeck:asymmetric:ripple=2,4"),
        (Model("stribeck", asymmetric=False), "stribeck:asymmetric=false"),
        (Model("stribeck", load_friction="link"), "stribeck:load_friction=link"),
        (Model(ripple=()), ":ripple=none"),
        (Model(gravity="free"), ":gravity=free"),
        (
            Model("stribeck", per_recording=("torque_offset",)),
            "stribeck:per_recording=torque_offset",
        ),
        (Model("stribeck", harmonics=(0.5,)), "stribeck:harmonics=0.5"),
        (Model(), ""),
    ],
)
def test_a_model_is_its_text(model: Model, text: str) -> None:
    assert str(model) == text
    assert Model.parse(text) == model
    assert hash(Model.parse(text)) == hash(model)
    assert Model.of(text) == Model.of(model) == Model.of(model.stated()) == model
    assert pickle.loads(pickle.dumps(model)) == model


ORDERS = st.lists(
    st.integers(1, 64) | st.sampled_from([0.5, 1.5, 2.25]), max_size=3, unique=True
).map(tuple)
COEFFICIENTS = st.lists(
    st.sampled_from(["torque_offset", "sensor_offset", "coulomb"]), max_size=2, unique=True
).map(tuple)
MODELS = st.builds(
    Model,
    st.none() | st.sampled_from(_core.model_names()),
    gravity=st.none() | st.just("none"),
    asymmetric=st.none() | st.booleans(),
    ripple=st.none() | ORDERS,
    harmonics=st.none() | ORDERS,
    load_friction=st.none() | st.booleans(),
    per_recording=st.none() | COEFFICIENTS,
)


@given(model=MODELS)
def test_every_model_reads_back(model: Model) -> None:
    assert Model.parse(str(model)) == model
    assert eval(repr(model), {"Model": Model}) == model


@given(text=st.text(alphabet="stribeck:=,.1-_ \n\u00e9", max_size=20) | st.text(max_size=20))
def test_any_text_is_a_model_or_refused(text: str) -> None:
    try:
        model = Model.parse(text)
    except InputError:
        return  # a sentence; anything else fails the test
    assert Model.parse(str(model)) == model


@given(above=MODELS, below=MODELS)
def test_a_model_goes_over_another_field_by_field(above: Model, below: Model) -> None:
    merged = above.over(below)
    for name in FIELDS:
        own = getattr(above, name)
        assert getattr(merged, name) == (getattr(below, name) if own is None else own)


@given(model=MODELS)
def test_a_resolved_model_leaves_nothing_open(model: Model) -> None:
    resolved = model.resolved
    assert all(getattr(resolved, name) is not None for name in FIELDS)
    assert Model.parse(str(resolved)).resolved == resolved
    assert Model().resolved == ResolvedModel()


@pytest.mark.parametrize(
    ("fields", "argument"),
    [
        ({"name": "strybeck"}, "name"),
        ({"name": 5}, "name"),
        ({"gravity": "yes"}, "gravity"),
        ({"asymmetric": 1}, "asymmetric"),
        ({"load_friction": "no"}, "load_friction"),
        ({"ripple": True}, "ripple"),
        ({"ripple": "2"}, "ripple"),
        ({"ripple": {2: 1}}, "ripple"),
        ({"ripple": [0]}, "ripple"),
        ({"ripple": [2, 2.0]}, "ripple"),
        ({"ripple": [float("nan")]}, "ripple"),
        ({"ripple": [2.0000001]}, "ripple"),
        ({"harmonics": [True]}, "harmonics"),
        ({"harmonics": [1], "gravity": "free"}, "harmonics"),
        ({"per_recording": "torque_offset"}, "per_recording"),
        ({"per_recording": ["nonsense"]}, "per_recording"),
        ({"per_recording": ["stribeck"]}, "per_recording"),
        ({"per_recording": ["torque_offset[1]"]}, "per_recording"),
        ({"per_recording": ["coulomb", "coulomb"]}, "per_recording"),
        ({"nonsense": True}, "nonsense"),
    ],
)
def test_what_cannot_be_is_refused(fields: dict[str, Any], argument: str) -> None:
    with pytest.raises(InputError) as refused:
        Model.of(fields)
    assert refused.value.argument == argument


@pytest.mark.parametrize(
    "text",
    ["stribeck:", "stribeck:=2", "stribeck:ripple=", "stribeck:ripple=2:ripple=3", "a:name=b"],
)
def test_a_text_that_says_nothing_is_refused(text: str) -> None:
    with pytest.raises(InputError):
        Model.parse(text)


DIGITS = ["9" * 400, "-" + "9" * 400, "9" * 5000, "1_0", "2_5.0"]


@pytest.mark.parametrize("digits", DIGITS)
@pytest.mark.parametrize("key", ["ripple", "harmonics", "gravity", "asymmetric"])
def test_digits_that_state_no_number_are_refused(key: str, digits: str) -> None:
    with pytest.raises(InputError) as refused:
        Model.parse(f"stribeck:{key}={digits}")
    assert refused.value.argument == key
    assert len(str(refused.value)) < 300


def test_models_with_own_terms_in_another_order_keep_their_texts() -> None:
    one = Model("stribeck", terms={"q5": "viscous", "q6": "viscous"})
    other = Model("stribeck", terms={"q6": "viscous", "q5": "viscous"})
    assert str(one.resolved) == str(one)
    assert str(other.resolved) == str(other)


@pytest.mark.parametrize("field", ["ripple", "harmonics"])
def test_a_single_order_may_be_a_number(field: str) -> None:
    def made(value: Any) -> Model:
        given: dict[str, Any] = {field: value}
        assert Model.of({"name": "stribeck", **given}) == Model("stribeck", **given)
        return Model("stribeck", **given)

    for order in (2, 2.0, np.float64(2.0), np.int64(2)):
        assert made(order) == made((2.0,))
    for wrong in (True, 0, -1.0, float("nan"), "2"):
        with pytest.raises(InputError, match=field):
            made(wrong)
