"""Recorders' exports: each channel, or group of channels, has a time column of its own."""

from pathlib import Path

import numpy as np
import pytest
from recording_files import refusal, written

from jointid.recording.readers.loading import load

N = 400
TIME = 0.005 * np.arange(N)
POSITION = np.round(0.8 * np.sin(5.0 * TIME), 9)
VELOCITY = np.round(4.0 * np.cos(5.0 * TIME), 9)
TORQUE = np.round(3.0 * np.sign(VELOCITY) + VELOCITY, 9)
PERIODIC = [*zip(TIME, POSITION, TIME, VELOCITY, TIME, TORQUE, strict=True)]


def rows(scale: float = 1.0, separator: str = ",", comma: bool = False) -> list[str]:
    """Pairs of time and value; the scale is that of the times."""
    found = []
    for cells in PERIODIC:
        shown = [
            f"{cell * scale:.9g}" if k % 2 == 0 else repr(float(cell))
            for k, cell in enumerate(cells)
        ]
        line = separator.join(shown)
        found.append(line.replace(".", ",") if comma else line)
    return found


@pytest.mark.parametrize(
    "lines",
    [
        ["Position actual,,Velocity actual,,Torque actual,", "X,Y,X,Y,X,Y", *rows(1000.0)],
        [",Position actual,,Velocity actual,,Torque actual", "X,Y,X,Y,X,Y", *rows()],
        [
            "Recorder 3",
            "Position;;Velocity;;Torque;",
            "X [s];Y;X [s];Y;X [s];Y",
            *rows(1.0, ";", comma=True),
        ],
        [
            "Time\tPosition\tTime\tVelocity\tTime\tTorque",
            "ms\trad\tms\trad/s\tms\tNm",
            *rows(1e3, "\t"),
        ],
        ["time_ms,position_rad,time_ms,velocity_rad_s,time_ms,torque_Nm", *rows(1000.0)],
        ["t_1;position [rad];t_2;velocity [rad/s];t_3;torque [Nm]", *rows(1.0, ";")],
    ],
)
@pytest.mark.parametrize("end", ["\n", "\r\n"])
def test_pairs_are_read_as_one_table(lines: list[str], end: str, tmp_path: Path) -> None:
    recording = load(written(tmp_path / "a.csv", end.join(lines)))
    assert recording.time == pytest.approx(TIME)
    assert recording.position.tolist() == POSITION.tolist()
    assert recording.velocity.tolist() == VELOCITY.tolist()
    assert recording.torque is not None
    assert recording.torque.tolist() == TORQUE.tolist()


def test_milliseconds_that_only_the_steps_show_are_said(tmp_path: Path) -> None:
    lines = [
        "Position,,Torque,",
        "X,Y,X,Y",
        *(f"{5 * k},{POSITION[k]},{5 * k},{TORQUE[k]}" for k in range(N)),
    ]
    recording = load(written(tmp_path / "a.csv", lines))
    assert recording.metadata["recognised_units"] == {"time": "ms"}


def test_a_slower_channel_is_interpolated_and_said(tmp_path: Path) -> None:
    lines = ["Position [rad],,Torque [Nm],", "X [s],Y,X [s],Y"]
    for k in range(N):
        slow = f"{TIME[2 * k]},{TORQUE[2 * k]}" if 2 * k < N else ","
        lines.append(f"{TIME[k]},{POSITION[k]},{slow}")
    recording = load(written(tmp_path / "a.csv", lines))
    assert recording.torque is not None
    assert recording.torque[::2].tolist() == TORQUE[::2].tolist()
    assert "Torque [Nm]" in recording.metadata["interpolated"]


def test_a_table_with_two_clocks_of_other_names_stays_a_table(tmp_path: Path) -> None:
    lines = [
        "time,position,timestamp,torque",
        *(f"{TIME[k]},{POSITION[k]},{k},{TORQUE[k]}" for k in range(N)),
    ]
    assert load(written(tmp_path / "a.csv", lines)).time.tolist() == TIME.tolist()


def test_pairs_without_names_are_asked_about(tmp_path: Path) -> None:
    assert "recognised as" in refusal(written(tmp_path / "a.csv", ["X,Y,X,Y,X,Y", *rows()]))
