"""Recording: what it holds, refuses, derives and keeps through a file."""

import copy
import dataclasses
import os
import pickle
import stat
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from jointid.base.errors import InputError
from jointid.recording.readers.loading import load
from jointid.recording.recording import Recording
from jointid.recording.signals import SIGNALS

N = 12
TIME = np.arange(N) * 0.01


def recording(**changes: Any) -> Recording:
    fields: dict[str, Any] = {"time": TIME, "position": np.sin(TIME), "torque": np.ones(N)}
    return Recording(**(fields | changes))


def changed(index: int, value: float, array: Any = TIME) -> Any:
    copied = np.array(array, dtype=float)
    copied[index] = value
    return copied


def test_signals_are_read_only_copies_in_canonical_order() -> None:
    torque = np.arange(N)
    made = Recording(torque=torque, position=list(range(N)), time=TIME, sensor=torque[::-1])
    torque[0] = 99
    assert made.signals == ("time", "position", "velocity", "torque", "sensor")
    assert made.torque is not None
    assert made.torque[0] == 0.0
    assert made.current is None
    for name in made.signals:
        array = getattr(made, name)
        assert array.dtype == np.float64
        assert array.flags.c_contiguous
        with pytest.raises(ValueError, match="read-only"):
            array[0] = 1.0


def test_ranges_are_of_the_signals_that_there_are() -> None:
    made = recording(kind="prismatic", extra={"hall": np.arange(N)})
    assert tuple(made.ranges) == ("time", "position", "velocity", "torque")  # derived, no sensor
    assert made.ranges["torque"] == (1.0, 1.0)
    assert made.ranges["position"] == (0.0, np.sin(TIME[-1]))
    with pytest.raises(TypeError):
        made.ranges["torque"] = (0.0, 0.0)  # type: ignore[index]
    assert pickle.loads(pickle.dumps(made)).ranges == made.ranges
    assert made.with_signals(torque=2.0 * TIME).ranges["torque"] == (0.0, 2.0 * TIME[-1])


def test_attributes_are_read_only() -> None:
    made = recording(metadata={"a": 1}, truth={"coulomb": 25.0})
    with pytest.raises(AttributeError, match="name"):
        made.name = "other"
    with pytest.raises(AttributeError, match="torque"):
        del made.torque
    for mapping in (made.metadata, made.truth):
        with pytest.raises(TypeError):
            mapping["a"] = 2  # type: ignore[index]


BAD: list[tuple[dict[str, Any], str]] = [
    ({"position": np.ones((N, 1))}, r"position: the shape is \(12, 1\).*one dimension"),
    ({"torque": np.ones(5)}, "torque: 5 samples, but time has 12"),
    ({"time": TIME[:7], "position": TIME[:7], "torque": None}, "time: 7 samples.*at least 8"),
    ({"position": changed(5, np.nan)}, "index 5: position is nan"),
    ({"torque": changed(3, -np.inf)}, "index 3: torque is -inf"),
    (
        {"time": changed(6, TIME[5])},
        r"index 6: time is 0\.05: the sample before is at 0\.05.*strictly increase",
    ),
    ({"time": TIME[::-1]}, "index 1: time is .*: the sample before is at 0.11"),
    ({"time": changed(0, -np.inf)}, "index 0: time is -inf"),
    ({"time": changed(0, -1e308)}, "time: the times span more than"),
    (
        {"position": changed(4, 1e308)},
        "index 3: position is .* changes too fast .*give the velocity",
    ),
    ({"position": ["a"] * N}, "position: an array of numbers is expected"),
    ({"position": np.array(["1"] * N, dtype=object)}, "position: '1' at index 0 is not a number"),
    ({"position": np.ones(N) * 1j}, "position: an array of numbers is expected"),
    ({"position": [[1], [1, 2]]}, "position: an array of numbers is expected"),
    ({"position": np.ma.masked_equal(np.arange(N), 4)}, "position: masked at index 4"),
    ({"position": None}, "position is None: a recording needs time and position"),
    ({"kind": "linear"}, "kind is 'linear': revolute or prismatic"),
    ({"torque_hold": "foh"}, "torque_hold is 'foh': zoh"),
    ({"name": 5}, "name is 5: a string"),
    ({"velocity_derived": 1}, "velocity_derived is 1: true or false"),
    ({"metadata": [1]}, "metadata is \\[1\\]: a mapping"),
    ({"metadata": {"a": np.zeros(2)}}, "metadata.a: a JSON value is expected"),
    ({"metadata": {"a": float("nan")}}, "metadata.a: a JSON value is expected"),
    ({"truth": {1: 2.0}}, "truth: the key 1 is not a string"),
]


@pytest.mark.parametrize(("changes", "message"), BAD, ids=[m[:24] for _, m in BAD])
def test_bad_input_is_refused(changes: dict[str, Any], message: str) -> None:
    with pytest.raises(InputError, match=message):
        recording(**changes)


def test_units_follow_the_kind() -> None:
    turning, sliding = recording(), recording(kind="prismatic")
    assert [turning.unit(s) for s in SIGNALS] == (
        ["s", "rad", "rad/s", "N·m", "1", "rad", "rad", "°C", "N·m", "A", "1"]
    )
    assert [sliding.unit(s) for s in SIGNALS] == (
        ["s", "m", "m/s", "N", "1", "m", "m", "°C", "N·m", "A", "1"]
    )
    with pytest.raises(InputError, match="signal: 'torqe' is not a signal; did you mean 'torque'"):
        turning.unit("torqe")


stamps = st.lists(st.floats(1e-3, 2e-3), min_size=10, max_size=40).map(np.cumsum)


@given(stamps, st.floats(-5, 5), st.floats(-5, 5), st.floats(-5, 5))
def test_derived_velocity_is_exact_for_quadratics(t: Any, a: float, b: float, c: float) -> None:
    made = Recording(time=t, position=a + b * t + c * t * t)
    assert made.velocity_derived
    assert made.gaps == ()
    np.testing.assert_allclose(made.velocity, b + 2 * c * t, atol=1e-9)


@given(stamps, stamps, st.floats(-100, 100))
def test_derived_velocity_never_looks_across_a_gap(t1: Any, t2: Any, jump: float) -> None:
    time = np.concatenate([t1, t1[-1] + 1.0 + t2])
    position = np.concatenate([np.sin(t1), np.cos(t2) + jump])
    made = Recording(time=time, position=position)
    (gap,) = made.gaps
    assert (gap.index, gap.start) == (len(t1) - 1, t1[-1])
    assert gap.duration == time[len(t1)] - t1[-1]
    parts = [
        Recording(time=time[part], position=position[part]).velocity
        for part in (slice(len(t1)), slice(len(t1), None))
    ]
    assert made.velocity.tobytes() == np.concatenate(parts).tobytes()


def test_derived_velocity_of_short_stretches() -> None:
    """Two samples between gaps have the slope between them, one alone has 0."""
    time = np.array([0, 1, 2, 3, 4, 5, 6, 7, 20, 40, 41.0])
    made = Recording(time=time, position=time**2)
    assert [gap.index for gap in made.gaps] == [7, 8]
    assert made.velocity.tolist() == [*(2 * time[:8]), 0.0, 81.0, 81.0]


def test_gap_limit_is_three_and_a_half_periods() -> None:
    time = np.arange(40.0)
    time[20:] += 2.5
    assert Recording(time=time, position=time).gaps == ()
    time[30:] += 2.500001
    (gap,) = Recording(time=time, position=time).gaps
    assert gap.index == 29
    with pytest.raises(dataclasses.FrozenInstanceError):
        gap.index = 3  # type: ignore[misc]


def test_given_velocity_is_not_derived() -> None:
    made = recording(velocity=np.ones(N))
    assert not made.velocity_derived
    assert made.velocity.tolist() == [1.0] * N


def test_crop_includes_both_ends_and_keeps_derived_velocity() -> None:
    made = recording(name="run", kind="prismatic", metadata={"a": [1]}, torque_hold="zoh")
    part = made.crop(TIME[2], TIME[10])
    assert part.time.tolist() == TIME[2:11].tolist()
    assert part.velocity.tobytes() == made.velocity[2:11].tobytes()
    assert part.velocity_derived
    assert (part.name, part.kind, part.torque_hold) == ("run", "prismatic", "zoh")
    assert part.metadata == {"a": [1]}
    assert made.crop() == made
    assert len(made.crop(stop=0.075)) == 8


@pytest.mark.parametrize(
    ("start", "stop", "message"),
    [
        (0.0, 0.065, r"0\.0 s to 0\.065 s there are 7 of 12 samples"),
        (5.0, 4.0, "there are 0 of 12 samples"),
        (np.nan, 4.0, "start is nan"),
        (0.0, "end", "stop is 'end'"),
    ],
)
def test_crop_refuses(start: Any, stop: Any, message: str) -> None:
    with pytest.raises(InputError, match=message):
        recording().crop(start, stop)


def test_equality_is_bit_for_bit() -> None:
    zero, minus = np.zeros(N), -np.zeros(N)
    assert recording(torque=zero) == recording(torque=zero)
    assert recording(torque=zero) != recording(torque=minus)
    assert recording(torque=zero) != recording(sensor=zero)
    assert recording() != recording(torque_hold="linear")
    assert recording() != recording(metadata={"a": 1})
    assert recording() != recording(truth={})
    assert recording() != "recording"
    assert hash(recording()) == hash(recording())


def test_fingerprint_depends_on_values_and_names() -> None:
    made = [
        recording(),
        recording(torque=None),
        recording(torque=None, sensor=np.ones(N)),
        recording(torque=changed(4, 1.0 + 2**-52, np.ones(N))),
    ]
    assert len({each.fingerprint for each in made}) == 4
    assert all(len(each.fingerprint) == 16 for each in made)
    assert int(made[0].fingerprint, 16) >= 0
    assert recording(name="x").fingerprint == made[0].fingerprint


def test_length_period_duration_and_repr() -> None:
    made = recording(name="run 3", time=changed(N - 1, 1.0))
    assert len(made) == N
    assert made.duration == 1.0
    assert made.sample_period == pytest.approx(0.01)
    for part in ("'run 3'", "revolute", "12 samples", "1 gap;", "velocity (derived)", "torque"):
        assert part in repr(made)


def test_copies_and_pickles_are_equal_and_read_only() -> None:
    made = recording(metadata={"a": 1}, truth={"b": 2})
    for other in (pickle.loads(pickle.dumps(made)), copy.copy(made), copy.deepcopy(made)):
        assert other == made
        assert not other.position.flags.writeable


number = st.floats(allow_nan=False, allow_infinity=False)
text = st.text(max_size=8)
json_value = st.recursive(
    st.none() | st.booleans() | st.integers() | number | text,
    lambda inner: st.lists(inner, max_size=3) | st.dictionaries(text, inner, max_size=3),
    max_leaves=6,
)


@st.composite
def recordings(draw: st.DrawFn) -> Recording:
    steps = draw(st.lists(st.floats(1e-6, 1e3), min_size=8, max_size=20))
    time = draw(st.floats(-1e6, 1e6)) + np.cumsum(steps)
    names = draw(st.sets(st.sampled_from(SIGNALS[3:])))
    columns: dict[str, Any] = {
        name: draw(st.lists(number, min_size=len(time), max_size=len(time)))
        for name in sorted({"position", "velocity"} | names)
    }
    return Recording(
        time=time,
        **columns,
        kind=draw(st.sampled_from(["revolute", "prismatic"])),
        torque_hold=draw(st.sampled_from([None, "zoh", "linear"])),
        velocity_derived=draw(st.booleans()),
        name=draw(text),
        metadata=draw(st.dictionaries(text, json_value, max_size=3)),
        truth=draw(st.none() | st.dictionaries(text, json_value, max_size=3)),
    )


@settings(deadline=None)
@pytest.mark.parametrize("ending", [".npz", ".csv", ".csv.gz"])
@given(made=recordings())
def test_files_keep_every_bit(
    ending: str, made: Recording, tmp_path_factory: pytest.TempPathFactory
) -> None:
    path = tmp_path_factory.getbasetemp() / f"kept{ending}"
    made.save(path)
    back = load(path)
    assert back == made
    assert back.fingerprint == made.fingerprint
    assert repr(back) == repr(made)


@pytest.mark.parametrize("ending", [".npz", ".csv", ".csv.gz"])
def test_derived_velocity_survives_a_file(ending: str, tmp_path: Path) -> None:
    made = recording()
    made.save(tmp_path / f"run{ending}")
    back = load(tmp_path / f"run{ending}")
    assert back.velocity_derived
    assert back == made


@pytest.mark.parametrize("ending", [".csv", ".csv.gz"])
def test_same_recording_gives_the_same_file(ending: str, tmp_path: Path) -> None:
    first, second = tmp_path / f"a{ending}", tmp_path / f"b{ending}"
    recording().save(first)
    recording().save(second)
    assert first.read_bytes() == second.read_bytes()


@pytest.mark.parametrize("ending", [".npz", ".csv", ".csv.gz"])
@pytest.mark.parametrize("step", ["fsync", "replace"])
def test_failing_write_leaves_the_old_file(
    ending: str, step: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    path = tmp_path / f"run{ending}"
    recording().save(path)
    before = path.read_bytes()

    def full(*_: object) -> None:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(os, step, full)
    with pytest.raises(OSError, match="No space left"):
        recording(torque=np.zeros(N)).save(path)
    assert path.read_bytes() == before
    assert list(tmp_path.iterdir()) == [path]


def test_saving_replaces_and_keeps_the_mode(tmp_path: Path) -> None:
    path = tmp_path / "run.csv"
    recording().save(path)
    path.chmod(0o640)
    other = recording(torque=np.zeros(N))
    other.save(str(path))
    assert load(path) == other
    assert stat.S_IMODE(path.stat().st_mode) == 0o640


@pytest.mark.parametrize(
    ("name", "message"),
    [
        ("run.txt", r"run\.txt: a file name that ends in \.csv, \.csv\.gz or \.npz is expected"),
        ("none/run.csv", "the folder '.*none' does not exist"),
        ("folder.csv", "this is a folder"),
    ],
)
def test_where_nothing_can_be_saved(name: str, message: str, tmp_path: Path) -> None:
    (tmp_path / "folder.csv").mkdir()
    with pytest.raises(InputError, match=message):
        recording().save(tmp_path / name)


def test_read_only_arrays_are_not_copied() -> None:
    time, position = np.arange(10.0), np.sin(np.arange(10.0))
    time.flags.writeable = False
    recording = Recording(time=time, position=position, torque=np.zeros(10))
    assert recording.time is time
    assert recording.position is not position
    view = np.arange(20.0)[::2]
    view.flags.writeable = False  # its base is open to writing
    assert Recording(time=time, position=view, torque=np.zeros(10)).position is not view
