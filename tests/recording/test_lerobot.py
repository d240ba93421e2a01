"""LeRobot datasets, versions 2 and 3: folders, files, names, rate, episodes; what was read is what was written."""

import json
from collections.abc import Mapping
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from command_line_answers import answer
from numpy.typing import NDArray
from recording_files import refusal, refused
from shared_cases import case

import jointid as jid
from jointid.cli.command_line import main
from jointid.recording.readers.registry import reader_of

pyarrow = pytest.importorskip("pyarrow")
SO101 = [f"{name}.pos" for name in ("shoulder_pan", "shoulder_lift", "elbow_flex")]
RATE, FRAMES = 50, (40, 60, 50)
DEGREES = {"position": "deg", "reference": "deg"}
Rows = dict[str, NDArray[Any]]


def episode(number: int, joints: int = 3, rate: float = RATE, seed: int = 0) -> Rows:
    rng = np.random.default_rng([seed, number])
    frames = np.arange(FRAMES[number])
    state = rng.normal(scale=20.0, size=(len(frames), joints)).cumsum(axis=0)
    return {
        "action": (state + 1.0).astype(np.float32),
        "observation.state": state.astype(np.float32),
        "timestamp": (frames / rate).astype(np.float32),
        "frame_index": frames,
        "episode_index": np.full(len(frames), number),
        "index": frames + sum(FRAMES[:number]),
        "task_index": np.zeros(len(frames), dtype=int),
    }


def write(path: Path, *episodes: Rows) -> Path:
    from pyarrow import parquet

    path.parent.mkdir(parents=True, exist_ok=True)
    columns = {key: np.concatenate([each[key] for each in episodes]) for key in episodes[0]}
    arrays = {
        key: pyarrow.array(list(value)) if value.ndim > 1 else pyarrow.array(value)
        for key, value in columns.items()
    }
    parquet.write_table(pyarrow.table(arrays), path)
    return path


def dataset(
    folder: Path,
    version: str,
    names: Any,
    episodes: list[Rows],
    fps: float = RATE,
    actions: Any = ...,
) -> Path:
    of_features = {"observation.state": names, "action": names if actions is ... else actions}
    features = {key: {"dtype": "float32", "names": each} for key, each in of_features.items()}
    info = {"codebase_version": version, "fps": fps, "features": features}
    (folder / "meta").mkdir(parents=True)
    (folder / "meta" / "info.json").write_text(json.dumps(info), encoding="utf-8")
    (folder / "videos").mkdir()
    if version.startswith("v2"):
        for k, each in enumerate(episodes):
            write(folder / "data" / "chunk-000" / f"episode_{k:06d}.parquet", each)
    else:
        write(folder / "data" / "chunk-000" / "file-000.parquet", *episodes[:2])
        write(folder / "data" / "chunk-000" / "file-001.parquet", *episodes[2:])
    return folder


def check(read: jid.RobotRecording, episodes: list[Rows], rate: float = RATE) -> None:
    states = np.concatenate([each["observation.state"] for each in episodes]).astype(float)
    actions = np.concatenate([each["action"] for each in episodes]).astype(float)
    assert np.allclose(np.degrees(read.position), states, rtol=1e-12)
    assert read.reference is not None
    assert np.allclose(np.degrees(read.reference), actions, rtol=1e-12)
    first = 0
    for each in episodes:
        rows = slice(first, first + len(each["frame_index"]))
        own = read.time[rows] - read.time[rows][0]
        assert np.allclose(own, each["frame_index"] / rate, atol=1e-9)
        first = rows.stop


@pytest.mark.parametrize("version", ["v2.1", "v3.0"])
@pytest.mark.parametrize(
    ("names", "expected"),
    [
        (SO101, ("shoulder_pan", "shoulder_lift", "elbow_flex")),
        (
            {"motors": ["main_pan", "main_lift", "main_flex"]},
            ("main_pan", "main_lift", "main_flex"),
        ),
        (None, ("0", "1", "2")),
        (["a", "a", "b"], ("0", "1", "2")),
    ],
    ids=["list", "mapping", "none", "twice"],
)
def test_a_folder_is_one_recording(
    version: str, names: Any, expected: tuple[str, ...], tmp_path: Path
) -> None:
    episodes = [episode(k) for k in range(3)]
    folder = dataset(tmp_path / "pick", version, names, episodes)
    assert reader_of(folder).marker == "meta/info.json"
    read = jid.load(folder, joints="all", units=DEGREES)
    assert read.names == expected
    assert read.name == "pick"
    check(read, episodes)
    assert read.metadata["runs"] == ["episode 0", "episode 1", "episode 2"]
    gaps = [gap.index for gap in read.joint(expected[0]).gaps]
    assert gaps == [FRAMES[0] - 1, FRAMES[0] + FRAMES[1] - 1]


@pytest.mark.parametrize("inside", [True, False])
def test_a_single_file_is_read_with_what_the_dataset_says(inside: bool, tmp_path: Path) -> None:
    """A file that was taken out of its dataset has numbers for names, and the stamps that it holds."""
    episodes = [episode(0), episode(1)]
    if inside:
        folder = dataset(tmp_path / "pick", "v3.0", SO101, [*episodes, episode(2)])
        path = folder / "data" / "chunk-000" / "file-000.parquet"
    else:
        path = write(tmp_path / "file-000.parquet", *episodes)
    read = jid.load(path, joints="all", units=DEGREES)
    assert read.names == (
        ("shoulder_pan", "shoulder_lift", "elbow_flex") if inside else ("0", "1", "2")
    )
    states = np.concatenate([each["observation.state"] for each in episodes])
    assert np.allclose(np.degrees(read.position), states, rtol=1e-6)
    runs = jid.load(
        path, joint=2 if not inside else "elbow_flex", by="episode_index", units=DEGREES
    )
    assert [len(run) for run in runs] == list(FRAMES[:2])
    one = jid.load(path, joints="all", units=DEGREES, where={"episode_index": 1})
    assert one.samples == FRAMES[1]


@pytest.mark.parametrize("seed", range(3))
def test_velocity_and_effort_of_other_robots(seed: int, tmp_path: Path) -> None:
    rows = episode(0, joints=2, seed=seed)
    state = rows["observation.state"]
    rows["observation.velocity"] = np.gradient(state, axis=0).astype(np.float32)
    rows["observation.effort"] = np.sin(state).astype(np.float32)
    path = write(tmp_path / "aloha.parquet", rows)
    rad = dict.fromkeys(("position", "reference"), "rad") | {"velocity": "rad/s"}
    read = jid.load(path, joints="all", units=rad)
    for signal, key in (
        ("position", "observation.state"),
        ("velocity", "observation.velocity"),
        ("torque", "observation.effort"),
        ("reference", "action"),
    ):
        assert np.array_equal(getattr(read, signal), rows[key].astype(float)), signal


@pytest.mark.parametrize(
    ("names", "actions", "expected"),
    [
        (["a", "b", "c"], None, ("a", "b", "c")),
        (None, ["a", "b", "c"], ("0", "1", "2")),
        (["a", "b", "c"], ["m_a", "m_b", "m_c"], ("a", "b", "c")),
        (["a", "b", "c"], ["c.pos", "a.pos", "b.pos"], ("a", "b", "c")),
    ],
)
def test_actions_have_the_joints_of_the_states(
    names: Any, actions: Any, expected: tuple[str, ...], tmp_path: Path
) -> None:
    """By their names where the states have the same ones; otherwise in the states' order."""
    episodes = [episode(k) for k in range(3)]
    folder = dataset(tmp_path / "pick", "v3.0", names, episodes, actions=actions)
    assert "'position': 'deg', 'reference': 'deg'" in refused(
        folder, partial(jid.load, joints="all")
    )
    read = jid.load(folder, joints="all", units=DEGREES)
    read = read.select(expected)
    order = [2, 0, 1] if actions and actions[0] == "c.pos" else [0, 1, 2]
    held = [{**each, "action": each["action"][:, np.argsort(order)]} for each in episodes]
    check(read, held)


@pytest.mark.parametrize("names", [None, ["a", "b", "c", "d", "e", "f"]])
def test_another_number_of_actions_is_no_wanted_position(
    names: Any, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    episodes = [episode(k, joints=6) for k in range(3)]
    held = [{**each, "action": each["action"][:, :3]} for each in episodes]
    folder = dataset(tmp_path / "pick", "v3.0", names, held, actions=None)
    assert "units={'position': 'deg'}" in refused(folder, partial(jid.load, joints="all"))
    read = jid.load(folder, joints="all", units={"position": "deg"})
    assert read.reference is None
    says = (
        "action is not read: its 3 elements have no joint names, and observation.state has 6 joints"
    )
    assert read.metadata["of_no_joint"] == [says]
    assert main(["info", str(folder), "--unit", "position=deg"]) == 0
    assert f"read: {says}" in capsys.readouterr().out
    first = jid.load(folder, joint=read.names[0], units=DEGREES, columns={"reference": "action_1"})
    assert first.reference is not None
    wanted = np.concatenate([each["action"][:, 1] for each in held]).astype(float)
    assert np.allclose(np.degrees(first.reference), wanted, rtol=1e-12)


def test_some_joints_have_actions(tmp_path: Path) -> None:
    """Where the names of actions are some of the states', the others have no wanted position."""
    episodes = [episode(k) for k in range(3)]
    held = [{**each, "action": each["action"][:, :2]} for each in episodes]
    folder = dataset(tmp_path / "pick", "v3.0", ["a", "b", "c"], held, actions=["b", "a"])
    read = jid.load(folder, joints="all", units=DEGREES).select(["b", "a", "c"])
    assert read.reference is not None
    wanted = np.concatenate([each["action"] for each in held]).astype(float)
    assert np.allclose(np.degrees(read.reference[:, :2]), wanted, rtol=1e-12)
    assert np.isnan(read.reference[:, 2]).all()


def test_the_unit_is_asked_and_what_is_printed_reads_the_file(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    folder = dataset(tmp_path / "pick", "v3.0", SO101, [episode(k) for k in range(3)])
    code, said = answer(["info", str(folder)], capsys)
    assert code == 2
    assert "LeRobot datasets use degrees, rad, or" in said
    assert (
        "--unit position=deg --unit reference=deg (write rad instead of deg for positions in rad; "
        in said
    )
    for each in (said, refused(folder, partial(jid.load, joints="all"))):
        assert (
            "for values from −100 to 100, state scale = half of the joint's range in rad / 100)"
            in each
        )
    pasted = ["--unit", "position=deg", "--unit", "reference=deg"]
    assert main(["info", str(folder), *pasted]) == 0
    said = capsys.readouterr().out
    assert "shoulder_lift" in said
    assert "runs, one after the other: episode 0, episode 1, episode 2" in said
    assert main(["info", str(folder), "--scale", "position=0.0157"]) == 0


@pytest.mark.parametrize(
    "text", ["", "{", "[1]", '{"fps": 0, "features": []}', '{"features": {"action": 3}}']
)
def test_a_damaged_description_is_named_or_not_used(text: str, tmp_path: Path) -> None:
    folder = dataset(tmp_path / "pick", "v2.0", SO101, [episode(k) for k in range(3)])
    (folder / "meta" / "info.json").write_text(text, encoding="utf-8")
    if text in ("", "{"):
        with pytest.raises(jid.InputError, match=r"info\.json: it is no JSON"):
            jid.load(folder, joints="all", units=DEGREES)
    else:
        assert jid.load(folder, joints="all", units=DEGREES).names == ("0", "1", "2")


def test_files_that_do_not_belong_together_are_named(tmp_path: Path) -> None:
    folder = dataset(tmp_path / "pick", "v2.0", SO101, [episode(k) for k in range(3)])
    other: Mapping[str, Any] = {k: v for k, v in episode(1).items() if k != "action"}
    write(folder / "data" / "chunk-000" / "episode_000001.parquet", dict(other))
    assert "its columns differ from the columns of episode_000000.parquet" in refusal(folder)
    for file in (folder / "data").rglob("*.parquet"):
        file.unlink()
    assert "no .parquet file in data" in refusal(folder)


def test_the_case_is_read() -> None:
    read = jid.load(case("robot-14-formats") / "lerobot.parquet", joints="all", units=DEGREES)
    assert len(read) == 6
    assert read.metadata["runs"] == ["episode 0", "episode 1", "episode 2"]
