"""A saved robot's estimate is used again, whatever stands in it: values, or one sentence."""

import json
from collections.abc import Iterator
from functools import cache
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np
import pytest
from dealt_places import dealt
from small_arm import recording, urdf

import jointid as jid
from jointid.report.saving import report_page
from jointid.robot.links.inertia_modes import Inertia

pytest.importorskip("pinocchio")

# As it stands in the file: JSON knows no 1e400 and no NaN, Python's reader does.
JUNK = {
    "text": '"<script>"',
    "null": "null",
    "table": "{}",
    "list": "[]",
    "true": "true",
    "huge": "1e400",
    "nan": "NaN",
    "deep": "[" * 100_000 + "]" * 100_000,
    "many digits": "1" * 5000,
    "half a letter": '"\\ud800"',
    "negative": "-1",
    "large": "1e99",
}
NEVER = ("huge", "nan", "deep", "many digits", "half a letter")
Path_ = tuple[str | int, ...]


@cache
def made(inertia: Inertia = "free") -> tuple[jid.RobotEstimate, str, jid.RobotRecording]:
    with TemporaryDirectory() as folder:
        path = urdf(Path(folder))
        run = recording(path, static=0.5, duration=6.0)
        facts = jid.Robot.from_urdf(path, couplings={"elbow": {"shoulder": 0.5}})
        found = jid.identify_robot(run, facts, inertia=inertia, model="stribeck", windows=40)
        return found, found.to_json(), run


def paths(value: Any, here: Path_ = ()) -> Iterator[Path_]:
    """Every place of a document; of a long list of numbers, the ends."""
    yield here
    if isinstance(value, dict):
        for key, inner in value.items():
            yield from paths(inner, (*here, key))
    elif isinstance(value, list):
        numbers = len(value) > 4 and all(isinstance(inner, float | int) for inner in value)
        for i in (0, len(value) - 1) if numbers else range(len(value)):
            yield from paths(value[i], (*here, i))


def damaged(path: Path_, junk: str) -> str:
    changed: Any = {"all": json.loads(made()[1])}
    inner = changed
    for key in ("all", *path)[:-1]:
        inner = inner[key]
    inner[("all", *path)[-1]] = "JUNK"
    return json.dumps(changed["all"]).replace('"JUNK"', junk)


@pytest.mark.parametrize("inertia", ["urdf", "scaled", "free"])
def test_everything_works_after_reading_back(inertia: Inertia, tmp_path: Path) -> None:
    found, _, run = made(inertia)
    again = jid.RobotEstimate.load(found.save(tmp_path / "arm.json"))
    assert again.report(verbose=True) == found.report(verbose=True)
    assert again.to_json() == found.to_json()
    speeds = np.array([[0.05, -0.2], [1.0, 0.0]])
    assert again.friction(speeds).tobytes() == found.friction(speeds).tobytes()
    assert again.predict(run) == found.predict(run)
    assert report_page(again) == report_page(found)
    path = urdf(tmp_path)
    files = [
        jid.export(each, tmp_path / f"{name}.urdf", into=path, approximate=True).read_bytes()
        for name, each in (("found", found), ("again", again))
    ]
    assert files[0] == files[1]
    with pytest.raises(jid.InputError, match="read from a file"):
        again.bootstrap()


@pytest.mark.filterwarnings("ignore:.*(overflow|invalid value):RuntimeWarning")
@pytest.mark.parametrize("every", [False, pytest.param(True, marks=pytest.mark.slow)])
@pytest.mark.parametrize("junk", JUNK)
def test_every_place_of_a_saved_robot(junk: str, every: bool) -> None:
    accepted = 0
    places = list(paths(json.loads(made()[1])))
    for path in places if every else dealt(places, [*JUNK].index(junk), len(JUNK)):
        try:
            found = jid.RobotEstimate.from_json(damaged(path, JUNK[junk]))
        except jid.InputError as error:
            sentence = str(error)
            assert "\n" not in sentence
            assert 10 < len(sentence) < 600, (path, sentence)
            continue
        accepted += 1
        found.report()
        found.to_json()
        assert found.friction([0.1, -0.2]).shape == (2,)
    assert accepted == 0 if junk in NEVER else accepted or not every


def test_the_place_is_named(tmp_path: Path) -> None:
    path = tmp_path / "bad.json"
    path.write_text(damaged(("joints", "elbow", "parameters", "coulomb", "value"), "null"))
    with pytest.raises(jid.InputError, match=r"bad\.json: joints\.elbow\.parameters\.coulomb\.val"):
        jid.RobotEstimate.load(path)
    with pytest.raises(jid.InputError, match="there is no such file"):
        jid.RobotEstimate.load(tmp_path / "none.json")


@pytest.mark.parametrize(
    ("path", "junk", "reason"),
    [
        (("kind",), '"jointid estimate"', "not a robot's estimate"),
        (("schema",), "1", "identify again"),
        (("schema",), "9", "update jointid"),
        (("robot", "joints", 0, "name"), '"elbow"', "there twice"),
        (("robot", "joints", 0, "name"), '"wrist"', "the robot has wrist"),
        (("robot", "joints", 1, "parent"), "1", "the index of an earlier link"),
        (("robot", "joints", 0, "rotation", 0, 0), "0.5", "a rotation"),
        (("robot", "joints", 0, "axis"), "[0.0, 0.0, 0.0]", "length 1"),
        (("robot", "couplings"), "[[1.0, 0.0], [1.0, 0.0]]", "singular"),
        (("robot", "couplings", 0), "[1.0]", "2 rows of 2"),
        (("robot", "gear_ratios"), "[1.0, 0.0]", "not 0"),
        (("robot", "zero_offsets"), "[1.0]", "2 numbers"),
        (("joints", "elbow", "model"), '"coulomb_viscous"', "does not fit"),
        (("joints", "elbow", "parameters", "coulomb", "name"), '"static"', "the key of this entry"),
        (("joints", "elbow", "windows", "start"), "[1.0]", "same length"),
        (("joints", "elbow", "windows", "recording", 0), "1", "index into settings.recordings"),
        (("base_parameters", 1, "name"), '"Iyy_1 + 0.16 m_2 + rotor_1"', "twice"),
        (("free", 0), '"shoulder.current"', "no parameter has this name"),
        (("free", 0), '"shoulder.viscous"', "there twice"),
        (("covariance",), "[[1.0]]", "rows of"),
        (("inertial", 0), "[1.0]", "10 to 10 items"),
        (("settings", "min_speed"), "[0.0]", "2 numbers"),
        (("settings", "shift"), '{"torque": 5.0}', "settings"),
        (("settings", "shift"), '{"torque": {"wrist": 0.01}}', "no such joint"),
    ],
)
def test_fields_that_contradict_each_other(path: Path_, junk: str, reason: str) -> None:
    with pytest.raises(jid.InputError, match=reason):
        jid.RobotEstimate.from_json(damaged(path, junk))


def test_a_parameter_that_is_missing_is_named() -> None:
    document = json.loads(made()[1])
    for key, reason in (
        ("viscous", "this is missing"),
        ("stribeck", "go together"),
        ("motor_viscous", "go together"),
    ):
        kept = json.loads(made()[1])
        del kept["joints"]["elbow"]["parameters"][key]
        with pytest.raises(jid.InputError, match=reason):
            jid.RobotEstimate.from_json(json.dumps(kept))
    document["joints"]["elbow"]["parameters"]["ripple"] = document["joints"]["elbow"]["parameters"][
        "coulomb"
    ]
    with pytest.raises(jid.InputError, match="choose one of coulomb"):
        jid.RobotEstimate.from_json(json.dumps(document))


def test_a_joint_that_stands_still_is_read_back(tmp_path: Path) -> None:
    """It has no windows, and infinite errors."""
    path = urdf(tmp_path)
    run = recording(path, duration=6.0)
    fields = run.fields()
    fields["position"] = fields["position"] * np.array([1.0, 0.0])
    found = jid.identify_robot(jid.RobotRecording(**fields), jid.Robot.from_urdf(path))
    again = jid.RobotEstimate.from_json(found.to_json())
    assert again.report(verbose=True) == found.report(verbose=True)
    assert again.joints["elbow"].windows.start.size == 0
