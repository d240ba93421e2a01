"""What the core sees in signals: spikes and jumps at their limits, agreement of position and velocity."""

from typing import Any

import numpy as np
import pytest

from jointid import _core

TIME = np.arange(4000) * 1e-3
_WAVE = 2.0 * np.pi * TIME


def seen(signal: Any, rule: _core.SpikeRule, **other: Any) -> Any:
    position = np.sin(_WAVE)
    fields = {
        "time": TIME,
        "position": position,
        "velocity": 2.0 * np.pi * np.cos(_WAVE),
        "velocity_derived": False,
        "period": 1e-3,
    } | other
    return _core.inspect(channels=[(np.asarray(signal), rule, True)], **fields)


def staircase(step: float, height: float, at: int = 2100) -> Any:
    """Up and down by equal steps, so that each usual change is one; with a spike of a height."""
    ramp = np.arange(4000) % 200
    signal = step * np.minimum(ramp, 200 - ramp).astype(float)
    signal[at] += height
    return signal


@pytest.mark.parametrize(
    ("rule", "times"), [(_core.SpikeRule.other, 25.0), (_core.SpikeRule.position, 8.0)]
)
def test_a_spike_is_so_many_usual_changes(rule: _core.SpikeRule, times: float) -> None:
    # Down a slope the smaller side is the height less a step. The range is 100 steps: a tenth of it is less.
    slope = 2150
    for factor, count in ((0.99, 0), (1.01, 1)):
        signal = staircase(1.0, factor * times + 1.0, slope)
        spike = seen(signal, rule).spikes[0]
        assert spike.count == count
        assert not count or spike.index == slope


@pytest.mark.parametrize(
    ("rule", "share"), [(_core.SpikeRule.other, 0.1), (_core.SpikeRule.command, 0.6)]
)
def test_a_spike_is_a_share_of_the_range(rule: _core.SpikeRule, share: float) -> None:
    # 95 % of the samples lie within 95 % of the range, and the usual change is a thousandth of it.
    ramp = np.arange(4000) / 3999.0
    extent = float(np.quantile(ramp, 0.975) - np.quantile(ramp, 0.025))
    for factor, count in ((0.99, 0), (1.01, 1)):
        signal = ramp.copy()
        # Where the joint is fast, at a whole turn.
        signal[2000] += factor * share * extent + 1.0 / 3999.0
        assert seen(signal, rule).spikes[0].count == count


def test_a_step_at_a_reversal_is_none_up_to_a_fifth_beyond_the_range() -> None:
    ramp = np.arange(4000) / 3999.0
    extent = float(np.quantile(ramp, 0.975) - np.quantile(ramp, 0.025))
    for factor, count in ((1.19, 0), (1.21, 1)):
        signal = ramp.copy()
        signal[2250] += factor * extent + 1.0 / 3999.0  # where the velocity is zero
        assert seen(signal, _core.SpikeRule.other).spikes[0].count == count


def test_many_large_changes_are_no_spikes() -> None:
    """A square wave of single samples: its changes are what is usual."""
    signal = np.zeros(4000)
    signal[::3] = 1.0
    assert seen(signal, _core.SpikeRule.other).spikes[0].count == 0


@pytest.mark.parametrize("spikes", [150, 560])
def test_few_large_changes_are_spikes_still(spikes: int) -> None:
    """Up to half of the changes may be those of spikes: the median is what is usual."""
    signal = np.tile([0.0, 0.001], 2000)
    at = 4 * np.arange(spikes) + 1
    at = at[np.abs(np.cos(_WAVE[at])) > 0.1]  # not at a reversal
    signal[at] += 1.0
    assert seen(signal, _core.SpikeRule.other).spikes[0].count >= 0.9 * len(at)


def test_a_spike_of_three_samples_counts_once() -> None:
    signal = staircase(1.0, 0.0)
    signal[2150:2153] += 100.0
    found = seen(signal, _core.SpikeRule.other).spikes[0]
    assert found.count == 1


def test_the_samples_of_a_velocity_s_own_spike_tell_no_reversal() -> None:
    """The torque's kick is held against the motion around a spike, not within."""
    velocity = 2.0 * np.pi * np.cos(_WAVE)
    velocity[2000:2001] = -5.0
    ramp = np.arange(4000) / 3999.0
    ramp[1999:2002] += 0.5  # three samples wide, where the velocity's sample lies
    found = seen(ramp, _core.SpikeRule.other, velocity=velocity).spikes[0]
    assert found.count == 1


def moved_at(factor: float, back: float = 0.0, steps: int = 0) -> int:
    """The jump found in an even motion with one step of so many usual ones."""
    step = np.full(3999, 1e-3)
    step[1500] = factor * 1e-3
    step[1501] -= back
    position = np.concatenate([[0.0], np.cumsum(step)])
    if steps:
        position = np.round(position / (steps * 1e-3)) * steps * 1e-3
    found = _core.inspect(
        time=TIME,
        position=position,
        velocity=np.full(4000, 1.0),
        velocity_derived=False,
        period=1e-3,
        channels=[],
    )
    return int(found.jump)


def test_a_jump_is_four_usual_steps_and_stays() -> None:
    assert moved_at(3.96) == -1
    # Of four steps of the finest kind, half is twice the finest: the encoder may show that.
    assert moved_at(4.04) == -1
    assert moved_at(50.0) == 1500
    assert moved_at(50.0, back=30e-3) == -1  # it goes back by more than half


def jump_of(factor: float, finest: float) -> int:
    """In a motion whose steps differ by noise, so that the finest one is small."""
    step = np.full(3999, 1e-3)
    step[10] = finest
    step[1500] = factor * 1e-3
    position = np.concatenate([[0.0], np.cumsum(step)])
    found = _core.inspect(
        time=TIME,
        position=position,
        velocity=np.full(4000, 1.0),
        velocity_derived=False,
        period=1e-3,
        channels=[],
    )
    return int(found.jump)


def test_a_jump_is_large_beside_the_usual_and_the_finest_step() -> None:
    assert jump_of(3.96, 1e-5) == -1
    assert jump_of(4.04, 1e-5) == 1500
    # Half the jump is more than four of the finest steps.
    assert jump_of(7.9, 1e-3) == -1
    assert jump_of(8.1, 1e-3) == 1500


def agreement(position: Any, velocity: Any, time: Any = TIME) -> Any:
    found = _core.inspect(
        time=time,
        position=position,
        velocity=velocity,
        velocity_derived=False,
        period=1e-3,
        channels=[],
    )
    return found.agreement


def test_scale_and_lag_are_found_together() -> None:
    """A velocity that is 2 ms late and a tenth too small, at two speeds of motion."""
    phase = 2.0 * np.pi * TIME
    position = np.sin(phase) + 0.2 * np.sin(3.1 * phase)
    late = 2.0 * np.pi * (TIME - 2e-3)
    velocity = 0.9 * 2.0 * np.pi * (np.cos(late) + 0.62 * np.cos(3.1 * late))
    found = agreement(position, velocity)
    assert found.scale == pytest.approx(1.0 / 0.9, rel=2e-3)
    assert found.lag == pytest.approx(2e-3 / 0.9, rel=0.03)


def test_lag_does_not_hide_in_a_scale_of_a_motion_that_only_gets_faster() -> None:
    """Where path and change of the velocity go together, both are told apart all the same."""
    position = np.expm1(TIME)
    velocity = np.exp(TIME - 0.01) + 0.3 * np.cos(40.0 * (TIME - 0.01))
    position += 0.3 / 40.0 * np.sin(40.0 * TIME)
    found = agreement(position, velocity)
    assert found.scale == pytest.approx(1.0, rel=2e-3)
    assert found.lag == pytest.approx(0.01, rel=0.05)


def test_a_jump_is_no_disagreement() -> None:
    position = np.sin(_WAVE)
    position[2000:] += 3.0
    found = agreement(position, 2.0 * np.pi * np.cos(_WAVE))
    assert found.scale == pytest.approx(1.0, rel=1e-3)


def test_stretches_across_a_gap_are_left_out() -> None:
    time = TIME.copy()
    time[1000:] += 5.0
    time[3000:] += 5.0
    found = agreement(np.sin(2.0 * np.pi * time), 2.0 * np.pi * np.cos(2.0 * np.pi * time), time)
    assert found.scale == pytest.approx(1.0, rel=1e-3)


def test_the_error_of_a_lag_is_that_of_its_scatter() -> None:
    found = []
    for seed in range(60):
        # A path that is off by itself in each block of samples.
        noise = np.repeat(np.random.default_rng(seed).normal(0.0, 0.1, 500), 8)
        found.append(agreement(np.sin(_WAVE), 2.0 * np.pi * np.cos(_WAVE) + noise))
    scatter = float(np.std([each.lag for each in found]))
    said = float(np.mean([each.lag_error for each in found]))
    assert 0.6 < said / scatter < 1.6


def test_too_short_a_run_tells_nothing() -> None:
    few = slice(0, 60)
    assert agreement(np.sin(_WAVE)[few], np.cos(_WAVE)[few], TIME[few]) is None


def test_a_joint_that_mostly_stands_shows_no_agreement() -> None:
    """Its motion is rarer than what the fit leaves out: the scale of the rest would be 0."""
    position = np.repeat(1e-5 * (np.arange(40) % 2), 100)
    late = np.roll(np.gradient(position, TIME), 20)
    assert agreement(position, late) is None


@pytest.mark.parametrize(("steps", "fine"), [(29.0, False), (31.0, True)])
def test_a_signal_is_fine_from_thirty_steps(steps: float, fine: bool) -> None:
    """The usual change over the smallest; half of the changes and a few more are the usual one."""
    change = np.where(np.arange(3999) % 2 == 0, steps, 1.0)
    change[:9] = steps
    signal = np.concatenate(
        [[0.0], np.cumsum(change * np.where(np.arange(3999) % 4 < 2, 1.0, -1.0))]
    )
    facts = seen(signal, _core.SpikeRule.other).facts[0]
    assert facts.fine == fine


@pytest.mark.parametrize(("steps", "fine"), [(57.0, False), (61.0, True)])
def test_between_two_middle_changes_a_signal_is_fine_by_their_mean(
    steps: float, fine: bool
) -> None:
    """As many changes of one smallest step as of the others: the median is halfway."""
    change = np.where(np.arange(3999) % 2 == 0, steps, 1.0)
    change[0] = 0.0
    signal = np.concatenate(
        [[0.0], np.cumsum(change * np.where(np.arange(3999) % 4 < 2, 1.0, -1.0))]
    )
    assert seen(signal, _core.SpikeRule.other).facts[0].fine == fine


def test_moving_is_faster_than_a_share_of_the_peak() -> None:
    signal = np.sin(7.0 * _WAVE)
    facts = seen(signal, _core.SpikeRule.other).facts[0]
    velocity = np.full(4000, 1e-9)
    velocity[:2] = 1.0
    slow = seen(signal, _core.SpikeRule.other, velocity=velocity).facts[0]
    assert facts.moving > 3000
    assert slow.moving <= 1
