"""What a session shows while it runs: the console's line and the live plot, without a terminal or a display."""

import io
import itertools
import math
import os
import re
import threading
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from session_bench import devices, session

from jointid.base.errors import InputError
from jointid.hardware.emulated.bus import EmulatedBus
from jointid.hardware.live.console import ConsoleLine, Observers, console_line
from jointid.hardware.live.plot import LivePlot
from jointid.hardware.session.drive import DriveSample

SAMPLE = DriveSample(time=0.0, position=math.radians(30.0), reading=12.34)


class Terminal(io.StringIO):
    """Where a line can be drawn over."""

    def isatty(self) -> bool:
        return True


class Time:
    """A clock set by hand."""

    def __init__(self) -> None:
        self.time = 50.0

    def __call__(self) -> float:
        return self.time


def test_a_line_has_phase_time_position_error_torque_and_sensor() -> None:
    line = console_line("run", 1.5, SAMPLE, math.radians(29.5), -12.5)
    assert line == (
        "run       1.50 s  position   30.000°  error  +0.5000°  torque   -12.50 N·m  sensor    12.3"
    )
    clipped = DriveSample(time=0.0, position=0.0, clipped=True)
    assert console_line("run", 0.0, clipped, 0.0, 0.0).endswith("sensor clipped")


def fed(stream: io.StringIO, cycles: int, period: float, phase_of: Any) -> str:
    clock = Time()
    with ConsoleLine(stream, now=clock) as line:
        for k in range(cycles):
            clock.time = 50.0 + k * period
            line(phase_of(k), k * period, SAMPLE, 0.0, 0.0)
    return stream.getvalue()


def test_on_a_terminal_one_line_is_redrawn_ten_times_a_second_at_most() -> None:
    text = fed(Terminal(), 1001, 2e-3, lambda k: "move" if k < 500 else "run")
    assert text.count("\n") == 1
    assert text.endswith("\n")
    assert text.startswith("\r")
    drawn = text.count("\r")
    assert (
        1 <= drawn <= 22
    )  # twenty in two seconds, the first and the last; one that waits is skipped
    assert "2.00 s" in text.splitlines()[-1].rpartition("\r")[2]


def test_a_shorter_line_leaves_nothing_of_a_longer_one() -> None:
    stream, clock = Terminal(), Time()
    with ConsoleLine(stream, now=clock) as line:
        line("settling in", 0.0, SAMPLE, 0.0, 1e6)
        while not stream.getvalue():
            threading.Event().wait(0.001)
        clock.time += 1.0
        line("run", 0.0, SAMPLE, 0.0, 0.0)
    first, second = stream.getvalue().strip("\r\n").split("\r")
    assert len(second) == len(first)


def test_elsewhere_a_line_a_second_and_one_for_each_phase() -> None:
    text = fed(io.StringIO(), 2001, 2e-3, lambda k: "move" if k < 700 else "run")
    assert "\r" not in text
    found = [(line.split()[0], float(line.split()[1])) for line in text.splitlines()]
    assert found == [
        ("move", 0.0),
        ("move", 1.0),
        ("run", 1.4),
        ("run", 2.4),
        ("run", 3.4),
        ("run", 4.0),
    ]


class Gone(Terminal):
    """A terminal that was closed."""

    def write(self, _: str) -> int:
        raise OSError("gone")


def test_a_console_that_has_gone_does_not_stop_a_session() -> None:
    bus = EmulatedBus(*devices())
    with ConsoleLine(Gone()) as line:
        recording = session(bus, observer=line).run()
    bus.shutdown()
    assert recording is not None


def test_a_sessions_line_ends_with_the_run() -> None:
    stream = io.StringIO()
    bus = EmulatedBus(*devices())
    # On a clock that stands still, or a slow machine would add a line a second.
    with ConsoleLine(stream, now=lambda: 0.0) as line:
        session(bus, observer=line).run()
    bus.shutdown()
    lines = stream.getvalue().splitlines()
    assert [line.split()[0] for line in lines] == ["move", "settle", "run", "run"]
    assert re.fullmatch(r"run +1\.00 s .*", lines[-1])  # 0.998 s


def test_several_observers_are_called_and_closed_each() -> None:
    wording: list[str] = []

    class Closing:
        def __init__(self, name: str) -> None:
            self.name = name

        def __call__(self, phase: str, *_: object) -> None:
            wording.append(f"{self.name} {phase}")

        def close(self) -> None:
            wording.append(f"{self.name} closed")
            raise RuntimeError(self.name)

    def plain(phase: str, *_: object) -> None:
        wording.append(f"plain {phase}")

    with (
        pytest.raises(RuntimeError, match="a"),
        Observers(Closing("a"), plain, Closing("b")) as all_of_them,
    ):
        all_of_them("run", 0.0, SAMPLE, 0.0, 0.0)
    assert wording == ["a run", "plain run", "b run", "a closed", "b closed"]


def test_what_comes_through_the_pipe_ends_as_a_picture(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    from matplotlib import pyplot

    from jointid.hardware.live.plot import POINT
    from jointid.hardware.live.window import main

    picture = tmp_path / "live.png"
    reading, writing = os.pipe()
    os.write(writing, b"".join(POINT.pack(0.1 * k, 0.5, 0.4, 1.0, 2.0) for k in range(50)))
    os.close(writing)
    words = ["window", "--span", "10", "--no-window", "--picture", str(picture)]
    monkeypatch.setattr("sys.argv", words)
    with os.fdopen(reading, "rb") as pipe:
        monkeypatch.setattr("sys.stdin", pipe)
        assert main() == 0
    pyplot.close("all")
    assert picture.read_bytes().startswith(b"\x89PNG")


@pytest.mark.slow
def test_a_live_plot_of_a_session_ends_as_a_picture(tmp_path: Path) -> None:
    picture = tmp_path / "live.png"
    bus = EmulatedBus(*devices())
    with LivePlot(picture=picture, window=False) as plot:
        recording = session(bus, observer=plot).run()
    bus.shutdown()
    assert recording is not None
    assert plot.dropped == 0
    assert picture.read_bytes().startswith(b"\x89PNG")
    plot.close()  # a second time does nothing


@pytest.mark.parametrize(
    ("wrong", "wording"),
    [
        ({"span": 0.0}, "span is 0.0: more than 0 s is expected"),
        ({"window": False}, "without a window or a picture"),
    ],
)
def test_a_plot_of_nothing_is_refused(wrong: dict[str, Any], wording: str) -> None:
    with pytest.raises(InputError, match=wording):
        LivePlot(**wrong)


class StandIn:
    """Instead of another interpreter: a pipe that nobody, or only the test, reads."""

    def __init__(self, command: list[str], stdin: int) -> None:
        del command, stdin
        self.reading, writing = os.pipe()
        self.stdin = os.fdopen(writing, "wb", buffering=0)

    def wait(self) -> int:
        return 0


@pytest.fixture
def windowless(monkeypatch: pytest.MonkeyPatch) -> list[StandIn]:
    begun: list[StandIn] = []

    def begin(*args: Any, **more: Any) -> StandIn:
        begun.append(StandIn(*args, **more))
        return begun[-1]

    monkeypatch.setattr("subprocess.Popen", begin)
    return begun


def test_a_window_that_does_not_keep_up_never_holds_the_loop(windowless: list[StandIn]) -> None:
    clock = Time()
    plot = LivePlot(now=clock)
    (pipe,) = windowless
    for k in range(200_000):  # nobody reads: a blocking write would hang here
        clock.time = 50.0 + k * 2e-3
        plot("run", k * 2e-3, SAMPLE, 0.0, 0.0)
    assert plot.dropped > 10_000
    os.close(pipe.reading)  # and nobody will
    plot("run", 1e6, SAMPLE, 0.0, 0.0)
    plot.close()


def test_points_are_decimated_in_order_and_go_on_over_the_phases(windowless: list[StandIn]) -> None:
    from jointid.hardware.live.plot import POINT

    clock = Time()
    plot = LivePlot(now=clock)
    (pipe,) = windowless
    for k, (phase, when) in enumerate(
        [("move", k * 2e-3) for k in range(500)] + [("run", k * 2e-3) for k in range(500)]
    ):
        clock.time = 50.0 + k * 2e-3
        plot(phase, when, SAMPLE, 0.25, 2.0)
    plot.close()
    points = list(POINT.iter_unpack(os.read(pipe.reading, 1 << 20)))
    os.close(pipe.reading)
    times = [point[0] for point in points]
    assert 95 <= len(times) <= 101  # fifty in each second
    assert all(b - a >= 0.02 - 1e-9 for a, b in itertools.pairwise(times))
    assert times[-1] == pytest.approx(2.0, abs=0.03)
    assert points[0][1:] == (SAMPLE.position, 0.25, 2.0, SAMPLE.reading)


def test_the_panels_show_the_newest_span() -> None:
    from matplotlib.figure import Figure

    from jointid.hardware.live.window import Panels

    figure = Figure()
    panels = Panels(figure, 10.0)
    panels.draw()  # nothing yet
    panels.add([(0.1 * k, math.radians(k), 0.0, 5.0, 6.0) for k in range(300)])
    panels.draw()
    axes = figure.axes[0]
    reference, position = axes.lines
    assert np.asarray(position.get_xdata()).min() >= 19.9 - 1e-9
    assert np.asarray(position.get_ydata()).max() == pytest.approx(299.0)
    assert not np.asarray(reference.get_ydata()).any()
    low, high = axes.get_xlim()
    assert low <= 19.9
    assert high >= 29.9
