"""Figures 6-12 to 6-18: a strain-wave gear's ripple in closed and in open loop, and the raw friction maps."""

import math

import numpy as np
from gallery import Gallery, titled
from scenario import TRUTH, controller, errors, found, hanging_joint

import jointid as jid

RIPPLE = 2.6  # N·m: 0.4 % of the gear's 650 N·m, twice a turn of the motor
DURATION = 12.0
Run = jid.SimulatedRecording
ENCODER = jid.Sensors(encoder_counts=8000, velocity="counts", torque_noise=0.5)


def rippled_joint(amplitude: float) -> jid.Joint:
    """A gear whose torque ripples with the motor's angle."""
    joint = hanging_joint()
    joint = joint.replace(model=joint.model.replace(ripple=(2,)))
    return joint.with_parameters({**TRUTH, "ripple_sin_2": amplitude, "ripple_cos_2": 0.0})


def closed_loop(amplitude: float) -> Run:
    """A motion of 20 degrees, controlled with the true parameters."""
    return jid.simulate(
        rippled_joint(amplitude),
        controller(hanging_joint(), TRUTH),
        jid.Trajectory.thesis(duration=DURATION),
        control_period=2e-3,
        sensors=ENCODER,
    )


def open_loop(amplitude: float, *, size: float = 48.0, rate: float = 0.05) -> Run:
    """The drive pushes with a sine; slowly by default, so that its own inertia takes little of the torque."""
    push = jid.Trajectory.sine(size, rate, duration=2.0 / rate)
    return jid.simulate(
        rippled_joint(amplitude),
        jid.OpenLoop(),
        push,
        control_period=2e-3,
        sensors=ENCODER,
    )


def swing(run: Run, signal: np.ndarray) -> float:
    """Amplitude at twice the motor's angle, while the joint moves at half its peak speed or more."""
    speed = np.abs(run.truth.signals["velocity"])
    angle = 2.0 * 101.0 * run.truth.signals["position"]
    square = []
    for part in _stretches(speed > 0.5 * speed.max()):
        time = np.linspace(-1.0, 1.0, part.stop - part.start)
        waves = np.column_stack([np.sin(angle[part]), np.cos(angle[part])])
        slow = np.polynomial.polynomial.polyvander(time, 6)
        found, *_ = np.linalg.lstsq(np.column_stack([waves, slow]), signal[part], rcond=None)
        square.append(found[0] ** 2 + found[1] ** 2)
    return math.sqrt(float(np.median(square)))


def _stretches(moving: np.ndarray) -> list[slice]:
    edges = np.flatnonzero(np.diff(np.concatenate([[0], moving.astype(np.int8), [0]])))
    return [
        slice(int(first), int(last))
        for first, last in zip(edges[::2], edges[1::2], strict=True)
        if last - first > 50
    ]


def draw(gallery: Gallery) -> None:
    """Draw both loops."""
    loops = {"closed": closed_loop(RIPPLE), "open": open_loop(RIPPLE)}
    true = hanging_joint().with_parameters(TRUTH)
    closed, opened = loops.values()
    with gallery.picture("6-12_to_6-14_closed_loop", 1, 3, size=(12.5, 3.4)) as panels:
        titled(jid.plot.signal(closed, "torque", panels[0]), "6-12: closed loop, commanded torque")
        titled(jid.plot.signal(closed, "velocity", panels[1]), "6-13: closed loop, velocity")
        jid.plot.torque_over_velocity(closed, panels[2], sensed_by=true, curve=true)
        titled(panels[2], "6-14: closed loop, friction map")
    with gallery.picture("6-15_to_6-18_open_loop", 2, 2) as panels:
        titled(jid.plot.signal(opened, "torque", panels[0]), "6-15: open loop, commanded torque")
        titled(jid.plot.signal(opened, "velocity", panels[1]), "6-16: open loop, velocity")
        jid.plot.torque_over_velocity(opened, panels[2], curve=true)
        titled(panels[2], "6-17: open loop, torque as commanded")
        jid.plot.torque_over_velocity(opened, panels[3], sensed_by=true, curve=true)
        titled(panels[3], "6-18: open loop, sensed torque subtracted")
    for figure, name in (("6-12", "closed"), ("6-15", "open")):
        run = loops[name]
        assert run.torque is not None
        gallery.note(figure, f"{name} loop: torque at the ripple", swing(run, run.torque), "N·m")
        rate = run.truth.signals["velocity"]
        gallery.note(
            figure.replace("12", "13").replace("15", "16"),
            f"{name} loop: velocity at the ripple",
            1e3 * swing(run, rate),
            "mrad/s",
        )
    _maps(gallery, opened, "")
    _maps(gallery, open_loop(RIPPLE, size=54.0, rate=0.25), ", five times faster")
    for name, run in loops.items():
        plain = jid.identify(run, hanging_joint(), residual="sensor")  # the residual of the thesis
        modelled = jid.identify(
            run, hanging_joint(), model=jid.Model(ripple=(2,)), residual="sensor"
        )
        for how, estimate in (("without", plain), ("with", modelled)):
            worst = max(map(abs, errors(found(estimate)).values()))
            what = f"{name} loop, identified {how} ripple=(2,): worst parameter off by"
            gallery.note("6-14" if name == "closed" else "6-18", what, worst, "%")
        size = math.hypot(*(modelled.parameters[f"ripple_{w}_2"].value for w in ("sin", "cos")))
        gallery.note("6-14" if name == "closed" else "6-18", f"{name} loop: ripple", size, "N·m")


def _maps(gallery: Gallery, run: Run, how: str) -> None:
    """How far each map lies from the friction that acted, while the joint moves."""
    assert run.torque is not None
    assert run.sensor is not None
    friction = run.truth.signals["friction"]
    moving = np.abs(run.truth.signals["velocity"]) > 0.05
    sensed = TRUTH["sensor_gain"] * run.sensor + TRUTH["sensor_offset"]
    less = run.torque - sensed
    inertia = jid.control_estimates(hanging_joint().with_parameters(TRUTH))["inertia"]
    for figure, name, torque in (
        ("6-17", "torque as commanded", run.torque),
        ("6-18", "sensed torque subtracted", less),
        ("6-18", "and the drive's inertia", less - inertia * run.truth.signals["acceleration"]),
    ):
        off = float(np.sqrt(np.mean((torque - friction)[moving] ** 2)))
        gallery.note(figure, f"{name}: rms distance from friction{how}", off, "N·m")
