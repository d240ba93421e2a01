"""A slow reversal at a low torque limit: a healthy joint stands there while its torque swings, and may."""

import math
from dataclasses import replace
from pathlib import Path

import pytest

import jointid as jid
from jointid.hardware import EmulatedBus, Session, SessionStoppedError
from jointid.hardware.bench.bench import Bench
from jointid.hardware.elmo import ElmoDrive
from jointid.hardware.elmo.emulated_bench import elmo_devices
from jointid.hardware.session.moving_joint import breakaway

EXAMPLE = Path(__file__).resolve().parents[2] / "examples" / "hardware" / "joint.toml"
BELIEVED = 30.0  # breakaway of the joint file [N·m]; 45 is true
AMPLITUDE = math.radians(5.0)
CYCLES = [6.0, pytest.param(10.0, marks=pytest.mark.slow)]


def slow(torque: float, cycle: float) -> Bench:
    """The example with a small slow motion of one cycle, at a torque limit [N·m]."""
    bench = Bench.load(EXAMPLE)
    emulation = bench.emulation
    assert emulation is not None
    assert emulation.drive is not None
    peak = torque / (0.198 * 101.0)
    return replace(
        bench,
        trajectory=jid.Trajectory.thesis(AMPLITUDE, cycle=cycle, duration=cycle),
        limits=replace(bench.limits, torque=torque, tracking_error=0.05),
        emulation=replace(emulation, drive=replace(emulation.drive, peak_current=peak)),
    )


def move(bench: Bench, *, hangs: float = math.inf) -> jid.Recording | None:
    """Move an emulated bench, whose encoder hangs from a time of the run on [s]."""
    elmo, *others = elmo_devices(bench)
    with EmulatedBus(elmo, *others) as bus:

        def observe(phase: str, time: float, *_: object) -> None:
            if phase == "run" and time >= hangs and elmo.stuck_encoder is None:
                elmo.stuck_encoder = elmo.counts()

        return Session(
            ElmoDrive(bus, bench.joint, bench.drive),
            bench.controller,
            bench.trajectory,
            bench.limits,
            options=bench.options,
            observer=observe,
        ).run()


@pytest.mark.parametrize("cycle", CYCLES)
@pytest.mark.parametrize(
    "torque", [50.0, 90.0, *(pytest.param(each, marks=pytest.mark.slow) for each in (60.0, 80.0))]
)
def test_a_healthy_joint_is_not_stopped(torque: float, cycle: float) -> None:
    assert breakaway(slow(torque, cycle).joint) == BELIEVED
    recording = move(slow(torque, cycle))
    assert recording is not None
    assert recording.torque is not None
    assert recording.torque.max() > 45.0
    assert recording.torque.min() < -45.0


@pytest.mark.parametrize("cycle", CYCLES)
@pytest.mark.parametrize("torque", [50.0, pytest.param(80.0, marks=pytest.mark.slow)])
@pytest.mark.parametrize(
    "share", [0.1, 0.34]
)  # of the cycle: in motion, and about the first reversal
def test_an_encoder_that_hangs_still_stops_it(torque: float, cycle: float, share: float) -> None:
    with pytest.raises(SessionStoppedError) as found:
        move(slow(torque, cycle), hangs=share * cycle)
    assert found.value.stop.limit in ("repeated_positions", "saturated_samples", "tracking_error")


@pytest.mark.parametrize("torque", [5.0, 30.0])
def test_too_small_a_torque_is_told_with_its_likely_cause(torque: float) -> None:
    with pytest.raises(SessionStoppedError, match=r"PL\[1\].*too small for this motion") as found:
        move(slow(torque, 6.0))
    assert found.value.stop.limit == "saturated_samples"
