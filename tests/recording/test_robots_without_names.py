"""Logs of robots as they come: blocks of bare numbers, no time, PACE's archives, a pickle, dashes and estimates."""

import re
import shlex
import sys
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from command_line_answers import answer
from recording_files import refusal
from shared_cases import case

import jointid as jid

N = 200


def motion(joints: int, seed: int) -> dict[str, Any]:
    rng = np.random.default_rng(seed)
    time = np.round(0.004 * np.arange(N), 6)
    phase = rng.uniform(0.0, 6.0, joints)
    position = np.round(np.sin(9.0 * time[:, None] + phase), 6)
    torque = np.round(5.0 * np.cos(9.0 * time[:, None] + phase) + rng.normal(size=(N, joints)), 6)
    return {"time": time, "position": position, "torque": torque, "reference": position + 0.01}


def numbers(path: Path, *columns: Any, header: str = "") -> Path:
    table = np.column_stack(columns)
    np.savetxt(path, table, delimiter=",", fmt="%.17g", header=header, comments="")
    return path


@pytest.mark.parametrize(("joints", "seed"), [(6, 0), (3, 1), (7, 2)])
def test_blocks_of_bare_numbers(joints: int, seed: int, tmp_path: Path) -> None:
    run = motion(joints, seed)
    path = numbers(
        tmp_path / "a.csv", run["time"], run["position"], run["torque"], run["reference"]
    )
    blocks = {
        signal: f"{1 + k * joints}:{(k + 1) * joints}"
        for k, signal in enumerate(("position", "torque", "reference"))
    }
    read = jid.load(path, joints="all", columns={"time": 0, **blocks})
    assert read.names == tuple(str(k + 1) for k in range(joints))
    for signal in ("time", *blocks):
        assert np.array_equal(getattr(read, signal), run[signal]), signal
    part = jid.load(path, joint=2, columns={"time": 0, **blocks})
    assert np.array_equal(part.position, run["position"][:, 1])
    rate = jid.load(path, joints="all", columns=blocks, sample_period=0.004)
    assert np.allclose(rate.time, run["time"])


def test_a_block_keeps_the_units_of_its_headers(tmp_path: Path) -> None:
    run = motion(2, 5)
    header = "t,x [deg],y [deg],f,g"
    path = numbers(tmp_path / "a.csv", run["time"], run["position"], run["torque"], header=header)
    read = jid.load(path, joints="all", columns={"position": "1:2", "torque": "3:4"})
    assert np.allclose(read.position, np.radians(run["position"]), rtol=1e-12)


@pytest.mark.parametrize(
    ("blocks", "says"),
    [
        (
            {"position": "1:3", "torque": "4:5"},
            r"their numbers of columns differ \(position: 3",
        ),
        ({"position": "1:3", "torque": "3:5"}, "column 3 is also in the block position"),
        ({"position": "1:99"}, "the columns have the numbers 0 to 6"),
        ({"position": "3:1"}, "its first and last column"),
        ({"speed": "1:3"}, "speed"),
        (
            {"position": "1:3", "torque": 4},
            "a block of 3 columns is expected, because position has the block 1:3",
        ),
        ({"position": "1:3", "velocity": "column 5"}, "velocity.*: a block of 3 columns"),
    ],
)
def test_blocks_that_cannot_be(blocks: dict[str, Any], says: str, tmp_path: Path) -> None:
    run = motion(3, 0)
    path = numbers(tmp_path / "a.csv", run["time"], run["position"], run["torque"])
    with pytest.raises(jid.InputError, match=says):
        jid.load(path, joints="all", columns={"time": 0, **blocks})


def test_the_command_says_how_blocks_are_given(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    run = motion(3, 0)
    path = str(numbers(tmp_path / "a.csv", run["time"], run["position"], run["torque"]))
    form = "--column time=COLUMN --column position=FIRST:LAST"
    for line in (["identify", path, "--joints", "all"], ["info", path]):
        code, said = answer(line, capsys)
        assert code == 2
        assert form in said
        assert "first and last column number of each signal, e.g. position=1:6" in said
    filled = form.replace("COLUMN", "0").replace("FIRST:LAST", "1:3") + " --column torque=4:6"
    assert answer(["identify", path, "--joints", "all", *filled.split()], capsys)[0] == 0
    assert answer(["info", path, *filled.split()], capsys)[0] == 0


def test_a_block_stands_next_to_headers_of_each_joint(tmp_path: Path) -> None:
    run = motion(2, 7)
    path = numbers(
        tmp_path / "a.csv", run["time"], run["position"], run["torque"], header="t,x,y,f_1,f_2"
    )
    read = jid.load(path, joints="all", columns={"position": "1:2", "torque": "f_{joint}"})
    assert np.array_equal(read.torque, run["torque"])  # type: ignore[arg-type]
    one = jid.load(path, joints="all", columns={"position": "1:1", "torque": 3})
    assert np.array_equal(one.torque, run["torque"][:, :1])  # type: ignore[arg-type]


@pytest.mark.parametrize("further", [[], ["tau_ext"], ["index", "tau_ext"]])
@pytest.mark.parametrize("joints", [2, 6])
def test_a_robot_without_a_time_is_asked_for_its_rate(
    joints: int, further: list[str], tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """Nothing of a joint, no counter and no external torque is proposed as time or position."""
    run = motion(joints, 3)
    columns, names = [run["position"], run["torque"]], ["q", "tau"]
    header = [f"{name}_{k}" for name in names for k in range(joints)]
    if "tau_ext" in further:
        header += [f"tau_ext_{k}" for k in range(joints)]
        columns.append(np.abs(run["torque"]).cumsum(axis=0))
    if "index" in further:
        header.append("frame_index")
        columns.append(np.arange(N)[:, None])
    path = str(numbers(tmp_path / "a.csv", *columns, header=",".join(header)))
    for line in (["info", path], ["identify", path, "--joints", "all"]):
        code, said = answer(line, capsys)
        assert code == 2
        assert "load with --rate HZ" in said
        assert not re.search(r"--column (time|position)=", said)
        assert answer([*line, "--rate", "250"], capsys)[0] == 0
    read = jid.load(path, joints="all", sample_period=0.004)
    assert np.array_equal(read.position, run["position"])
    assert np.array_equal(read.torque, run["torque"])  # type: ignore[arg-type]


@pytest.mark.parametrize("kind", [np.float64, np.float32])
@pytest.mark.parametrize("joints", [12, 1, 6])
def test_the_archive_of_pace(joints: int, kind: Any, tmp_path: Path) -> None:
    run = motion(joints, 4)
    path = tmp_path / "pace.npz"
    arrays = {
        "time": run["time"].astype(kind),
        "dof_pos": run["position"].astype(kind),
        "des_dof_pos": run["reference"].astype(kind),
    }
    np.savez(path, **arrays)
    if joints == 1:
        one = jid.load(path)
        assert np.array_equal(one.position, arrays["dof_pos"][:, 0])
        assert np.array_equal(one.reference, arrays["des_dof_pos"][:, 0])  # type: ignore[arg-type]
        return
    read = jid.load(path, joints="all")
    assert np.array_equal(read.position, arrays["dof_pos"])
    assert np.array_equal(read.reference, arrays["des_dof_pos"])  # type: ignore[arg-type]
    assert read.torque is None


@pytest.mark.parametrize("name", ["chirp_data.pt", "it's here.PT", "weights.pth"])
def test_a_pickle_is_refused_with_the_line_that_converts_it(
    name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    path = tmp_path / name
    path.write_bytes(b"cos\nsystem\n(S'touch ran'\ntR.")
    monkeypatch.chdir(tmp_path)
    message = refusal(path)
    assert "jointid never reads pickles, because they may run code" in message
    command, option, code = shlex.split(message.partition("convert it with ")[2])
    assert (command, option) == ("python", "-c")
    run = motion(3, 1)
    held = {"time": run["time"], "dof_pos": run["position"], "des_dof_pos": run["reference"]}

    def loaded(file: str, *, weights_only: bool) -> dict[str, Any]:
        assert Path(file) == path
        assert weights_only
        tensor = {
            key: SimpleNamespace(numpy=lambda value=value: value) for key, value in held.items()
        }
        return {key: SimpleNamespace(cpu=lambda each=each: each) for key, each in tensor.items()}

    monkeypatch.setitem(sys.modules, "torch", SimpleNamespace(load=loaded))
    exec(code, {})
    read = jid.load(path.with_suffix(".npz"), joints="all")
    assert np.array_equal(read.position, run["position"])
    assert not (tmp_path / "ran").exists()


@pytest.mark.parametrize(
    ("form", "names"),
    [
        ("- arm_{k}_joint_{signal}", ("arm_1", "arm_2", "arm_3")),
        ("-leg_{k}_{signal}", ("leg_1", "leg_2", "leg_3")),
        ("- joint{k}.{signal}", ("joint1", "joint2", "joint3")),
    ],
)
def test_a_leading_dash_is_no_word(form: str, names: tuple[str, ...], tmp_path: Path) -> None:
    run = motion(3, 2)
    header = ["t"]
    header += [
        form.format(k=k + 1, signal=signal) for signal in ("position", "effort") for k in range(3)
    ]
    path = numbers(
        tmp_path / "a.csv", run["time"], run["position"], run["torque"], header=",".join(header)
    )
    read = jid.load(path, joints="all")
    assert read.names == names
    assert np.array_equal(read.position, run["position"])
    assert np.array_equal(read.torque, run["torque"])  # type: ignore[arg-type]


@pytest.mark.parametrize(
    "form", ["tau_est_{k}", "motor_state[{k}].tau_est", "FL_hip_{k}.tauEst", "tau_estimated_{k}"]
)
def test_an_estimated_torque_is_one(form: str, tmp_path: Path) -> None:
    run = motion(3, 6)
    position = re.sub("tau.*?(_{k})?$", r"q\1", form)
    header = [
        "time_s",
        *(position.format(k=k) for k in range(3)),
        *(form.format(k=k) for k in range(3)),
    ]
    path = numbers(
        tmp_path / "a.csv", run["time"], run["position"], run["torque"], header=",".join(header)
    )
    read = jid.load(path, joints="all")
    assert np.array_equal(read.torque, run["torque"])  # type: ignore[arg-type]


def test_the_cases_are_read() -> None:
    folder = case("robot-14-formats")
    columns: dict[str, str | int | None] = {"time": 0, "position": "1:3", "torque": "4:6"}
    assert len(jid.load(folder / "bare_numbers.csv", joints="all", columns=columns)) == 3
    for name in ("no_time", "no_time_with_tau_ext"):
        read = jid.load(folder / f"{name}.csv", joints="all", sample_period=0.01)
        assert read.torque is not None
    for name in ("dash", "lists", "tau_est"):
        assert jid.load(folder / f"{name}.csv", joints="all").torque is not None
