"""A design's file: all of it comes back, a session and `simulate` take it, and faults are named."""

import json
import math
import tomllib
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import pytest
from designs import JOINT, designed, motion

import jointid as jid
from jointid.simulation.arguments import LAWS
from jointid.simulation.motion_file import load_motion

DESIGN = designed()


@pytest.fixture
def path(tmp_path: Path) -> Path:
    path = tmp_path / "motion.toml"
    DESIGN.save(path)
    return path


def test_all_of_it_comes_back(path: Path) -> None:
    found = jid.load_design(path)
    assert found == DESIGN
    assert found.trajectory.sample([1.3]) == DESIGN.trajectory.sample([1.3])


def test_the_smallest_design_comes_back(tmp_path: Path) -> None:
    joint = jid.Joint(inertia=1.0).with_parameters({"coulomb": 1.0, "viscous": 2.0})
    bare = designed(
        joint=joint,
        controller=jid.Pd(stiffness=100.0, damping=10.0),
        sensors=jid.Sensors(),
        peaks=replace(DESIGN.peaks, sensor_torque=None),
        parameters={
            "coulomb": replace(DESIGN.parameters["coulomb"], stderr=math.inf, relative=math.inf)
        },
        reference={},
        weakest="coulomb",
        status="limits not reachable",
        reason='no motion keeps "them" — \x7f\n\\',
        seed=2**64 - 1,
    )
    bare.save(tmp_path / "bare.toml")
    assert jid.load_design(tmp_path / "bare.toml") == bare


@pytest.mark.parametrize("law", LAWS)
def test_every_controller_comes_back(law: str, tmp_path: Path) -> None:
    design = designed(controller=LAWS[law]())
    design.save(tmp_path / "motion.toml")
    assert jid.load_design(tmp_path / "motion.toml").controller == design.controller


def test_its_motion_is_any_motion(path: Path) -> None:
    found = load_motion(path)
    assert found.trajectory == DESIGN.trajectory
    assert found.peaks == DESIGN.peaks


def test_the_dict_is_the_files_and_jsons(path: Path) -> None:
    document = DESIGN.to_dict()
    assert json.loads(json.dumps(document, allow_nan=False)) == document
    assert tomllib.loads(path.read_text(encoding="utf-8")) == document


def test_a_failed_write_changes_nothing(path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    before = path.read_bytes()

    def full(*_: object) -> None:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr("os.fsync", full)
    with pytest.raises(OSError, match="No space left") as refused:
        replace(DESIGN, seed=9).save(path)
    assert refused.value.filename == str(path)
    assert path.read_bytes() == before
    assert [each.name for each in path.parent.iterdir()] == ["motion.toml"]


def test_another_ending_is_refused(tmp_path: Path) -> None:
    with pytest.raises(
        jid.InputError, match=r"path is 'motion\.yaml': a design is saved as \.toml or \.json"
    ):
        DESIGN.save(tmp_path / "motion.yaml")


def test_a_motion_alone_is_no_design(tmp_path: Path) -> None:
    path = tmp_path / "hand.toml"
    path.write_text('[trajectory]\nform = "thesis"\n', encoding="utf-8")
    with pytest.raises(jid.InputError, match=r"hand\.toml: this motion has no table \[design\]"):
        jid.load_design(path)


@pytest.mark.parametrize(
    ("before", "after", "says"),
    [
        (
            "schema = 1",
            "schema = 2",
            "schema is 2: this version of jointid reads schemas up to 1; update jointid",
        ),
        ("schema = 1", "", "schema: this is missing"),
        (
            'criterion = "worst"',
            'criterion = "best"',
            r"design\.criterion: .*choose one of worst, det",
        ),
        ('weakest = "sensor_gain"', 'weakest = "gain"', r"design\.weakest: .*in \[expected\]"),
        (
            "[-1.0, 1.0]",
            "[0.0, 5e-324]",
            r"limits: position is \[0\.0, 5e-324\]: a window that is at least 1e-09",
        ),
        ("[-1.0, 1.0]", "[-1e308, 1e308]", r"limits: position .*at most 1e\+09 from 0"),
        ("velocity = 3.4", "velocity = 5e-324", "limits: velocity is 5e-324: at least 1e-09"),
        ("seed = 3", "seed = -3", r"design\.seed: .*a number from 0"),
        ("seed = 3", "seed = 1.5", r"design\.seed: .*an integer"),
        ('status = "complete"', "status = 1", r"design\.status: .*text"),
        ("stderr = 0.18", "stderr = nan", r"expected\.stribeck\.stderr: .*finite"),
        ("stderr = 0.18", "stderr = -0.18", r"expected\.stribeck\.stderr: .*from 0 to inf"),
        (
            "[expected.static]\nunit",
            "[expected.static]\nunits",
            r"expected\.static\.unit: this is missing",
        ),
        ('law = "adaptive_robust"', 'law = "adaptive"', r"controller\.law: .*choose one of"),
        ("bandwidth = 80.0", 'bandwidth = "wide"', r"controller\.bandwidth: .*a number"),
        ("bandwidth = 80.0", "bandwidth = -80.0", "controller: .*bandwidth"),
        ("bandwidth = 80.0", "bandwith = 80.0", r"controller\.bandwith: unknown"),
        ("torque_noise = 0.5", "torque_noise = -0.5", "sensors: .*torque_noise"),
        ("converter_bits = 0", "converter_bits = 0.5", r"sensors\.converter_bits: .*integer"),
        ("gear_ratio = 101.0", "gear_ratio = 0.0", r"\[joint\]: \[drive\]: gear_ratio"),
        (
            "position = [-1.0, 1.0]",
            "position = [1.0, -1.0]",
            "limits: position .*the first value must be",
        ),
        ("velocity = 3.4", "velocity = 0.0", "limits: velocity is 0.0: more than 0"),
        ('form = "sines"', 'form = "sins"', r"trajectory\.form: .*choose one of"),
        ("[peaks]", "[peeks]", "peaks: this is missing|peeks: unknown"),
        ("[sensors]", '[sensors]\nlaw = "pd"', r"sensors\.law: unknown"),
        ("[sensors]", "[sensors.x]", r"sensors\.x: unknown"),
    ],
)
def test_a_file_that_cannot_be_used_is_named_with_its_key(
    path: Path, before: str, after: str, says: str
) -> None:
    text = path.read_text(encoding="utf-8")
    assert before in text
    path.write_text(text.replace(before, after, 1), encoding="utf-8")
    with pytest.raises(jid.InputError, match=rf"motion\.toml: .*({says})") as refused:
        jid.load_design(path)
    assert str(refused.value).count("motion.toml") == 1
    assert "\n" not in str(refused.value)


def test_a_file_cut_anywhere_is_refused(path: Path) -> None:
    text = path.read_text(encoding="utf-8").rstrip("\n")
    for end in [*range(0, len(text), 53), len(text) - 1]:
        path.write_text(text[:end], encoding="utf-8")
        with pytest.raises(jid.InputError, match=r"motion\.toml"):
            jid.load_design(path)


def test_only_sines_are_saved(tmp_path: Path) -> None:
    with pytest.raises(jid.InputError, match="a sum of sines is expected"):
        designed(trajectory=jid.Trajectory.step(0.1, duration=6.0)).save(tmp_path / "motion.toml")
    assert not list(tmp_path.iterdir())


def test_the_file_simulates_the_same(path: Path) -> None:
    found = jid.load_design(path)
    first = jid.simulate(JOINT, DESIGN.controller, motion(), duration=1.0)
    again = jid.simulate(found.joint, found.controller, found.trajectory, duration=1.0)
    assert (first.position == again.position).all()


def test_a_session_does_not_run_the_file_of_a_later_jointid(path: Path) -> None:
    text = path.read_text(encoding="utf-8")
    path.write_text(text.replace("schema = 1", "schema = 2", 1), encoding="utf-8")
    with pytest.raises(
        jid.InputError, match=r"schema is 2: this version of jointid reads schemas up to 1; update"
    ):
        load_motion(path)


@pytest.mark.parametrize("read", [load_motion, jid.load_design])
def test_a_range_the_wrong_way_round_is_named(read: Callable[[Path], object], path: Path) -> None:
    designed(believed={"coulomb": (30.0, 20.0)}).save(path)
    with pytest.raises(jid.InputError, match=r"believed\.coulomb: .*must not be above the second"):
        read(path)
