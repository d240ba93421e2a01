"""The verdict: what a person who knows the recordings would say of each, listed before it was computed."""

import json
import re
from collections.abc import Callable
from dataclasses import replace
from functools import cache
from typing import NamedTuple

import defects
import numpy as np
import pytest
from example_recordings import WELL_EXCITED

import jointid as jid
from jointid.estimate.findings import Finding, Measured
from jointid.estimate.self_test import SelfTest, SelfTestRow
from jointid.estimate.verdict import LEVELS, judged
from jointid.estimate.wording import percent
from jointid.joint.model import ModelName
from jointid.report.saving import report_page


@cache
def good() -> jid.Recording:
    return jid.load(WELL_EXCITED)


@cache
def estimate() -> jid.Estimate:
    return jid.identify(good(), jid.thesis_joint())


def short(r: jid.Recording) -> jid.Recording:
    """Half a stroke: a velocity that hardly changes."""
    return r[0.2:0.75]


def without_static_friction(r: jid.Recording) -> jid.Recording:
    """The model has a term that the joint does not have."""
    assert r.torque is not None
    static = 20.0 * np.exp(-100.0 * r.velocity**2) * np.sign(r.velocity)
    return defects.changed(r, torque=r.torque - static)


def rippled(r: jid.Recording) -> jid.Recording:
    assert r.torque is not None
    return defects.changed(r, torque=r.torque + 1.5 * np.sin(202.0 * r.position))


def creeping(r: jid.Recording) -> jid.Recording:
    """More friction where it hardly moves, in another form than the model's."""
    assert r.torque is not None
    slow = 5.0 * np.sign(r.velocity) / (1.0 + (r.velocity / 0.4) ** 2)
    return defects.changed(r, torque=r.torque + slow)


def noise(r: jid.Recording) -> jid.Recording:
    """No joint at all."""
    assert r.torque is not None
    random = np.random.default_rng(5)
    return defects.changed(r, torque=50.0 * random.normal(size=r.torque.size))


def drifting(r: jid.Recording) -> jid.Recording:
    """It warms up: Coulomb friction falls by 5 N·m while it moves."""
    assert r.torque is not None
    gone = (r.time - r.time[0]) / r.duration - 0.5
    return defects.changed(r, torque=r.torque - 5.0 * gone * np.sign(r.velocity))


def pushed(r: jid.Recording, torque: float = 6.0) -> jid.Recording:
    """Somebody touches the link for half a second."""
    assert r.torque is not None
    push = torque * ((r.time > 5.0) & (r.time < 5.5))
    return defects.changed(r, torque=r.torque + push)


def pushed_hard(r: jid.Recording) -> jid.Recording:
    """Somebody leans on the link: 25 N·m, where gravity changes by 9 N·m; the sensor's gain is 42 % off."""
    return pushed(r, 25.0)


def late_torque(r: jid.Recording) -> jid.Recording:
    assert r.torque is not None
    return defects.changed(r, torque=np.interp(r.time - 0.003, r.time, r.torque))


def as_it_is(r: jid.Recording) -> jid.Recording:
    return r


class Case(NamedTuple):
    """A recording, and what one who knows it says of its estimate for each purpose."""

    defect: Callable[[jid.Recording], jid.Recording]
    compensation: str
    simulation: str
    monitoring: str
    reason: str
    model: jid.Model | ModelName = "stribeck"


GOOD, CARE, BAD = "usable", "usable with care", "not usable"
# Written down before any of them was computed, but for the two of a push, which were set after they had been.
# Monitoring compares recordings of the same motion: what is wrong in the same way in all of them does not matter to it,
# what differs from one to the next does.
EXPECTED = (
    Case(as_it_is, GOOD, GOOD, GOOD, "good: motion at all speeds, and the joint's own model"),
    Case(defects.gap, GOOD, GOOD, GOOD, "no window crosses the gap"),
    Case(defects.late_velocity, GOOD, GOOD, GOOD, "the delay is found and taken away"),
    Case(defects.late_sensor, GOOD, GOOD, GOOD, "the delay is found and taken away"),
    Case(late_torque, GOOD, GOOD, GOOD, "the delay is found and taken away"),
    Case(without_static_friction, CARE, CARE, CARE, "too rich: static friction is not there"),
    Case(as_it_is, CARE, CARE, GOOD, "too poor: no static friction", "coulomb_viscous"),
    Case(
        short,
        BAD,
        BAD,
        CARE,
        "half a stroke, in one direction: Coulomb and offset are one constant",
    ),
    Case(rippled, CARE, CARE, GOOD, "the gear's ripple is in the values, and next time, too"),
    Case(creeping, CARE, CARE, GOOD, "friction at low speed has another form, also next time"),
    Case(drifting, CARE, CARE, CARE, "values are of a temperature, which is another next time"),
    Case(pushed, CARE, CARE, CARE, "nobody will lean on it in the same way again"),
    Case(pushed_hard, BAD, BAD, BAD, "the push is stronger than all that the sensor should see"),
    Case(defects.spike, CARE, CARE, CARE, "the logger fails once in a while, not always alike"),
    Case(defects.clipped_sensor, CARE, CARE, CARE, "what the sensor did not show may change"),
    Case(defects.saturated_torque, BAD, BAD, BAD, "a tenth of the torque is missing"),
    Case(defects.reversed_torque, BAD, BAD, BAD, "wrong sign"),
    Case(defects.degrees, BAD, BAD, BAD, "wrong unit"),
    Case(defects.wrong_gear_ratio, BAD, BAD, BAD, "wrong by a fifth, with small errors"),
    Case(defects.constant_sensor, BAD, BAD, BAD, "nothing was measured"),
    Case(noise, BAD, BAD, BAD, "no joint at all"),
)


@pytest.mark.parametrize("case", EXPECTED, ids=lambda each: each.reason)
def test_the_verdict_is_what_one_who_knows_would_say(case: Case) -> None:
    found = jid.identify(case.defect(good()), jid.thesis_joint(), model=case.model)
    verdict = found.verdict
    said = {purpose: use.level for purpose, use in verdict.uses.items()}
    expected = {purpose: getattr(case, purpose) for purpose in said}
    assert said == expected, (verdict.reasons, [each.code for each in found.findings])
    assert verdict.level == max(said.values(), key=LEVELS.index)
    assert bool(verdict.reasons) == (verdict.level != "usable")
    assert set(verdict.uses) == {"compensation", "simulation", "monitoring"}
    json.dumps(verdict.document())


def with_findings(*findings: Finding) -> jid.Estimate:
    return replace(estimate(), findings=findings)


def test_held_out_torque_does_not_excuse_a_reading_that_is_missed() -> None:
    """A torque so late that no delay is found: a chosen model follows it, and inertia is a third too small."""
    r = good()
    assert r.torque is not None
    late = np.interp(r.time - 0.03, r.time, r.torque)
    found = jid.identify(defects.changed(r, torque=late))
    assert found.selection is not None
    assert found.selection[found.selection.model].score < 0.2
    assert found.residuals.r_squared < 0.0
    assert {use.level for use in found.verdict.uses.values()} == {"not usable"}


def test_each_purpose_minds_its_own_parameters() -> None:
    moved = Finding(code="inertia_varies", title="it varies", parameters=("inertia", "viscous"))
    joint = jid.thesis_joint()
    free = replace(with_findings(moved), free=("inertia", *estimate().free), joint=joint)
    uses = free.verdict.uses
    assert str(uses["compensation"]) == "usable with care (viscous)"
    assert str(uses["simulation"]) == "usable with care (inertia, viscous)"
    assert uses["monitoring"].level == "usable"  # a bias that stays the same
    only = replace(free, findings=(replace(moved, parameters=("inertia",)),))
    assert only.verdict.uses["compensation"].level == "usable"
    assert only.verdict.level == "usable with care"
    few = Finding(code="few_windows", title="too few", parameters=("static",))
    chance = with_findings(few)
    assert {str(use) for use in chance.verdict.uses.values()} == {"usable with care (static)"}
    assert str(chance.verdict) == "usable with care (static)"


def test_monitoring_minds_a_change_of_a_tenth() -> None:
    vague = with_findings(Finding(code="undetermined", title="few", parameters=("static",)))
    static = vague.parameters["static"]
    for share, level in ((0.035, "usable"), (0.037, "usable with care")):
        wide = replace(static, stderr=share * static.value)
        found = replace(vague, parameters=dict(vague.parameters) | {"static": wide})
        assert found.verdict.uses["compensation"].level == "usable with care"
        assert found.verdict.uses["monitoring"].level == level


def test_a_cause_by_name_excuses_what_it_explains() -> None:
    """Half of the windows' variance is explained; a finding has a cause for 90 % of the rest, then for half of it."""
    half = replace(estimate(), residuals=replace(estimate().residuals, r_squared=0.5))
    assert half.verdict.level == "not usable"
    for share, level in ((0.9, "usable with care"), (0.5, "not usable")):
        evidence = {"share": Measured(share)}
        named = Finding(
            code="slow_motion", title="it is", parameters=("coulomb",), evidence=evidence
        )
        assert replace(half, findings=(named,)).verdict.level == level
        assert (
            replace(half, findings=(replace(named, severity="info"),)).verdict.level == "not usable"
        )


def test_a_simulation_needs_an_inertia_that_is_known() -> None:
    hidden = Finding(code="undetermined", title="it is hidden", parameters=("inertia",))
    inertia = replace(estimate().parameters["inertia"], stderr=1.5, interval=(-0.5, 5.5))
    parameters = dict(estimate().parameters) | {"inertia": inertia}
    free = replace(with_findings(hidden), parameters=parameters, free=("inertia",))
    verdict = free.verdict
    assert str(verdict.uses["simulation"]) == "not usable (inertia)"
    assert verdict.uses["compensation"].level == "usable"
    assert verdict.uses["monitoring"].level == "usable with care"
    assert "its 95 % interval reaches zero" in verdict.reasons[0]
    assert judged(free, parameters=["viscous"]).level == "usable"  # nobody asks for the inertia
    known = parameters | {"inertia": replace(inertia, interval=(0.5, 4.5))}
    assert replace(free, parameters=known).verdict.level == "usable with care"


def test_an_inertia_on_its_bound_simulates_nothing() -> None:
    bounded = {**estimate().parameters}
    bounded["inertia"] = replace(bounded["inertia"], vary=True, at_bound="min", interval=None)
    found = replace(
        estimate(), parameters=bounded, free=tuple(n for n in estimate().free if n != "inertia")
    )
    assert found.verdict.uses["simulation"].level == "not usable"
    assert found.verdict.uses["compensation"].level == "usable"
    assert any("inertia" in reason and "bound" in reason for reason in found.verdict.reasons)


def test_motion_in_one_direction_compensates_nothing() -> None:
    """Coulomb friction and the sensor's offset are one constant there: either may be anything."""
    whole = good()
    part = whole.crop(0.0, 0.5)
    assert np.all(np.asarray(part.velocity)[np.abs(part.velocity) > 0.01] > 0.0)
    found = jid.identify(part, jid.thesis_joint())
    merged = ("coulomb", "sensor_offset")
    assert [found.parameters[name].stderr for name in merged] == [np.inf, np.inf]
    assert found.verdict.uses["compensation"].level == "not usable"
    assert found.verdict.uses["simulation"].level == "not usable"
    assert "need coulomb and sensor_offset" in found.verdict.reasons[0]
    assert judged(found, parameters=["viscous"]).uses["compensation"].level == "usable with care"


def test_directions_that_differ_need_no_offset_apart() -> None:
    """Offset and directional Coulomb frictions have infinite errors for any motion; their sums compensate."""
    time = np.arange(8000) * 1e-3
    velocity = 1.6 * np.cos(2.0 * time) + 1.5 * np.cos(5.0 * time)
    acceleration = -3.2 * np.sin(2.0 * time) - 7.5 * np.sin(5.0 * time)
    friction = np.where(velocity > 0.0, 12.0, -9.0) + 5.0 * velocity
    noise = np.random.default_rng(1).normal(0.0, 0.05, time.size)
    recording = jid.Recording(
        time=time,
        position=0.8 * np.sin(2.0 * time) + 0.3 * np.sin(5.0 * time),
        velocity=velocity,
        torque=2.0 * acceleration + friction + noise,
    )
    joint = jid.Joint(model=jid.Model.parse("coulomb_viscous:asymmetric"), torque_offset=True)
    found = jid.identify(recording, joint)
    assert "undivided_offset" in [each.code for each in found.findings]
    assert found.parameters["torque_offset"].stderr == np.inf
    assert found.verdict.uses["compensation"].level == "usable"


def test_no_name_excuses_values_that_miss_everything() -> None:
    """An inertia ten times too large: the cause has a name, and no value is worth anything."""
    bare = jid.Recording(
        time=good().time,
        position=good().position,
        velocity=good().velocity,
        torque=good().torque,
    )
    found = jid.identify(bare, jid.Joint(inertia=30.0))
    assert found.residuals.r_squared < 0.0
    assert found.verdict.level == "not usable"
    assert {use.level for use in found.verdict.uses.values()} == {"not usable"}
    wrong = next(each for each in found.findings if each.code == "wrong_scale")
    assert wrong.severity == "blocking"


def test_an_info_does_not_matter_and_a_blocking_finding_always() -> None:
    told = Finding(code="gaps", severity="info", title="samples are missing")
    assert with_findings(told).verdict.level == "usable"
    blocking = Finding(code="wrong_scale", severity="blocking", title="no", parameters=("inertia",))
    verdict = with_findings(Finding(code="spikes", title="two"), blocking).verdict
    assert {use.level for use in verdict.uses.values()} == {"not usable"}
    assert verdict.reasons == ("no", "two")


def test_a_self_test_that_loses_a_parameter_that_was_asked_for() -> None:
    lost = SelfTestRow(
        trial=0,
        parameter="viscous",
        unit="N·m·s/rad",
        truth=20.0,
        value=30.0,
        interval=(29.0, 31.0),
        covered=False,
        close=False,
    )
    test = SelfTest(rows=(lost,), trials=1, seed=0)
    assert test.lost == ("viscous",)
    assert judged(estimate(), test).level == "not usable"
    assert "known values of viscous" in judged(estimate(), test).reasons[0]
    assert judged(estimate(), test, parameters=["coulomb"]).level == "usable"


def test_a_parameter_that_is_not_there_is_refused() -> None:
    """Nothing speaks against it: it would be usable."""
    vague = with_findings(Finding(code="few_windows", title="few", parameters=("static",)))
    with pytest.raises(jid.InputError, match="parameters is 'statik': the estimate has no such"):
        judged(vague, parameters=["statik"])
    assert str(judged(vague, parameters="static")) == "usable with care (static)"
    assert judged(vague, parameters="viscous").level == "usable"


def test_a_tolerance_that_is_larger_than_all_else() -> None:
    known = estimate().parameters["viscous"]
    rests = replace(known, systematic=dict(known.systematic) | {"given": 2.0})
    changed = replace(estimate(), parameters=dict(estimate().parameters) | {"viscous": rests})
    assert str(changed.verdict.uses["simulation"]) == "usable with care (viscous)"
    assert changed.verdict.uses["monitoring"].level == "usable"
    small = replace(known, systematic=dict(known.systematic) | {"given": 0.5})
    fine = replace(estimate(), parameters=dict(estimate().parameters) | {"viscous": small})
    assert fine.verdict.level == "usable"


def test_the_page_begins_with_it() -> None:
    page = report_page(estimate())
    assert '<p class="verdict usable"><b>Usable.</b></p>' in page[: page.index("<h2")]
    found = [Finding(code=f"c{n}", title=f"reason {n}", parameters=("static",)) for n in range(5)]
    page = report_page(with_findings(*found))
    assert '<p class="verdict usable-with-care"><b>Usable with care.</b></p>' in page
    assert re.search(r"<b>compensation: usable with care, to ± [\d.]+ %</b>: static \(above", page)
    assert '<b>Because </b>reason 0. <a href="#findings">All findings</a>.' in page
    assert all(f"reason {n} (c{n})" in page for n in range(5))


def test_text_and_numbers_have_it() -> None:
    lines = estimate().report(verbose=True).splitlines()
    assert lines[:3] == [f"jointid estimate — {estimate().joint.name}", "", "verdict: usable"]
    moved = Finding(code="inertia_varies", title="it varies", parameters=("static",))
    found = with_findings(moved)
    shown = found.report(verbose=True).splitlines()[2:6]
    assert [line.partition(", to ± ")[0] for line in shown] == [
        "verdict: usable with care",
        "  compensation: usable with care (static)",
        "  simulation: usable with care (static)",
        "  monitoring: usable",
    ]
    for line, purpose in zip(shown[1:], ("compensation", "simulation", "monitoring"), strict=True):
        assert line.endswith(f", to ± {percent(found.within[purpose])}")
    document = json.loads(found.to_json())["verdict"]
    assert document == found.verdict.document()
    assert document["uses"]["compensation"] == {
        "level": "usable with care",
        "parameters": ["static"],
        "codes": ["inertia_varies"],
        "within": found.within["compensation"],
    }
    assert jid.Estimate.from_json(found.to_json()).verdict == found.verdict
