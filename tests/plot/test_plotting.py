"""Plots show the numbers: curves, units, legends; input that cannot be drawn raises InputError."""

import dataclasses
import functools
import inspect
import math
import re
from collections.abc import Callable, Iterator
from typing import Any

import matplotlib
import numpy as np
import pytest

matplotlib.use("Agg")
from closed_loop import TRUTH, thesis_joint, well_excited, wrong_controller
from cycler import cycler
from matplotlib import pyplot
from matplotlib.axes import Axes
from matplotlib.colors import to_hex
from simulated_servo import Truth, bench_runs, servo_joint, with_truth

import jointid as jid
from jointid.joint.units import parameter_unit
from jointid.panels.palette import LIGHT, LOOKS

TRUE = thesis_joint().with_parameters(TRUTH)


@pytest.fixture(autouse=True)
def _closed() -> Iterator[None]:
    yield
    pyplot.close("all")


@pytest.fixture(scope="module")
def run() -> jid.SimulatedRecording:
    return jid.simulate(TRUE, wrong_controller(), well_excited(3.0))


def _at(axes: Axes, curve: int, velocity: float) -> float:
    x, y = (np.asarray(values, dtype=float) for values in axes.lines[curve].get_data())
    known = np.isfinite(y)
    return float(np.interp(velocity, x[known], y[known]))


def _legend(axes: Axes) -> list[str]:
    legend = axes.get_legend()
    assert legend is not None
    return [text.get_text() for text in legend.get_texts()]


def test_friction_curves_are_the_models(run: jid.SimulatedRecording) -> None:
    estimate = jid.identify(run, thesis_joint())
    axes = jid.plot.friction_curves({"true": TRUE, "found": estimate}, peak=0.4)
    wanted = 25.0 + 20.0 * math.exp(-100.0 * 0.2**2) + 20.0 * 0.2
    assert _at(axes, 0, 0.2) == pytest.approx(wanted, abs=1e-3)
    assert _at(axes, 0, -0.2) == pytest.approx(-wanted, abs=1e-3)
    assert _at(axes, 1, 0.2) == pytest.approx(wanted, rel=0.01)
    assert axes.get_ylabel() == "friction [N·m]"
    assert _legend(axes) == ["true", "found"]


def test_curves_differ_without_colour() -> None:
    axes = jid.plot.friction_curves({str(number): TRUE for number in range(6)})
    dashes = [str(jid.plot.line_style(number)["linestyle"]) for number in range(6)]
    assert len(axes.lines) == len(set(dashes)) == 6


@pytest.mark.parametrize(
    ("name", "slope"), [("coulomb", 2.5), ("sensor_offset", 1.5), ("sensor_gain", 0.24 * 4.0)]
)
def test_sensitivity_shifts_the_curve(name: str, slope: float) -> None:
    axes = jid.plot.sensitivity(TRUE, name, reading=4.0)
    for speed in (0.01, 0.3, 0.59):
        middle, above, below = (_at(axes, curve, speed) for curve in range(3))
        assert above - middle == pytest.approx(slope, abs=1e-9)
        assert middle - below == pytest.approx(slope, abs=1e-9)


def test_sensitivity_reaches_beyond_the_bounds() -> None:
    joint = thesis_joint().with_parameters({**TRUTH, "viscous": 40.0})  # its upper bound
    axes = jid.plot.sensitivity(joint, "viscous")
    assert _at(axes, 1, 0.5) - _at(axes, 0, 0.5) == pytest.approx(2.0, abs=1e-3)


def test_convergence_claims_no_polish_that_was_not(run: jid.SimulatedRecording) -> None:
    options = jid.GaOptions(population=20, generations=5)
    for polish, label in ((True, "result, with polish"), (False, "result, without polish")):
        estimate = jid.identify(
            run, thesis_joint(), search=jid.Search(ga=options.replace(polish=polish))
        )
        assert _legend(jid.plot.convergence(estimate))[-1] == label


def test_style_leaves_a_notebook_drawing() -> None:
    # A back end that is loaded inside the block turns drawing on for good.
    before = matplotlib.is_interactive()
    try:
        matplotlib.interactive(False)
        with jid.plot.style():
            matplotlib.interactive(True)
        assert matplotlib.is_interactive()
        assert matplotlib.rcParams["axes.spines.top"]
    finally:
        matplotlib.interactive(before)


def test_tracking_error_shows_its_rms(run: jid.SimulatedRecording) -> None:
    axes = jid.plot.tracking_error({"before": run})
    late = run.tracking_error()[len(run.time) // 6 :]
    assert f"{1e3 * math.sqrt(float(np.mean(late**2))):.2g}" in _legend(axes)[0]
    assert axes.get_ylabel() == "tracking error [mrad]"
    drawn = np.asarray(axes.lines[0].get_ydata(), dtype=float)
    assert drawn == pytest.approx(1e3 * run.tracking_error())


def test_subtracting_the_sensor_leaves_friction_and_drive(run: jid.SimulatedRecording) -> None:
    axes = jid.plot.torque_over_velocity(run, sensed_by=TRUE, curve=TRUE)
    inertia = jid.control_estimates(TRUE)["inertia"]
    left = run.truth.signals["friction"] + inertia * run.truth.signals["acceleration"]
    drawn = np.asarray(axes.lines[0].get_ydata(), dtype=float)
    fast = np.abs(run.velocity) > 0.2
    assert drawn[fast] == pytest.approx(left[fast], abs=1.0)  # of 60
    assert axes.get_ylabel() == "torque minus sensed link torque [N·m]"


def test_adaptation_draws_the_law_that_acts(run: jid.SimulatedRecording) -> None:
    seen: list[jid.Generation] = []
    options = jid.GaOptions.thesis().replace(population=20, generations=40)
    jid.identify(run, thesis_joint(), search=jid.Search(ga=options, callback=seen.append))
    axes = jid.plot.adaptation(options, seen)
    for law, points in ((0, 1), (2, 3)):
        corner, probability = (
            np.asarray(values, dtype=float) for values in axes.lines[law].get_data()
        )
        diversity, applied = (
            np.asarray(values, dtype=float) for values in axes.lines[points].get_data()
        )
        assert applied == pytest.approx(np.interp(diversity, corner, probability), abs=1e-12)


def test_trajectory_and_signal_carry_units(run: jid.SimulatedRecording) -> None:
    motion = jid.plot.trajectory(well_excited(), "acceleration")
    assert motion.get_ylabel() == "desired acceleration [rad/s²]"
    assert jid.plot.signal({"a": run, "b": run}, "torque").get_ylabel() == "torque [N·m]"


@pytest.mark.parametrize(
    ("draw", "message", "argument"),
    [
        (lambda p: jid.plot.tracking_error(p), "^runs: .* no reference", "runs"),
        (lambda p: jid.plot.tracking_error({"a": p}), "no reference", "runs.a"),
        (lambda _: jid.plot.tracking_error({}), "no recording to draw", "runs"),
        (lambda p: jid.plot.signal({"b": p}, "sensor"), "has no sensor; it has time, ", "runs.b"),
        (lambda p: jid.plot.signal(p, "speed"), "name is 'speed': position, .* or", "name"),
        (lambda p: jid.plot.signal(p, "acceleration"), "is 'acceleration': position", "name"),
        (lambda _: jid.plot.trajectory(well_excited(), "jerk"), "what is 'jerk': position", "what"),
        (lambda _: jid.plot.friction_curves({}), "at least one joint", "joints"),
        (
            lambda _: jid.plot.friction_curves({"empty": jid.thesis_joint()}),
            *("no values for its friction", "joints.empty"),
        ),
        (
            lambda _: jid.plot.sensitivity(TRUE, "stribeck_velocity"),
            *("is 'stribeck_velocity': this parameter has no value; .* are .*coulomb", "parameter"),
        ),
        (
            lambda p: jid.plot.torque_over_velocity(p, sensed_by=TRUE),
            *("no torque sensor to subtract", "recording"),
        ),
        (
            lambda p: jid.plot.torque_over_velocity(p, curve=jid.thesis_joint()),
            *("no values for its friction", "curve"),
        ),
        (lambda p: jid.plot.residuals(p), "an Estimate is expected", "estimate"),
        (lambda p: jid.plot.window_means(p), "an Estimate is expected", "estimate"),
        (lambda p: jid.plot.convergence(p), "an Estimate is expected", "estimate"),
        (lambda p: jid.plot.adaptation(p), "a GaOptions is expected", "options"),
    ],
)
def test_what_cannot_be_drawn_is_refused_before_a_figure_is_made(
    draw: Callable[[Any], object], message: str, argument: str, run: jid.SimulatedRecording
) -> None:
    plain = jid.Recording(time=run.time, position=run.position, torque=run.torque)
    with pytest.raises(jid.InputError, match=message) as caught:
        draw(plain)
    assert caught.value.argument == argument
    assert pyplot.get_fignums() == []


def test_torque_and_the_sensors_parameters_must_be_there(run: jid.SimulatedRecording) -> None:
    bare = jid.Recording(time=run.time, position=run.position)
    with pytest.raises(jid.InputError, match="recording: it has no torque"):
        jid.plot.torque_over_velocity(bare)
    with pytest.raises(jid.InputError, match="sensed_by: values of sensor_gain and sensor_offset"):
        jid.plot.torque_over_velocity(run, sensed_by=jid.thesis_joint())


def test_convergence_of_another_search_is_refused(run: jid.SimulatedRecording) -> None:
    estimate = dataclasses.replace(jid.identify(run, thesis_joint()), convergence=None)
    with pytest.raises(
        jid.InputError, match="estimate: this estimate was made without a genetic search"
    ):
        jid.plot.convergence(estimate)


@pytest.mark.parametrize("name", jid.plot.__all__)
def test_docstrings_are_complete(name: str) -> None:
    """Every parameter, what is returned and what is raised."""
    function = getattr(jid.plot, name)
    text = inspect.getdoc(function) or ""
    signature = inspect.signature(function)
    for parameter in signature.parameters:
        if parameter == "style":
            assert "\n**style\n" in text
            continue
        assert re.search(rf"^(\w+, )*{parameter}(, \w+)* : ", text, re.MULTILINE), parameter
    if "axes" in signature.parameters:
        assert "\nReturns\n" in text
        assert "\nRaises\n" in text
        assert "Default: new axes." in text


def test_parameters_have_the_units_of_the_terms() -> None:
    assert parameter_unit("stribeck") == "s²/rad²"
    assert parameter_unit("viscous", "prismatic") == "N·s/m"
    assert parameter_unit("penalty") == ""


def _drawn(name: str, ax: Any, **style: Any) -> Any:
    """Call a plot function with what it needs."""
    estimate, run = _made()
    drawn: dict[str, Callable[..., Any]] = {
        "adaptation": lambda **k: jid.plot.adaptation(jid.GaOptions(), **k),
        "convergence": lambda **k: jid.plot.convergence(estimate, **k),
        "friction_curves": lambda **k: jid.plot.friction_curves({"found": estimate}, **k),
        "friction_map": lambda **k: jid.plot.friction_map(run, estimate, **k),
        "rolled_out": lambda **k: jid.plot.rolled_out(_rolled(), **k),
        "residuals": lambda **k: jid.plot.residuals(estimate, **k),
        "sensitivity": lambda **k: jid.plot.sensitivity(TRUE, "viscous", **k),
        "signal": lambda **k: jid.plot.signal(run, "torque", **k),
        "torque_over_velocity": lambda **k: jid.plot.torque_over_velocity(run, **k),
        "tracking_error": lambda **k: jid.plot.tracking_error(run, **k),
        "trajectory": lambda **k: jid.plot.trajectory(jid.Trajectory.thesis(), **k),
        "window_means": lambda **k: jid.plot.window_means(estimate, **k),
    }
    return drawn[name](ax=ax, **style)


@functools.cache
def _rolled() -> jid.Rollout:
    return jid.rollout(with_truth(Truth(), servo_joint()), bench_runs(Truth(), seed=1)[:1])


@functools.cache
def _made() -> tuple[jid.Estimate, jid.SimulatedRecording]:
    run = jid.simulate(TRUE, wrong_controller(), well_excited(3.0))
    return jid.identify(
        run, thesis_joint(), search=jid.Search(ga=jid.GaOptions(generations=3))
    ), run


_CURVES = sorted(set(jid.plot.__all__) - {"style", "line_style", "sweep", "designed_motion"})


@pytest.mark.parametrize("name", _CURVES)
def test_keywords_of_curves_are_passed_on_and_axes_are_drawn_into(name: str) -> None:
    ax = pyplot.subplots()[1]
    assert _drawn(name, ax, color="#123456", lw=3.25) is ax
    assert any(line.get_color() == "#123456" and line.get_linewidth() == 3.25 for line in ax.lines)


def test_a_band_has_the_colour_of_its_curve_and_other_marks_keep_theirs() -> None:
    axes = _drawn("friction_map", None, color="#123456")
    assert to_hex(axes.collections[0].get_facecolor()[0]) == "#123456"
    points, curve = axes.lines
    assert (points.get_color(), curve.get_color()) == (LIGHT["measured"], "#123456")


def test_the_palette_is_that_of_the_reports() -> None:
    assert [jid.plot.line_style(number)["color"] for number in range(6)] == [
        LIGHT[look] for look in LOOKS
    ]
    points, curve = _drawn("friction_map", None).lines
    assert (points.get_color(), curve.get_color()) == (LIGHT["measured"], LIGHT["fitted"])


@pytest.mark.parametrize("name", _CURVES)
def test_something_that_is_no_axes_is_refused(name: str) -> None:
    with pytest.raises(jid.InputError, match="axes are expected"):
        _drawn(name, pyplot.figure())
    with pytest.raises(jid.InputError, match="axes to draw into as `ax`"):
        _drawn(name, None, axes=pyplot.subplots()[1])


def test_settings_that_the_user_has_chosen_stay() -> None:
    chosen: Any = {
        "lines.linewidth": 4.0,
        "font.size": 17.0,
        "axes.prop_cycle": cycler(color=["#aa0000", "#00aa00"]),
    }
    with matplotlib.rc_context(chosen):
        axes = jid.plot.friction_curves({"a": TRUE, "b": TRUE})
        assert [line.get_color() for line in axes.lines] == ["#aa0000", "#00aa00"]
        assert {line.get_linewidth() for line in axes.lines} == {4.0}
        assert axes.xaxis.label.get_fontsize() == 17.0
    plain = jid.plot.friction_curves({"a": TRUE})
    assert plain.xaxis.label.get_fontsize() == 9.0
    assert plain.lines[0].get_linewidth() == 1.2
