"""JSON logs: records under a key (BAM), rows under the names of SysId's tests, several runs in one file."""

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from recording_files import refusal, written

import jointid as jid
from jointid.cli import servo
from jointid.cli.command_line import main
from jointid.recording.readers.loading import load, load_runs

TESTS = ("slow-forward", "slow-backward", "fast-forward", "fast-backward")
TURN = 2.0 * np.pi


def motion(number: int = 0, rows: int = 700) -> np.ndarray[Any, np.dtype[np.float64]]:
    """Time, torque, position and velocity of a joint: inertia 0.5, Coulomb friction 3, viscous 1.2."""
    time = 0.01 * np.arange(rows)
    slow, fast = 1.9 + 0.3 * number, 4.4
    position = 0.9 * np.sin(slow * time + number) + 0.3 * np.sin(fast * time)
    velocity = 0.9 * slow * np.cos(slow * time + number) + 0.3 * fast * np.cos(fast * time)
    acceleration = -0.9 * slow**2 * np.sin(slow * time + number)
    acceleration -= 0.3 * fast**2 * np.sin(fast * time)
    torque = 0.5 * acceleration + 3.0 * np.sign(velocity) + 1.2 * velocity
    return np.column_stack([time, torque, position, velocity])


def records(table: np.ndarray[Any, Any]) -> list[dict[str, float]]:
    names = ("timestamp", "torque", "position", "speed")
    return [dict(zip(names, row, strict=True)) for row in table.tolist()]


def saved(path: Path, content: object) -> Path:
    return written(path, json.dumps(content))


def right(recordings: jid.Recording) -> None:
    found = {name: each.value for name, each in jid.identify(recordings).parameters.items()}
    assert found["inertia"] == pytest.approx(0.5, rel=0.01)
    assert found["coulomb"] == pytest.approx(3.0, rel=0.01)
    assert found["viscous"] == pytest.approx(1.2, rel=0.01)


@pytest.mark.parametrize("key", ["entries", "samples", ""])
def test_records_are_columns_by_their_keys(key: str, tmp_path: Path) -> None:
    table = motion()
    rows = records(table)
    recording = load(saved(tmp_path / "a.json", {key: rows, "motor": "x"} if key else rows))
    assert recording.time.tolist() == table[:, 0].tolist()
    assert recording.velocity.tolist() == table[:, 3].tolist()
    right(recording)


def test_columns_of_numbers_are_read_as_well(tmp_path: Path) -> None:
    table = motion()
    log = {"t": table[:, 0].tolist(), "q": table[:, 2].tolist(), "tau": table[:, 1].tolist()}
    recording = load(saved(tmp_path / "a.json", {"log": log, "date": "today"}))
    assert recording.position.tolist() == table[:, 2].tolist()


def test_a_list_in_a_record_is_a_column_an_element(tmp_path: Path) -> None:
    table = motion()
    rows = [
        {"time": t, "state": {"q": [q, -q], "dq": [v, -v], "tau": [m, -m]}}
        for t, m, q, v in table.tolist()
    ]
    robot = jid.load_robot(saved(tmp_path / "a.json", {"rows": rows}))
    assert robot.names == ("0", "1")
    assert robot.joint(1).position.tolist() == (-table[:, 2]).tolist()


@pytest.mark.parametrize(
    ("units", "per_rotation", "kind"), [("Radians", TURN, "revolute"), ("Inches", 4.0, "prismatic")]
)
def test_sysid_writes_rotations(units: str, per_rotation: float, kind: str, tmp_path: Path) -> None:
    table = motion()
    content: dict[str, Any] = {"sysid": True, "units": units, "unitsPerRotation": per_rotation}
    content |= {key: [] for key in TESTS} | {"fast-forward": table.tolist()}
    recording = load(saved(tmp_path / "a.json", content))
    factor = per_rotation * (0.0254 if units == "Inches" else 1.0)
    assert recording.kind == kind
    assert recording.position == pytest.approx(table[:, 2] * factor)
    assert recording.velocity == pytest.approx(table[:, 3] * factor)
    assert recording.metadata["stated"]["units"] == units
    assert recording.torque is None  # a voltage is none


@pytest.mark.parametrize("starts", [(0.0, 0.0, 0.0, 0.0), (30.0, 10.0, 50.0, 20.0)])
def test_several_runs_give_the_right_values(starts: tuple[float, ...], tmp_path: Path) -> None:
    content: dict[str, Any] = {"test": "Arm", "units": "Rotations", "unitsPerRotation": 1.0}
    for number, (name, start) in enumerate(zip(TESTS, starts, strict=True)):
        table = motion(number)
        # An encoder that is set to zero anew jumps between two runs.
        table += np.array([start, 0.0, 3.0 * number, 0.0])
        content[name] = (table * [1.0, 1.0, 1 / TURN, 1 / TURN]).tolist()
    path = saved(tmp_path / "a.json", content)
    torque: Any = {"columns": {"torque": "voltage [V]"}, "scale": {"torque": 1.0}}
    recording = load(path, **torque)
    assert len(recording.gaps) == 3
    right(recording)
    assert not [each for each in jid.identify(recording).findings if each.code == "jumps"]
    runs = load_runs(path, by="run", **torque)
    assert {run.name for run in runs} == {f"a run={name}" for name in TESTS}
    one = load(path, where={"run": "fast-forward"}, **torque)
    assert one.position == pytest.approx(motion(2)[:, 2] + 6.0)


def test_info_says_what_stands_beside_the_rows(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    stated = {"mass": 1.0, "arm_mass": 0.3, "length": 0.2, "kp": 32, "motor": "x"}
    path = saved(tmp_path / "a.json", stated | {"entries": records(motion())})
    assert main(["info", str(path)]) == 0
    said = capsys.readouterr().out
    assert "mass 1.0, arm_mass 0.3, length 0.2, kp 32, motor x" in said
    (line,) = [each for each in said.splitlines() if "[link]" in each]
    joint = written(
        tmp_path / "joint.toml", ["schema = 2", "[link]", *line.partition(": ")[2].split("; ")]
    )
    link = jid.Joint.load(joint).link
    assert link is not None
    # A point mass at the end of a rod.
    assert link.mass * link.centre_of_mass == pytest.approx((1.0 + 0.15) * 0.2)
    assert link.inertia == pytest.approx((1.0 + 0.1) * 0.04)
    assert link.angle == pytest.approx(-np.pi / 2)


@pytest.mark.parametrize(
    ("text", "reason"),
    [
        ("{", "it is not JSON"),
        ("[" * 100_000, "it is not JSON"),
        ('{"name": "elbow"}', "the file holds no rows"),
        ('{"entries": []}', "the file holds no rows"),
        ('{"entries": [1, 2, 3]}', "the file holds no rows"),
    ],
)
def test_what_is_no_log_is_refused(text: str, reason: str, tmp_path: Path) -> None:
    assert reason in refusal(written(tmp_path / "a.json", text))


def test_a_missing_value_is_named(tmp_path: Path) -> None:
    rows = records(motion())
    del rows[7]["torque"]
    assert "row 7, column 'torque': the value is missing" in refusal(
        saved(tmp_path / "a.json", rows)
    )


@pytest.mark.parametrize(
    ("names", "read"),
    [(("a.json", "b.csv"), ["b.csv"]), (("a.json", "b.json"), ["a.json", "b.json"])],
)
def test_a_json_file_beside_other_logs_of_a_folder_is_no_run(
    names: tuple[str, ...], read: list[str], tmp_path: Path
) -> None:
    for name in names:
        (tmp_path / name).write_text("{}")
    assert [each.name for each in servo._files([tmp_path])] == read
