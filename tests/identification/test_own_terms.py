"""Own terms: named signals of a recording as terms of the balance, with known truth."""

import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import jointid as jid
from jointid.base.errors import InputError
from jointid.identification.search.search import Search
from jointid.joint.own_terms import OwnTerms
from jointid.problem.own_integrals import own_series
from jointid.report.saving import save_report

TIME = np.arange(6000) * 0.002
Q = 0.8 * np.sin(2.1 * TIME) + 0.3 * np.sin(5.3 * TIME + 1.0)
V = 0.8 * 2.1 * np.cos(2.1 * TIME) + 0.3 * 5.3 * np.cos(5.3 * TIME + 1.0)
A = -0.8 * 2.1**2 * np.sin(2.1 * TIME) - 0.3 * 5.3**2 * np.sin(5.3 * TIME + 1.0)
Q6 = 0.5 * np.sin(3.3 * TIME + 0.4) + 0.2 * np.cos(1.1 * TIME)
V6 = 0.5 * 3.3 * np.cos(3.3 * TIME + 0.4) - 0.22 * np.sin(1.1 * TIME)
A6 = -0.5 * 3.3**2 * np.sin(3.3 * TIME + 0.4) - 0.242 * np.cos(1.1 * TIME)
MODEL = 20.0 * np.sin(0.9 * TIME + 0.2)
INERTIA = 4.0 + 1.5 * np.cos(Q6)
SEPARABLE = Search("separable")


def run(more: Any = 0.0, seed: int = 1, **extra: Any) -> jid.Recording:
    """Inertia 2.5, Coulomb 12, viscous 6, offset 1, and more torque."""
    noise = np.random.default_rng(seed).normal(scale=1.0, size=len(TIME))
    torque = 2.5 * A + 12.0 * np.sign(V) + 6.0 * V + 1.0 + more + noise
    return jid.Recording(time=TIME, position=Q, velocity=V, torque=torque, extra=extra)


def identify(recording: jid.Recording, terms: Any, **changes: Any) -> jid.Estimate:
    return jid.identify(
        recording, model="coulomb_viscous", terms=terms, search=SEPARABLE, **changes
    )


def check(estimate: jid.Estimate, **truth: float) -> None:
    for name, true in ({"inertia": 2.5, "coulomb": 12.0, "viscous": 6.0} | truth).items():
        found = estimate.parameters[name]
        assert found.value == pytest.approx(true, rel=0.06), name
        if found.vary and name in truth:
            assert found.interval is not None
            # Sampled steps of Coulomb friction are no noise, and not in the interval.
            assert abs(found.value - true) < np.diff(found.interval)[0], (name, found.interval)


def test_other_joints_friction_is_identified_and_named_everywhere() -> None:
    more = 3.0 * V6 + 5.0 * np.sign(V6)
    recording = run(more, q6_rate=V6).with_signals()
    estimate = identify(recording, {"q6_rate": "viscous+coulomb"})
    check(estimate, viscous_of_q6_rate=3.0, coulomb_of_q6_rate=5.0)
    found = estimate.parameters["viscous_of_q6_rate"]
    assert found.unit == "N·m/[q6_rate]"
    assert "structured_residual" not in {each.code for each in estimate.findings}
    assert "viscous_of_q6_rate" in estimate.report()
    assert jid.Estimate.from_json(estimate.to_json()).parameters == estimate.parameters
    poor = identify(recording, None)
    assert estimate.residuals.relative < 0.3 * poor.residuals.relative


def test_a_known_unit_gives_the_unit_of_the_coefficient() -> None:
    units = {"q6": "rad", "drive": "A"}
    recording = run(3.0 * V6 + 0.7 * MODEL + 0.4 * A6, q6=Q6, drive=MODEL)
    recording = jid.Recording(**{**recording._fields(), "metadata": {"extra_units": units}})
    estimate = identify(recording, {"q6": "viscous@rate+coupling@rate", "drive": "scaled"})
    shown = [estimate.parameters[name].unit for name in list(estimate.parameters)[-3:]]
    assert shown == ["N·m·s/rad", "N·m·s²/rad", "N·m/A"]
    check(estimate, viscous_of_q6_rate=3.0, coupling_of_q6_rate=0.4, scale_of_drive=0.7)


def test_a_known_torque_is_subtracted_with_a_gain_of_one_or_a_free_one() -> None:
    known = identify(run(MODEL, tau=MODEL), {"tau": "known"})
    check(known, known_of_tau=1.0)
    assert not known.parameters["known_of_tau"].vary
    check(identify(run(0.9 * MODEL, tau=MODEL), {"tau": "scaled"}), scale_of_tau=0.9)
    freed = identify(
        run(0.9 * MODEL, tau=MODEL), {"tau": "known"}, parameters={"known_of_tau": {"vary": True}}
    )
    check(freed, known_of_tau=0.9)


def test_a_held_command_and_a_known_torque_go_together() -> None:
    """A command that is held balances the mean of what is needed until the next."""
    needed = 2.5 * A + 12.0 * np.sign(V) + 6.0 * V + 1.0 + MODEL
    held = np.append(0.5 * (needed[1:] + needed[:-1]), needed[-1])
    recording = jid.Recording(
        time=TIME, position=Q, velocity=V, torque=held, torque_hold="zoh", extra={"tau": MODEL}
    )
    estimate = identify(recording, {"tau": "known"})
    assert estimate.parameters["coulomb"].value == pytest.approx(12.0, rel=2e-3)
    assert estimate.residuals.relative < 2e-3
    assert not estimate.settings.get("shift")


def test_known_inertias_with_and_without_what_their_change_costs() -> None:
    over = np.cos(Q)
    slope = -np.sin(Q)
    rate = -1.5 * np.sin(Q6) * V6
    for kind, inertia, more in (
        ("inertia", INERTIA, INERTIA * A),
        ("inertia_others", INERTIA, INERTIA * A + rate * V),
        ("inertia_own", 4.0 + over, (4.0 + over) * A + 0.5 * slope * V**2),
    ):
        estimate = identify(run(more, arm=inertia), {"arm": kind})
        check(estimate, known_inertia_of_arm=1.0)
    all_known = identify(
        run(-2.5 * A + INERTIA * A, arm=INERTIA), {"arm": "inertia"}, parameters={"inertia": 0.0}
    )
    check(all_known, inertia=0.0)
    scaled = identify(
        run(0.8 * INERTIA * A, arm=INERTIA), {"arm": "scaled_inertia"}, parameters={"inertia": 2.5}
    )
    check(scaled, scale_inertia_of_arm=0.8)


def test_inertia_and_torque_over_an_angle_are_centred_in_its_range() -> None:
    shifted = Q + 3.0
    centre = 0.5 * (shifted.min() + shifted.max())
    cosine, sine = np.cos(shifted - centre) - 1.0, np.sin(shifted - centre)
    inertia, slope = (
        0.9 * cosine + 0.6 * sine,
        -0.9 * np.sin(shifted - centre) + 0.6 * np.cos(shifted - centre),
    )
    more = inertia * A + 0.5 * slope * V**2 + 7.0 * cosine + 4.0 * sine
    recording = run(more).with_signals(position=shifted)
    estimate = identify(recording, {"position": "inertia_over+torque_over"})
    check(
        estimate,
        inertia_cos_of_position=0.9,
        inertia_sin_of_position=0.6,
        torque_cos_of_position=7.0,
        torque_sin_of_position=4.0,
    )
    # The centre is part of the model: another recording with another range means the same.
    assert estimate.settings["model"].endswith(
        f"inertia_over({centre:.6g})+torque_over({centre:.6g})"
    )
    part = recording.crop(0.0, 2.0)
    assert estimate.predict(part).relative < 0.05
    check_over = identify(
        run(0.8 * (np.cos(Q6) - 1.0) * A - 0.8 * np.sin(Q6) * V6 * V, q6=Q6),
        {"q6": "inertia_over(0)"},
    )
    assert check_over.parameters["inertia_cos_of_q6"].value == pytest.approx(0.8, rel=0.05)


@pytest.mark.parametrize(
    ("extra", "terms", "message"),
    [
        (
            {"same": V},
            {"same": "viscous"},
            "viscous_of_same.*always the same torque as viscous in",
        ),
        (
            {"one": np.ones_like(V)},
            {"one": "scaled"},
            "scale_of_one.*the same torque as torque_offset",
        ),
        ({"a": V6, "b": 2.0 * V6}, {"a": "viscous", "b": "viscous"}, "viscous_of_a.*viscous_of_b"),
        (
            {"a": V6 + V, "b": V6 - V},
            {"a": "viscous", "b": "viscous"},
            "viscous_of_a.*a sum of viscous",
        ),
        ({"still": np.full_like(V, 0.3)}, {"still": "viscous@rate"}, "viscous_of_still_rate"),
        (
            {"still": 0.3 + 1e-5 * np.random.default_rng(0).normal(size=len(V))},
            {"still": "coulomb@rate"},
            "coulomb_of_still_rate.*changes less than its noise",
        ),
        (
            {"a": V6, "b": MODEL, "sum": V6 + MODEL},
            {"a": "viscous", "b": "scaled", "sum": "scaled"},
            "a sum of",
        ),
        ({"zero": 0.0 * V}, {"zero": "scaled"}, "scale_of_zero.*has no effect"),
        ({}, {"q6": "viscous"}, "no extra signal of this name; its extra signals: none"),
    ],
)
def test_a_term_that_says_nothing_of_its_own_is_refused_by_name(
    extra: Any, terms: Any, message: str
) -> None:
    with pytest.raises(InputError) as caught:
        identify(run(**extra), terms)
    text = str(caught.value)
    assert re.search(message, text), text


def test_a_sum_is_refused_where_only_the_velocity_noise_tells_it() -> None:
    position = Q + np.random.default_rng(0).normal(scale=2e-5, size=len(Q))
    more = 2.0 * V6
    recorded = run(more, a=V6 + V, b=V6 - V)
    recording = jid.Recording(
        time=TIME, position=position, torque=recorded.torque, extra=recorded.extra
    )
    with pytest.raises(InputError, match=r"viscous_of_a.*a sum of viscous and viscous_of_b"):
        identify(recording, {"a": "viscous", "b": "viscous"})


def test_known_signals_of_equal_shape_are_both_taken_away() -> None:
    gravity = 15.0 * np.cos(Q)
    recording = run(2.0 * gravity, link=gravity, payload=gravity.copy())
    check(identify(recording, {"link": "known", "payload": "known"}))
    ones = np.ones_like(Q)
    recording = run(3.0 * A, link=2.0 * ones, rotor=ones)
    check(identify(recording, {"link": "inertia", "rotor": "inertia"}))
    free = {"known_of_link": {"vary": True}, "known_of_payload": {"vary": True}}
    recording = run(2.0 * gravity, link=gravity, payload=gravity)
    with pytest.raises(InputError, match=r"known_of_link.*known_of_payload"):
        identify(recording, {"link": "known", "payload": "known"}, parameters=free)


@pytest.mark.parametrize("size", [0.05, 0.2])
def test_noise_of_a_scaled_signal_is_in_the_interval_and_named(size: float) -> None:
    gravity = 15.0 * np.cos(Q)
    noise = size * 15.0 * np.random.default_rng(7).normal(size=len(TIME))
    estimate = identify(run(gravity, tau=gravity + noise), {"tau": "scaled"})
    gain = estimate.parameters["scale_of_tau"]
    assert gain.interval is not None
    assert gain.systematic["extra"] > 0.0
    assert gain.interval[0] < 1.0 < gain.interval[1]
    found = {each.code: each for each in estimate.findings}
    assert ("noisy_signal" in found) == (size == 0.2)
    if size == 0.2:
        assert gain.stderr is not None
        assert gain.value < 1.0 - 3.0 * gain.stderr  # what the finding is about
        assert "scale_of_tau" in found["noisy_signal"].parameters
        assert "tau" in found["noisy_signal"].cause
    quiet = identify(run(gravity, tau=gravity), {"tau": "scaled"}).parameters["scale_of_tau"]
    assert "extra" not in quiet.systematic


def test_noise_of_a_known_torque_with_a_fixed_gain_biases_nothing() -> None:
    noise = 4.0 * np.random.default_rng(7).normal(size=len(TIME))
    estimate = identify(run(MODEL, tau=MODEL + noise), {"tau": "known"})
    check(estimate)
    assert "extra" not in estimate.parameters["viscous"].systematic


def test_an_extra_signal_that_is_the_position_derivative_is_refused_too() -> None:
    recording = run(again=Q)
    with pytest.raises(InputError, match="viscous_of_again_rate"):
        identify(recording, {"again": "viscous@rate"})


def test_what_follows_an_estimate_knows_own_terms() -> None:
    more = 3.0 * V6 + MODEL
    recording = run(more, q6=Q6, tau=MODEL)
    terms = {"q6": "viscous@rate", "tau": "known"}
    estimate = identify(recording, terms)
    other = run(more, seed=2, q6=Q6, tau=MODEL).crop(2.0, 9.0)
    assert estimate.predict(other).relative < 0.05
    with pytest.raises(InputError, match="no extra signal"):
        estimate.predict(run(more))
    drawn = estimate.bootstrap(200, 0)
    assert "viscous_of_q6_rate" in drawn.report()
    tested = estimate.selftest(seed=0)
    assert "viscous_of_q6_rate" in tested.report()
    estimate.causes()


def test_models_with_own_terms_are_compared_on_held_out_motion() -> None:
    recording = run(3.0 * V6, q6=Q6)
    result = jid.compare_models(
        recording,
        models=["coulomb_viscous", "coulomb_viscous:terms=q6=viscous@rate"],
        search=SEPARABLE,
    )
    assert "q6" in str(result.estimate.joint.model)


def test_a_model_is_chosen_beside_own_terms() -> None:
    decay = 8.0 * np.sign(V) * np.exp(-((V / 0.15) ** 2))
    estimate = jid.identify(
        run(3.0 * V6 + decay, q6=Q6), terms={"q6": "viscous@rate"}, search=SEPARABLE
    )
    assert "static" in estimate.parameters
    check(estimate, viscous_of_q6_rate=3.0)


def test_a_coefficient_of_each_recording() -> None:
    runs = [run(3.0 * V6, q6=Q6), run(4.0 * V6, seed=3, q6=Q6)]
    estimate = jid.identify(
        runs,
        model=jid.Model.parse("coulomb_viscous:per_recording=viscous_of_q6_rate"),
        terms={"q6": "viscous@rate"},
        search=SEPARABLE,
    )
    values = [estimate.parameters[f"viscous_of_q6_rate[{k}]"].value for k in (0, 1)]
    assert values == pytest.approx([3.0, 4.0], rel=0.06)


def test_bounds_and_fixed_values_hold() -> None:
    recording = run(3.0 * V6, q6=Q6)
    fixed = identify(recording, {"q6": "viscous@rate"}, parameters={"viscous_of_q6_rate": 3.0})
    assert fixed.parameters["viscous_of_q6_rate"].value == 3.0
    held = identify(
        recording, {"q6": "viscous@rate"}, parameters={"viscous_of_q6_rate": {"max": 2.0}}
    )
    assert held.parameters["viscous_of_q6_rate"].at_bound == "max"
    assert any("viscous_of_q6_rate" in finding.parameters for finding in held.findings)


def test_load_friction_grows_with_a_known_torque_too() -> None:
    """The drive transmits the known torque: friction grows with the magnitude of all that it transmits."""
    plain = 2.5 * A + MODEL + 1.0 + 4.0 * np.sign(V) + 6.0 * V
    torque = plain / (1.0 - 0.2 * np.sign(V) * np.sign(plain))
    recording = jid.Recording(
        time=TIME, position=Q, velocity=V, torque=torque, extra={"tau": MODEL}
    )
    model = "coulomb_viscous:load_friction=drive"
    estimate = jid.identify(
        recording, model=jid.Model.parse(model), terms={"tau": "known"}, search=SEPARABLE
    )
    assert estimate.parameters["load_friction"].value == pytest.approx(0.2, rel=0.03)
    assert estimate.parameters["viscous"].value == pytest.approx(6.0, rel=0.05)


def test_what_cannot_have_own_terms_says_so() -> None:
    model = jid.Model.parse("coulomb_viscous:terms=q6=viscous")
    joint = jid.Joint(model=model, inertia=2.5, gear_ratio=1.0)
    with pytest.raises(InputError, match="online"):
        jid.OnlineIdentifier(joint)
    with pytest.raises(InputError, match="simulation does not have"):
        jid.simulate(joint, jid.Pd(), jid.Trajectory.thesis())


def test_an_export_says_that_it_lacks_them(tmp_path: Path) -> None:
    recording = run(3.0 * V6, q6=Q6)
    estimate = identify(recording, {"q6": "viscous@rate"})
    estimate.save(tmp_path / "joint.toml")
    for source in (estimate, jid.Joint.load(tmp_path / "joint.toml")):
        (tmp_path / "joint.h").unlink(missing_ok=True)
        jid.export(source, tmp_path / "joint.h")
        text = (tmp_path / "joint.h").read_text(encoding="ascii")
        assert "of other signals (q6=viscous@rate" in " ".join(text.split())


def test_the_page_and_the_pictures_have_them(tmp_path: Path) -> None:
    recording = run(3.0 * V6, q6=Q6)
    estimate = identify(recording, {"q6": "viscous@rate"})
    page = save_report(estimate, tmp_path / "report.html").read_text(encoding="utf-8")
    assert "viscous_of_q6_rate" in page


def test_the_series_of_a_window_does_not_depend_on_its_samples() -> None:
    recording = run(a=V6)
    ((key, series),) = own_series(OwnTerms.of({"a": "coulomb"}), recording)
    assert key == "coulomb_of_a"
    crossings = np.flatnonzero(np.diff(np.sign(V6)))
    k = int(crossings[0])
    before = abs(V6[k]) / (abs(V6[k]) + abs(V6[k + 1]))
    step = TIME[k + 1] - TIME[k]
    assert series[k + 1] - series[k] == pytest.approx(np.sign(V6[k]) * step * (2 * before - 1))


def test_a_signal_that_starts_from_exactly_zero_has_its_sign_from_there() -> None:
    started = np.maximum(0.0, TIME - TIME[3])
    ((_, series),) = own_series(OwnTerms.of({"a": "coulomb"}), run(a=started))
    assert np.diff(series)[:6] == pytest.approx(0.002 * np.array([0, 0, 0, 1, 1, 1]))
    ((_, series),) = own_series(OwnTerms.of({"a": "coulomb"}), run(a=-started[::-1]))
    assert np.diff(series)[-5:] == pytest.approx(-0.002 * np.array([1, 1, 0, 0, 0]))
