"""`jid.plot` and the reports draw the same picture: the numbers in Matplotlib's axes are those of the panel."""

import functools
from collections.abc import Callable, Iterator
from types import SimpleNamespace
from typing import Any

import matplotlib
import numpy as np
import pytest

matplotlib.use("Agg")
from closed_loop import TRUTH, thesis_joint, well_excited, wrong_controller
from designs import designed
from drawn_pictures import Picture as Svg
from matplotlib import pyplot
from matplotlib.axes import Axes
from simulated_servo import Truth, bench_runs, servo_joint, with_truth

import jointid as jid
from jointid.panels.design import motion, sampled_velocities
from jointid.panels.friction import friction_map
from jointid.panels.marks import (
    Band,
    Bars,
    Level,
    Line,
    Mark,
    Panel,
    Points,
    Range,
    Shade,
    numbers,
)
from jointid.panels.recorded import signals
from jointid.panels.rollout import rolled_out
from jointid.panels.rows import NamedRow, rows_panel
from jointid.panels.search import convergence
from jointid.panels.session import tracking
from jointid.panels.study import study_pictures
from jointid.panels.windows import window_means
from jointid.plot.drawing import draw
from jointid.report.drawing.picture import drawn

DESIGN = designed()
EVERY = Panel(
    across="time [s]",
    up="torque [N·m]",
    marks=(
        Shade(start=[0.5, 2.0], stop=[1.0, 2.5], label="left out"),
        Range(low=-1.0, high=2.0, label="reached"),
        Band(across=[0.0, 1.0, 3.0], low=[0.0, 1.0, 2.0], high=[1.0, 3.0, 2.5], label="band"),
        Bars(edges=[0.0, 1.0, 3.0], up=[2.0, 5.0], look="second", label="bars"),
        Line(across=[0.0, 1.0, 2.0, 3.0], up=[0.0, np.nan, 1.0, 2.0], label="line"),
        Line(across=[0.0, 3.0], up=[1.0, 1.5], look="third", series=True, label="of a series"),
        Line(across=[0.0, 3.0], up=[2.0, 1.5], look="fourth", dashed=True, label="dashed"),
        Points(across=[0.2, 0.4], up=[0.0, 1.0], look="measured", label="points"),
        Level(up=4.0, look="fifth", label="level"),
    ),
    right=(Line(across=[0.0, 3.0], up=[10.0, 20.0], look="second", label="other unit"),),
    right_up="force [N]",
)
ROWS = rows_panel(
    [
        NamedRow(name="first", value=2.0, error=0.5, single=[1.0, 3.0], chosen=True),
        NamedRow(name="second", value=200.0, error=0.2, single=[199.0]),
    ],
    *("residual [%]", "model", ("one part", "mean", "mean of the chosen model")),
    logarithmic=True,
)
LOGARITHMIC = Panel(
    across="generation",
    up="penalty",
    marks=(Line(across=[1.0, 10.0, 100.0], up=[1e3, 10.0, 0.1]),),
    logarithmic=True,
    logarithmic_across=True,
)


@pytest.fixture(autouse=True)
def _closed() -> Iterator[None]:
    yield
    pyplot.close("all")


@functools.cache
def run() -> jid.SimulatedRecording:
    return jid.simulate(
        thesis_joint().with_parameters(TRUTH), wrong_controller(), well_excited(3.0)
    )


@functools.cache
def estimate() -> jid.Estimate:
    search = jid.Search(ga=jid.GaOptions(generations=3))
    return jid.identify(run(), thesis_joint(), search=search)


@functools.cache
def rollout() -> jid.Rollout:
    return jid.rollout(with_truth(Truth(), servo_joint()), bench_runs(Truth(), seed=1)[:1])


def study(**grid: Any) -> jid.Study:
    search = jid.Search(ga=jid.GaOptions(population=20, generations=3))
    return jid.sweep(run(), thesis_joint(), grid=grid, trials=2, search=search)


def session() -> Any:
    """What is drawn of a session with two runs."""
    runs = []
    for name, shift in (("initial", 2e-3), ("cycle 1", 1e-3)):
        recording = jid.Recording(
            time=run().time, position=run().position, reference=run().position + shift
        )
        runs.append(SimpleNamespace(name=name, recording=recording, tracking_error=shift))
    return SimpleNamespace(runs=tuple(runs), true_run=None)


def followed() -> Axes:
    return jid.plot.tracking_error({each.name: each.recording for each in session().runs})


def of_study(**grid: Any) -> tuple[list[Axes], list[Panel]]:
    swept = study(**grid)
    picture = study_pictures(swept)[0]
    return [jid.plot.sweep(swept, value="error.worst")], list(picture.panels)


PAIRS: dict[str, Callable[[], tuple[list[Axes], list[Panel]]]] = {
    "friction map": lambda: (
        [jid.plot.friction_map(None, estimate())],
        [*friction_map(estimate()).panels],
    ),
    "friction map of another recording": lambda: (
        [jid.plot.friction_map(run()[:2.0], estimate())],
        [*friction_map(estimate(), estimate().predict(run()[:2.0]).windows).panels],
    ),
    "windows": lambda: (
        [jid.plot.window_means(estimate()), jid.plot.residuals(estimate())],
        [*window_means(estimate()).panels],
    ),
    "convergence": lambda: (
        [jid.plot.convergence(estimate())],
        [*convergence(estimate()).panels],
    ),
    "design": lambda: (
        [*jid.plot.designed_motion(DESIGN)],
        [*motion(DESIGN).panels, *sampled_velocities(DESIGN).panels],
    ),
    "rollout": lambda: (
        [jid.plot.rolled_out(rollout())],
        [*rolled_out(rollout().runs[0]).panels],
    ),
    "tracking": lambda: ([followed()], [*tracking(session()).panels]),
    "study over numbers": lambda: of_study(windows=[20, 40, 60]),
    "study over words": lambda: of_study(model=["stribeck", "coulomb_viscous"]),
}


@pytest.mark.parametrize("kind", PAIRS)
def test_both_faces_draw_the_same_numbers(kind: str) -> None:
    axes, panels = PAIRS[kind]()
    assert len(axes) == len(panels)
    for each, panel in zip(axes, panels, strict=True):
        require_drawn(each, panel)
        require_in_svg(panel)


def test_a_signal_is_that_of_the_report() -> None:
    nothing = np.zeros(0)
    for panel in signals(run(), nothing, nothing).panels:
        name = panel.up.partition(" [")[0].replace(" ", "_")
        axes = jid.plot.signal(run(), name)
        assert axes.get_ylabel() == panel.up
        require_lines(axes, [mark for mark in panel.marks if isinstance(mark, Line)])


def test_a_design_that_stands_still_or_has_no_friction_is_drawn() -> None:
    still = jid.Trajectory.sines(amplitude=[0.0], frequency=[1.0], phase=[0.0], duration=6.0)
    for changes in ({"trajectory": still}, {"joint": jid.Joint(inertia=1.0)}):
        design = designed(**changes)
        (panel,) = sampled_velocities(design).panels
        assert not panel.right
        require_drawn(jid.plot.designed_motion(design)[2], panel)
        require_in_svg(panel)


def test_no_renderer_skips_a_mark() -> None:
    assert {type(mark) for mark in EVERY.marks} == set(Mark.__subclasses__())
    for panel in (EVERY, ROWS, LOGARITHMIC):
        require_drawn(draw(pyplot.subplots()[1], panel), panel)
        require_in_svg(panel)


def test_a_mark_that_matplotlib_does_not_know_is_refused() -> None:
    alien: Any = SimpleNamespace(look="fitted", label="")
    with pytest.raises(NotImplementedError):
        draw(pyplot.subplots()[1], Panel(across="a", up="b", marks=(alien,)))


def require_drawn(axes: Axes, panel: Panel) -> None:
    """All marks of the panel are in the axes, in their order, and nothing else is."""
    require_lines(axes, [each for each in panel.marks if isinstance(each, Line | Points | Level)])
    patches: list[Any] = list(axes.patches)
    areas: list[Any] = list(axes.collections)
    for mark in panel.marks:
        if isinstance(mark, Bars):
            bars = [patches.pop(0) for _ in numbers(mark.up)]
            same([bar.get_height() for bar in bars], mark.up)
            same([bar.get_x() for bar in bars], numbers(mark.edges)[:-1])
            same([bar.get_x() + bar.get_width() for bar in bars], numbers(mark.edges)[1:])
        elif isinstance(mark, Shade):
            for ends in zip(numbers(mark.start), numbers(mark.stop), strict=True):
                same(extent(patches.pop(0)).intervalx, ends)
        elif isinstance(mark, Range):
            same(extent(patches.pop(0)).intervaly, [mark.low, mark.high])
        elif isinstance(mark, Band):
            corners = {tuple(c) for p in areas.pop(0).get_paths() for c in p.vertices.tolist()}
            for edge in (mark.low, mark.high):
                points = np.column_stack([numbers(mark.across), numbers(edge)])
                assert {tuple(p) for p in points.tolist() if np.isfinite(p).all()} <= corners
    assert not patches
    assert not areas
    assert (axes.get_xlabel(), axes.get_ylabel()) == (panel.across, panel.up)
    scales = (axes.get_xscale() == "log", axes.get_yscale() == "log")
    assert scales == (panel.logarithmic_across, panel.logarithmic)
    if panel.names:
        assert [text.get_text() for text in axes.get_yticklabels()] == [*panel.names]
        same(axes.get_yticks(), -np.arange(float(len(panel.names))))
    figure: Any = axes.figure
    beside = [each for each in figure.axes if str(each.yaxis.get_label_position()) == "right"]
    beside = [each for each in beside if each in axes.get_shared_x_axes().get_siblings(axes)]
    assert len(beside) == bool(panel.right)
    for each in beside:
        require_lines(each, panel.right)
        assert each.get_ylabel() == panel.right_up
    legend = axes.get_legend()
    shown = [] if legend is None else [text.get_text() for text in legend.get_texts()]
    assert sorted(shown) == sorted(m.label for m in (*panel.marks, *panel.right) if m.label)


def require_lines(axes: Axes, marks: Any) -> None:
    assert len(axes.lines) == len(marks)
    for line, mark in zip(axes.lines, marks, strict=True):
        if isinstance(mark, Level):
            same(line.get_ydata(), [mark.up, mark.up])
        else:
            same(line.get_xdata(), mark.across)
            same(line.get_ydata(), mark.up)


def require_in_svg(panel: Panel) -> None:
    """There is a path for each mark, in its look."""
    svg = Svg(str(drawn([panel], "a picture")))
    kinds = {"line", "dashed", "points", "band", "bars", "shade"}
    classes = [each.attrib.get("class", "").split() for each in svg.after_axes()]
    looks = [each[-1] for each in classes if each and each[0] in kinds]
    assert looks == [mark.look for mark in (*panel.marks, *panel.right)]


def same(drawn: Any, wanted: Any) -> None:
    np.testing.assert_allclose(np.asarray(drawn, dtype=float), numbers(wanted), rtol=1e-12)


def extent(patch: Any) -> Any:
    return patch.get_path().transformed(patch.get_patch_transform()).get_extents()
