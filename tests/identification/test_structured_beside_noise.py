"""Residuals with structure, where the velocity's noise is a cause with a name."""

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from fake_evidence import evidence, found, parameter

from jointid.estimate.causes import Causes


def _uncertain_static(half_of_coulomb: float, autocorrelation: float) -> Any:
    """Static friction is uncertain, by noise of the velocity; Coulomb friction as given."""
    return evidence(
        parameter("coulomb", 100.0, half_of_coulomb),
        parameter("static", 100.0, 10.0),
        velocity_effect=SimpleNamespace(size=np.array([0.0, 3.0])),
        residuals={"autocorrelation": autocorrelation},
        causes=Causes(found=()),
    )


def test_values_that_noise_makes_uncertain_are_its_finding_s_alone() -> None:
    given = _uncertain_static(0.0, 0.3)
    assert found("structured_residual", given) == []
    assert [each.code for each in found("noisy_velocity", given)] == ["noisy_velocity"]


def test_strong_structure_is_still_noted_beside_noise() -> None:
    assert [
        each.severity for each in found("structured_residual", _uncertain_static(0.0, 0.6))
    ] == ["info"]


@pytest.mark.parametrize("autocorrelation", [0.3, 0.6])
def test_another_uncertain_value_is_named(autocorrelation: float) -> None:
    (finding,) = found("structured_residual", _uncertain_static(10.0, autocorrelation))
    assert finding.severity == "warning"
    assert "coulomb" in finding.parameters


@pytest.mark.parametrize(("static", "named"), [(2.51, True), (2.49, False)])
def test_noise_names_a_value_that_it_moves_by_half_its_standard_error(
    static: float, named: bool
) -> None:
    given = evidence(
        parameter("ripple_cos_2", 0.011, 1.96 * 0.012),
        parameter("static", 100.0, 1.96 * 5.0),
        velocity_effect=SimpleNamespace(size=np.array([0.00088, static])),
    )
    findings = found("noisy_velocity", given)
    assert ["ripple_cos_2" in each.title for each in findings] == [False] * named
