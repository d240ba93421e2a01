"""A value on its bound, a friction of 0, a split that the motion cannot make; and a 0 that is a good value."""

from collections.abc import Callable

import numpy as np
import numpy.typing as npt
import pytest

import jointid as jid

Array = npt.NDArray[np.float64]

TIME = np.arange(10000) * 1e-3


def log(
    velocity: Array, friction: Array | Callable[[Array], Array], noise: float, **facts: float
) -> jid.Recording:
    """A joint of 0.5 kg·m² with this friction, and white noise on the torque."""
    acceleration = np.gradient(velocity, TIME)
    position = np.concatenate([[0.0], np.cumsum(0.5 * (velocity[1:] + velocity[:-1]))]) * 1e-3
    lost = friction(velocity) if callable(friction) else friction
    random = np.random.default_rng(4).normal(0.0, noise, TIME.size)
    weight = facts.get("gravity", 0.0) * np.sin(position)
    torque = 0.5 * acceleration + lost + weight + facts.get("constant", 0.0) + random
    return jid.Recording(time=TIME, position=position, velocity=velocity, torque=torque)


def swinging() -> Array:
    """All speeds up to 3 rad/s, in both directions."""
    return np.asarray(2.0 * np.sin(2.0 * TIME) + 1.0 * np.sin(5.3 * TIME))


def back_and_forth(speed: float) -> Array:
    """One speed in both directions, with quick reversals."""
    return np.asarray(np.clip(60.0 * np.sin(2.0 * TIME), -speed, speed))


def plain(coulomb: float, viscous: float) -> Callable[[Array], Array]:
    return lambda velocity: coulomb * np.sign(velocity) + viscous * velocity


def levels(found: jid.Estimate) -> tuple[str, str, str]:
    uses = found.verdict.uses
    return tuple(uses[p].level for p in ("compensation", "simulation", "monitoring"))  # type: ignore[return-value]


@pytest.mark.parametrize("noise", [1e-3, 0.05, 0.3])
@pytest.mark.parametrize(("coulomb", "viscous"), [(0.0, 0.0), (3.0, 0.0), (0.0, 1.0)])
def test_a_friction_that_is_not_there_is_a_good_value(
    coulomb: float, viscous: float, noise: float
) -> None:
    """A simulator without friction; bearings without grease; an air bearing."""
    run = log(swinging(), plain(coulomb, viscous), noise, gravity=4.0)
    found = jid.identify(run, model=jid.Model("coulomb_viscous", gravity="free"))
    # Without any friction the torque may also have been measured behind it: there is nothing to compensate.
    frictionless = coulomb == viscous == 0.0
    compensation = "not usable" if frictionless else "usable"
    assert levels(found) == (compensation, "usable", "usable"), found.verdict.reasons
    for p in found.parameters.values():
        if p.at_bound is not None:  # "up to" includes the true value
            assert p.interval is not None
            assert p.interval[0] < 0.0 < p.interval[1] < 0.1
            if frictionless:
                continue
            said = next(each for each in found.findings if each.parameters == (p.name,))
            assert (said.code, said.severity) == ("at_bound", "info")
            assert "may be up to" in said.title


@pytest.mark.parametrize("negative", [-0.3, -1.0])
def test_a_value_held_at_0_that_would_be_far_below_is_none(negative: float) -> None:
    """Something drives the joint the faster, the faster it is: no friction is 0 here."""
    run = log(swinging(), plain(3.0, negative), 0.05)
    found = jid.identify(run, model="coulomb_viscous")
    assert found.parameters["viscous"].at_bound == "min"
    assert levels(found)[:2] == ("not usable", "not usable")
    assert "viscous" in found.verdict.uses["compensation"].parameters


def test_a_bound_that_keeps_a_value_away_spoils_what_needs_it() -> None:
    run = log(swinging(), plain(3.0, 1.0), 0.05)
    near = jid.identify(run, model="coulomb_viscous", parameters={"viscous": {"max": 0.995}})
    far = jid.identify(run, model="coulomb_viscous", parameters={"viscous": {"max": 0.5}})
    assert levels(near)[0] == "usable with care"  # half a per cent off
    assert levels(far)[:2] == ("not usable", "not usable")
    assert any("need viscous, which ended on a bound" in each for each in far.verdict.reasons)


@pytest.mark.parametrize("speed", [0.5, 1.5])
def test_one_speed_tells_a_sum(speed: float) -> None:
    """Coulomb and viscous friction are one number at one speed."""
    run = log(back_and_forth(speed), plain(3.0, 0.7), 0.05)
    found = jid.identify(run, model="coulomb_viscous")
    assert levels(found)[:2] == ("not usable", "not usable")
    together = found.derived["coulomb_and_viscous"]
    assert together.interval is not None
    assert together.value == pytest.approx(3.0 + 0.7 * speed, rel=0.01)
    assert together.interval[1] - together.interval[0] < 0.1
    assert f"{together.formula} is {together.value:.4g} ±" in found.verdict.reasons[0]
    assert "coulomb_and_viscous" in found.report(verbose=True)


@pytest.mark.parametrize("constant", [0.0, -2.0])
def test_one_direction_tells_a_sum(constant: float) -> None:
    """Coulomb friction and a constant torque are one number in one direction."""
    run = log(1.5 + 1.2 * np.sin(2.0 * TIME), plain(3.0, 0.7), 0.05, constant=constant)
    found = jid.identify(run, jid.Joint(torque_offset=True), model="coulomb_viscous")
    assert levels(found)[:2] == ("not usable", "not usable")
    together = found.derived["coulomb_and_torque_offset"]
    assert together.value == pytest.approx(3.0 + constant, abs=0.02)
    assert found["viscous"].value == pytest.approx(0.7, rel=0.01)


def test_a_motion_that_divides_them_shows_no_sum() -> None:
    found = jid.identify(log(swinging(), plain(3.0, 0.7), 0.05), model="coulomb_viscous")
    assert levels(found) == ("usable", "usable", "usable")
    assert not [name for name in found.derived if "_and_" in name]


@pytest.mark.parametrize("noise", [0.05, 0.5])
def test_each_purpose_says_how_good(noise: float) -> None:
    """The figures hold what is missed: of the friction and of the torque of the motion, of each value."""
    velocity = swinging()
    truth = {"inertia": 0.5, "coulomb": 3.0, "viscous": 0.7}
    found = jid.identify(log(velocity, plain(3.0, 0.7), noise), model="coulomb_viscous")
    own = plain(found["coulomb"].value, found["viscous"].value)(velocity)
    missed = own - plain(3.0, 0.7)(velocity)
    share = float(np.linalg.norm(missed) / np.linalg.norm(own))
    assert share < found.within["compensation"] < 0.1 * noise
    off = max(abs(found[name].value / true - 1.0) for name, true in truth.items())
    assert off < found.within["monitoring"] < noise
    text = found.report(verbose=True)
    assert f"compensation: usable, to ± {100.0 * found.within['compensation']:.2g} %" in text
    assert jid.Estimate.from_json(found.to_json()).verdict == found.verdict
    assert found.verdict.uses["simulation"].within == found.within["simulation"]


def test_the_cause_comes_before_what_follows_from_it() -> None:
    """Reversed torque: friction ends on its bounds, and that is not the reason."""
    run = log(swinging(), plain(3.0, 0.7), 0.05)
    assert run.torque is not None
    reversed_torque = jid.Recording(
        time=run.time, position=run.position, velocity=run.velocity, torque=-run.torque
    )
    found = jid.identify(reversed_torque, model="coulomb_viscous")
    blocking = [each for each in found.findings if each.severity == "blocking"]
    assert found.verdict.level == "not usable"
    assert found.verdict.reasons[0] == blocking[0].title
