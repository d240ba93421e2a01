"""What a notebook or a debugger shows of a result is one short line."""

import pytest
from example_recordings import WELL_EXCITED

import jointid as jid


@pytest.fixture(scope="module")
def estimate() -> jid.Estimate:
    recording = jid.load(WELL_EXCITED)
    return jid.identify(recording, jid.Joint(sensor=True), model="stribeck")


def test_what_is_shown_is_one_short_line(estimate: jid.Estimate) -> None:
    assert estimate.findings
    results = [
        estimate,
        estimate.verdict,
        estimate.windows,
        estimate.friction([0.1, 0.2]),
        estimate.bootstrap(50),
        estimate.selftest(trials=1),
        *estimate.findings,
        *estimate.parameters.values(),
    ]
    for result in results:
        shown = repr(result)
        assert "\n" not in shown
        assert len(shown) <= 300, shown


def test_a_value_is_shown_with_its_error_and_unit(estimate: jid.Estimate) -> None:
    shown = repr(estimate.parameters["coulomb"])
    assert shown.startswith("<ParameterEstimate coulomb: 25.0")
    assert "±" in shown
    assert shown.endswith(" N·m>")
