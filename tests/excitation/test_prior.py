"""What is believed of the free parameters: all that is missing is named at once."""

import pytest

import jointid as jid
from jointid.excitation.prior import ranges_of
from jointid.joint.parameters import Parameter

KNOWN = {
    "coulomb": Parameter(name="coulomb", value=10.0),
    "static": Parameter(name="static", min=0.0, max=5.0),
}
JOINT = jid.Joint(parameters=KNOWN)


def test_all_parameters_without_a_range_are_named_at_once() -> None:
    with pytest.raises(jid.InputError) as refused:
        ranges_of(JOINT, ("coulomb", "static", "viscous", "stribeck"), None)
    assert str(refused.value) == (
        "joint: viscous, stribeck: the range of these parameters is unknown; give their min and max in the joint or "
        "design with prior={'viscous': ..., 'stribeck': ...}"
    )


def test_one_parameter_without_a_range_is_one() -> None:
    with pytest.raises(
        jid.InputError, match="viscous: the range of this parameter is unknown; give its"
    ):
        ranges_of(JOINT, ("coulomb", "viscous"), None)


def test_a_value_without_bounds_is_believed_to_30_percent() -> None:
    found = ranges_of(JOINT, ("coulomb", "static"), None)
    assert found.ranges == {"coulomb": pytest.approx((7.0, 13.0)), "static": (0.0, 5.0)}
    assert found.nominal == {"coulomb": 10.0, "static": 2.5}
