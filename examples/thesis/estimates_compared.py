"""Figures 6-8 to 6-10 on an emulated bench: good and poor estimates, torque feedback, identification."""

import math

import numpy as np
from gallery import Gallery, titled
from scenario import (
    BENCH,
    GOOD,
    INITIAL,
    NOISE,
    POOR,
    TRUTH,
    bench_motion,
    controller,
    found,
    hanging_joint,
    wide_motion,
)

import jointid as jid


def draw(gallery: Gallery) -> None:
    """Draw the three; note which adaptation gains of Table 6-1 hold."""
    _good_and_poor(gallery)
    _feedback(gallery)
    _identified(gallery)
    _adaptation(gallery)


def _good_and_poor(gallery: Gallery) -> None:
    level = jid.thesis_joint()
    joints = {"joint as in Table 6-2, good": {**TRUTH, **GOOD}, "joint of chapter 5": TRUTH}
    with gallery.picture("6-8_good_and_poor", 1, 2) as panels:
        for axes, (name, truth) in zip(panels, joints.items(), strict=True):
            runs = jid.simulate_batch(
                level.with_parameters(truth),
                [controller(level, {**TRUTH, **values}) for values in (GOOD, POOR)],
                bench_motion(),
                sensors=NOISE,
                recordings=True,
            )
            jid.plot.tracking_error(dict(zip(("good", "poor"), runs.recordings, strict=True)), axes)
            titled(axes, f"6-8: {name}")
            ratio = runs.error[1] / runs.error[0]
            gallery.note("6-8", f"{name}: poor / good", ratio, "", "above 1")


def _feedback(gallery: Gallery) -> None:
    level = jid.thesis_joint()
    true = level.with_parameters(TRUTH)
    with_it = controller(level, TRUTH)
    hand = jid.Link(mass=100.0 / 9.817, centre_of_mass=0.5, inertia=100.0 / 9.817 * 0.25)
    cases: dict[str, jid.Link | float] = {"link alone": 0.0, "link and 100 N at its end": hand}
    with gallery.picture("6-9_torque_feedback", 1, 2) as panels:
        for axes, (name, payload) in zip(panels, cases.items(), strict=True):
            runs = jid.simulate_batch(
                true,
                [with_it, with_it.replace(torque_feedback=False)],
                jid.Trajectory.thesis(),
                sensors=NOISE,
                payload=payload,
                recordings=True,
            )
            named = ("with torque sensor", "without")
            jid.plot.tracking_error(dict(zip(named, runs.recordings, strict=True)), axes)
            titled(axes, f"6-9: {name}, about the horizontal")
            ratio = runs.error[1] / runs.error[0]
            gallery.note("6-9", f"{name}: without / with", ratio, "", "greatly enhances")


def _identified(gallery: Gallery) -> None:
    """Table 6-3: start from the initial estimates, identify from that run, run again."""
    cases = {
        "joint of chapter 5, ±60° about the vertical": (hanging_joint(), TRUTH, wide_motion()),
        "joint of Table 6-3, 4° about the horizontal": (jid.thesis_joint(), BENCH, bench_motion()),
    }
    with gallery.picture("6-10_identified", 1, 2) as panels:
        for axes, (name, (joint, truth, motion)) in zip(panels, cases.items(), strict=True):
            true = joint.with_parameters(truth)
            before = jid.simulate(true, controller(joint, INITIAL), motion, sensors=NOISE)
            estimate = jid.identify(before, joint)
            after = jid.simulate_batch(
                true,
                [controller(joint, values) for values in (found(estimate), truth)],
                motion,
                sensors=NOISE,
                recordings=True,
            )
            named = ("initial (Table 6-3)", "identified", "true parameters")
            runs = dict(zip(named, (before, *after.recordings), strict=True))
            jid.plot.tracking_error(runs, axes)
            titled(axes, f"6-10: {name}")
            gallery.note("6-10", f"{name}: identified / true", after.error[0] / after.error[1])
            first = before.tracking_error()[len(before.time) // 6 :]
            ratio = math.sqrt(float(np.mean(first**2))) / after.error[0]
            gallery.note("6-10", f"{name}: initial / identified", ratio, "", "above 1")
            for key, value in found(estimate).items():
                off = 100.0 * (value / truth[key] - 1.0)
                gallery.note("Table 6-3", f"{name}: {key} off by", off, "%")
            gallery.note("Table 6-3", f"{name}: warnings", len(estimate.warnings))


def _adaptation(gallery: Gallery) -> None:
    """With an encoder, at 2 ms and with true estimates, the gain that holds falls with the motion's speed."""
    joint = hanging_joint()
    true = joint.with_parameters(TRUTH)
    gains = (0.0002, 0.0005, 0.001, 0.005)
    laws = [
        jid.AdaptiveRobust.from_motor_side(gear_ratio=101.0, adaptation_gain=gain).replace(
            **jid.control_estimates(true)
        )
        for gain in gains
    ]
    for degrees, cycle in ((60.0, 3.0), (60.0, 6.0), (20.0, 6.0)):
        runs = jid.simulate_batch(
            true,
            laws,
            jid.Trajectory.thesis(math.radians(degrees), cycle=cycle),
            sensors=jid.Sensors(encoder_counts=8000, velocity="counts", torque_noise=0.5),
            control_period=2e-3,
        )
        holds = [gain for gain, error in zip(gains, runs.error, strict=True) if error < 1e-3]
        what = f"±{degrees:g}° in {cycle:g} s: largest adaptation gain that holds"
        gallery.note("Table 6-1", what, max(holds, default=0.0), "", "0.005")
