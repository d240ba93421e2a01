"""Sentences of findings: they show the number that raised them, and which parameter they are about."""

from types import SimpleNamespace
from typing import Any

import pytest
from fake_evidence import evidence as fake_evidence
from fake_evidence import found

from jointid.estimate.findings import TITLE
from jointid.identification.warnings import structured_residual, undetermined
from jointid.identification.warnings.excitation import Excitation
from jointid.joints.citing import cited
from jointid.joints.coupling import Share


def evidence(**values: Any) -> Any:
    return SimpleNamespace(**values)


@pytest.mark.parametrize(("correlation", "said"), [(-0.01, False), (0.9, True)])
def test_a_residual_is_called_autocorrelated_only_where_it_is(
    monkeypatch: pytest.MonkeyPatch, correlation: float, said: bool
) -> None:
    monkeypatch.setattr(structured_residual, "wide", lambda _: ("inertia",))
    monkeypatch.setattr(structured_residual, "with_partners", lambda _, names: names)
    causes = SimpleNamespace(found=(), harmless=(), excluded=("gravity",))
    seen = evidence(
        penalty=SimpleNamespace(cumulative=False),
        residuals=SimpleNamespace(autocorrelation=correlation),
        causes=causes,
        velocity_effect=None,
    )
    (finding,) = structured_residual.CHECK.findings(seen)
    assert ("neighbouring windows correlate" in finding.title) == said
    assert f"r = {correlation:.2f}" in finding.cause
    assert "inertia" in finding.cause


@pytest.mark.parametrize(
    ("share", "text"), [(0.017, "the inertia about 1.7 % too small"), (1.14, "hides the inertia")]
)
def test_noise_that_hides_nothing_is_not_said_to_hide_the_inertia(share: float, text: str) -> None:
    p: Any = SimpleNamespace(name="inertia", vary=True)
    seen = evidence(
        penalty=SimpleNamespace(noise_limited=True), residuals=SimpleNamespace(noise_share=share)
    )
    (reason,) = undetermined._why_undetermined(p, seen)
    assert text in reason.text


def test_too_little_travel_shows_digits_that_differ() -> None:
    for travel in (0.51, 0.96, 0.999, 0.99997):
        seen = evidence(recordings=[SimpleNamespace(position=[0.0, travel])])
        lack = Excitation(seen)._angle("gravity_cos")
        assert lack is not None
        shown = lack.text.split()[4]
        assert float(shown) < 1.0
        assert float(shown) == pytest.approx(travel, rel=0.01)


@pytest.mark.parametrize(
    ("names", "lacks", "title"),
    [
        (
            "ab",
            ("1 of 4 reversals", "little load"),
            "a ± 9 %, b ± 9 %: 1 of 4 reversals, little load",
        ),
        ("abcde", ("little load",), "a ± 9 %, b ± 9 %, c ± 9 % and 2 others: little load"),
        ("a", (), "a ± 9 %"),
    ],
)
def test_a_title_has_values_and_what_is_missing(
    names: str, lacks: tuple[str, ...], title: str
) -> None:
    shown = min(len(names), 3)
    assert undetermined._title([f"{name} ± 9 %" for name in names], lacks) == (title, shown)


def test_a_title_has_fewer_values_of_long_names_and_keeps_what_is_missing() -> None:
    names = [f"coulomb_positive[recording_{k}] ± 1.4 %" for k in range(4)]
    title, shown = undetermined._title(names, ("load varies by 0.27 N·m only", "too much noise"))
    assert title == f"{names[0]} and 3 others: load varies by 0.27 N·m only"
    assert (shown, len(title) <= TITLE) == (1, True)


def test_a_longer_recording_is_asked_for_by_the_parameter() -> None:
    table = SimpleNamespace(duration=SimpleNamespace(sum=lambda: 6.0))
    lack = Excitation(evidence(table=table)).longer("viscous", 10.0, 0.1)
    assert "hides viscous" in lack.text
    assert "viscous has more effect" in lack.motion


def test_a_finding_is_no_surer_of_another_joint_than_the_text() -> None:
    from dataclasses import dataclass

    from jointid.estimate.findings import Finding

    @dataclass(frozen=True)
    class Some:
        findings: tuple[Finding, ...]

    found = Finding(
        code="structured_residual",
        severity="warning",
        title="it misses",
        details="none of 9 known causes explains the residual",
    )
    share = Share(joint="1", by="acceleration", share=0.95, scale=0.1, own_too=True)
    estimate: Any = Some((found,))
    (finding,) = cited(estimate, [share]).findings
    assert "the joint's own motion explains nearly as well" in finding.cause


def test_a_long_remark_about_a_file_gives_its_reason_in_the_details() -> None:
    cut = "the file ends early: its last record is cut off, as if the recorder was killed"
    run: Any = SimpleNamespace(metadata={"incomplete": cut, "empty_rows": 3}, name="")
    (finding,) = found("message_log", fake_evidence(recordings=(run,)))
    assert finding.title == "the file ends early"
    assert finding.details.startswith(
        "its last record is cut off, as if the recorder was killed; 3 row"
    )
