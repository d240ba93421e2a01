"""A model by name, text, pair or specification: what is written reads back, what is nonsense is refused."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from jointid.base.errors import InputError
from jointid.comparison.model_spec import ModelSpec, specified


@pytest.mark.parametrize(
    ("spec", "text"),
    [
        (ModelSpec("stribeck"), "stribeck"),
        (ModelSpec("coulomb_viscous", asymmetric=True), "coulomb_viscous:asymmetric"),
        (ModelSpec("stribeck", ripple=[2, 4], asymmetric=True), "stribeck:asymmetric:ripple=2,4"),
        (ModelSpec("stribeck", side="torque", load=0.5), "stribeck:load=0.5:side=torque"),
        (ModelSpec("stribeck", asymmetric=False), "stribeck:asymmetric=false"),
    ],
)
def test_a_specification_is_its_text(spec: ModelSpec, text: str) -> None:
    assert str(spec) == text
    assert ModelSpec.parse(text) == spec
    assert hash(ModelSpec.parse(text)) == hash(spec)
    assert specified([spec.name]) == (ModelSpec(spec.name),)


_VALUES = st.booleans() | st.integers() | st.lists(st.integers(), min_size=2, max_size=4)


@given(
    name=st.sampled_from(["coulomb_viscous", "stribeck"]),
    options=st.dictionaries(st.from_regex(r"[a-z_]{1,8}", fullmatch=True), _VALUES, max_size=3),
)
def test_every_specification_reads_back(name: str, options: dict[str, object]) -> None:
    options.pop("name", None)
    spec = ModelSpec(name, **options)
    assert ModelSpec.parse(str(spec)) == spec


@given(text=st.text(alphabet="stribeck:=,.1-_ \n\u00e9", max_size=20) | st.text(max_size=20))
def test_any_text_is_a_specification_or_refused(text: str) -> None:
    try:
        spec = ModelSpec.parse(text)
    except InputError:
        return  # a sentence; anything else fails the test
    assert ModelSpec.parse(str(spec)) == spec


def test_single_orders_become_collections() -> None:
    for spec in (ModelSpec("stribeck", ripple=[2]), ModelSpec.parse("stribeck:ripple=2")):
        assert str(spec) == "stribeck:ripple=2"
        assert spec.arguments() == {"model": "stribeck", "ripple": (2,)}
    assert ModelSpec("stribeck", ripple=2, per_recording="torque_offset").arguments() == {
        "model": "stribeck",
        "per_recording": ("torque_offset",),
        "ripple": (2,),
    }


def test_a_pair_is_a_specification() -> None:
    assert specified([("stribeck", {}), "coulomb_viscous"]) == (
        ModelSpec("stribeck"),
        ModelSpec("coulomb_viscous"),
    )
