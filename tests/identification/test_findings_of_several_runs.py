"""Of several recordings a finding names those that it is about; those that say the same are one."""

from __future__ import annotations

import numpy as np
import pytest
from defects import changed
from fake_evidence import evidence, found, inspected, signal
from plain_joint import recorded

import jointid as jid
from jointid.estimate.findings import TITLE, Finding, Measured
from jointid.identification.warnings.merging import merged
from jointid.problem.recordings import recording_names

RUNS = [recorded(name=f"run_{seed}", seed=seed) for seed in range(4)]


def with_spike(run: jid.Recording, at: int = 400, height: float = 60.0) -> jid.Recording:
    torque = np.array(run.torque)
    torque[at] += height
    return changed(run, torque=torque)


def coded(findings: tuple[Finding, ...], code: str) -> list[Finding]:
    return [each for each in findings if each.code == code]


def test_a_finding_about_one_of_several_runs_names_it_everywhere() -> None:
    runs = [*RUNS[:3], with_spike(RUNS[3])]
    estimate = jid.identify(runs)
    (spikes,) = coded(estimate.findings, "spikes")
    assert spikes.recordings == ("run_3",)
    assert spikes.title.startswith("run_3: torque has a spike")
    assert "run_3: torque has a spike" in estimate.report()
    read = jid.Estimate.from_json(estimate.to_json())
    assert coded(read.findings, "spikes")[0].recordings == ("run_3",)


def test_what_is_found_in_several_runs_is_said_once() -> None:
    runs = [with_spike(RUNS[0], 400, 50.0), RUNS[1], with_spike(RUNS[2], 600, 80.0)]
    (spikes,) = coded(jid.identify(runs).findings, "spikes")
    assert spikes.recordings == ("run_0", "run_2")
    assert spikes.title.startswith("2 of 3 recordings: torque has a spike")
    assert spikes.details.startswith("in run_0, run_2; ")
    assert "at 2–3 s" in spikes.title
    assert spikes.evidence["height"].value == pytest.approx(80.0, abs=8.0)


def test_equal_shares_of_all_runs_are_a_range() -> None:
    counts = [{"position": signal(stale=stale)} for stale in (40, 50, 60)]
    looked_at = tuple(inspected(run, each) for run, each in zip(RUNS, counts, strict=False))
    (finding,) = found("repeated", evidence(recordings=tuple(RUNS[:3]), inspections=looked_at))
    assert finding.title.startswith("3 of 3 recordings: 4–6 % of the position samples")


def test_what_is_stated_nowhere_is_said_once() -> None:
    unstated = {"assumed_units": ["torque"]}
    runs = [recorded(name=f"run_{seed}", seed=seed, metadata=unstated) for seed in range(3)]
    (finding,) = coded(jid.identify(runs).findings, "assumed_units")
    assert finding.cause.startswith("3 of 3 recordings: no unit is stated for torque")


def test_different_findings_stay_apart() -> None:
    one, other = (
        Finding(code="spikes", title=f"1 spike in {name}") for name in ("torque", "sensor")
    )
    apart = merged([(0, one), (1, other), (2, one)], ("a", "b", "c"))
    assert [each.cause for each in apart] == [
        "2 of 3 recordings: 1 spike in torque; in a, c",
        "b: 1 spike in sensor",
    ]


@pytest.mark.parametrize(("characters", "named"), [(87, True), (88, False)])
def test_a_name_that_makes_a_title_too_long_is_a_detail(characters: int, named: bool) -> None:
    (finding,) = merged([(1, Finding(code="x", title="x" * characters))], ("a", "b"))
    assert finding.title.startswith("b: ") == named
    assert finding.details == ("" if named else "in b")
    assert len(finding.title) <= TITLE


def test_a_range_reads_well_below_zero_and_keeps_words_with_digits() -> None:
    several = [
        Finding(
            code="x", title=f"off by {value} of kg·m2 and 2π", evidence={"off": Measured(value)}
        )
        for value in (-3.5, 2.0)
    ]
    (finding,) = merged(enumerate(several), ("a", "b"))
    assert finding.cause == "2 of 2 recordings: off by -3.5 to 2.0 of kg·m2 and 2π"
    assert finding.evidence["off"].value == -3.5


def test_recordings_without_a_name_of_their_own_have_a_number() -> None:
    named = [
        jid.Recording(time=range(8), position=range(8), name=name) for name in ("a", "b", "a", "")
    ]
    assert recording_names(named) == ("recording 0", "b", "recording 2", "recording 3")


def test_a_single_recording_is_not_named() -> None:
    (spikes,) = coded(jid.identify(with_spike(RUNS[0])).findings, "spikes")
    assert spikes.recordings == ()
    assert spikes.title.startswith("torque has a spike")


def test_the_title_says_how_many_recordings_there_are() -> None:
    two = jid.identify(RUNS[:2])
    assert two.report().startswith("run_0 and 1 more recording: ")
    of_joint = jid.identify(RUNS[:3], jid.Joint(name="wrist"))
    assert of_joint.report().startswith("wrist, 3 recordings: ")
    assert jid.identify(RUNS[0]).report().startswith("run_0: ")


@pytest.mark.parametrize("factor", [0.5, 1.6, -1.0])
def test_a_run_whose_torque_is_scaled_is_named_and_spoils_the_values(factor: float) -> None:
    odd = changed(RUNS[2], torque=factor * np.asarray(RUNS[2].torque))
    estimate = jid.identify([*RUNS[:2], odd, RUNS[3]])
    (found,) = coded(estimate.findings, "other_run")
    assert "(run_2): with it" in found.title
    assert found.severity == "blocking"
    assert estimate.verdict.level == "not usable"


def test_two_runs_that_contradict_each_other_are_both_named() -> None:
    odd = changed(RUNS[1], torque=np.asarray(RUNS[1].torque) + 1.5)
    (found,) = coded(jid.identify([RUNS[0], odd]).findings, "other_run")
    assert "(run_0 and run_1): with it" in found.title


def test_a_run_with_a_little_more_friction_is_worth_a_word() -> None:
    friction = 0.1 * 3.0 * np.sign(RUNS[2].velocity)
    warm = changed(RUNS[2], torque=np.asarray(RUNS[2].torque) + friction)
    estimate = jid.identify([*RUNS[:2], warm, RUNS[3]])
    (found,) = coded(estimate.findings, "other_run")
    assert found.severity == "warning"
    assert estimate.verdict.level == "usable with care"


def test_runs_that_lack_the_same_are_alike() -> None:
    uneven = [
        changed(run, torque=np.asarray(run.torque) + 0.4 * np.sin(3.0 * run.position))
        for run in RUNS
    ]
    codes = {each.code for each in jid.identify(uneven).findings}
    assert "other_run" not in codes
    assert "harmonic" in codes
