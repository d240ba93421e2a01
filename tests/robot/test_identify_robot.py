"""A small arm with known friction: models, facts, predictions, what is refused."""

from pathlib import Path

import numpy as np
import pytest
from small_arm import COULOMB, ROTOR, URDF, VISCOUS, recording, urdf

import jointid as jid
from jointid.robot.links.inertia_modes import Inertia

pytest.importorskip("pinocchio")


@pytest.fixture(name="path", scope="module")
def _path(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return urdf(tmp_path_factory.mktemp("small"))


@pytest.fixture(name="run", scope="module")
def _run(path: Path) -> jid.RobotRecording:
    return recording(path)


def values(found: jid.RobotEstimate, name: str) -> np.ndarray:
    return np.array([joint.parameters[name].value for joint in found.joints.values()])


@pytest.mark.parametrize("inertia", ["urdf", "scaled", "free"])
def test_known_friction_comes_back(path: Path, run: jid.RobotRecording, inertia: Inertia) -> None:
    found = jid.identify_robot(run, jid.Robot.from_urdf(path), inertia=inertia)
    assert list(found.joints) == ["shoulder", "elbow"]
    np.testing.assert_allclose(values(found, "coulomb"), COULOMB, rtol=0.01)
    np.testing.assert_allclose(values(found, "viscous"), VISCOUS, rtol=0.01)
    assert {joint.model for joint in found.joints.values()} == {"coulomb_viscous"}
    assert found.warnings == ()
    assert found.relative_residual < 0.01


def test_rotor_inertias_are_identified_or_taken_as_given(
    path: Path, run: jid.RobotRecording
) -> None:
    found = jid.identify_robot(run, jid.Robot.from_urdf(path))
    np.testing.assert_allclose(values(found, "rotor_inertia"), ROTOR, rtol=0.02)
    given = jid.Robot.from_urdf(path, rotor_inertias=list(ROTOR))
    scaled = jid.identify_robot(run, given, inertia="scaled")
    assert "rotor_inertia" not in scaled.joints["shoulder"].parameters
    np.testing.assert_allclose(values(scaled, "inertia_scale"), 1.0, atol=0.02)
    assert scaled.consistent is True


def test_base_parameters_explain_the_motion_as_the_urdf_does(
    path: Path, run: jid.RobotRecording
) -> None:
    """What the two links weigh comes back in the combinations that motion shows."""
    robot = jid.Robot.from_urdf(path, rotor_inertias=list(ROTOR))
    found = jid.identify_robot(run, robot, inertia="free")
    # A planar arm: Iyy and first moments of both links, in combinations.
    combination = "Iyy_1 + 0.16 m_2"
    truth = 0.06 + 5 * 0.2**2 + 0.16 * 3
    assert found.base_parameters[combination].value == pytest.approx(truth, rel=0.02)
    for name, p in found.base_parameters.items():
        assert p.stderr is not None, name


def test_static_friction_is_found_where_it_is(path: Path) -> None:
    found = jid.identify_robot(recording(path, static=0.5), jid.Robot.from_urdf(path))
    for number, joint in enumerate(found.joints.values()):
        assert joint.model == "stribeck"
        assert joint.parameters["static"].value == pytest.approx(0.5 * COULOMB[number], rel=0.1)
        assert joint.parameters["stribeck"].value == pytest.approx(100.0, rel=0.15)
    np.testing.assert_allclose(values(found, "coulomb"), COULOMB, rtol=0.01)
    told = found.friction(np.array([0.05, -0.2]))
    dry = COULOMB * (1.0 + 0.5 * np.exp(-100.0 * np.array([0.05, -0.2]) ** 2))
    np.testing.assert_allclose(told, dry * [1, -1] + VISCOUS * [0.05, -0.2], rtol=0.02)


def test_a_model_for_each_joint(path: Path, run: jid.RobotRecording) -> None:
    robot = jid.Robot.from_urdf(path)
    models = {"shoulder": "stribeck", "elbow": "coulomb_viscous"}
    found = jid.identify_robot(run, robot, model=models)
    assert [joint.model for joint in found.joints.values()] == ["stribeck", "coulomb_viscous"]
    with pytest.raises(jid.InputError, match="wrist"):
        jid.identify_robot(run, robot, model={"shoulder": "stribeck", "wrist": "stribeck"})
    with pytest.raises(jid.InputError, match="stribeck"):
        jid.identify_robot(run, robot, model="stribeck:ripple=2")


@pytest.mark.parametrize("inertia", ["urdf", "scaled", "free"])
def test_a_prediction_of_the_same_recording_has_the_same_residual(
    path: Path, run: jid.RobotRecording, inertia: Inertia
) -> None:
    found = jid.identify_robot(run, jid.Robot.from_urdf(path), inertia=inertia)
    again = found.predict(run)
    assert again.relative_residual == pytest.approx(found.relative_residual, rel=1e-6)
    other = found.predict(recording(path, seed=3))
    assert 0.0 < other.relative_residual < 0.02
    assert list(other.joints) == ["shoulder", "elbow"]


def test_several_recordings_are_one_fit(path: Path, run: jid.RobotRecording) -> None:
    robot = jid.Robot.from_urdf(path)
    both = jid.identify_robot([run.crop(0.0, 6.0), run.crop(6.0, 12.0)], robot)
    np.testing.assert_allclose(values(both, "coulomb"), COULOMB, rtol=0.01)
    assert set(both.joints["elbow"].windows.recording) == {0, 1}


def test_pieces_of_a_long_recording_are_joined(
    path: Path, run: jid.RobotRecording, monkeypatch: pytest.MonkeyPatch
) -> None:
    from jointid.robot.fit import attempt

    robot = jid.Robot.from_urdf(path)
    whole = jid.identify_robot(run, robot)
    monkeypatch.setattr(attempt, "_PIECE", 2500)
    parts = jid.identify_robot(run, robot)
    for name in ("coulomb", "viscous", "rotor_inertia"):
        np.testing.assert_allclose(values(parts, name), values(whole, name), rtol=5e-3)
    assert set(parts.joints["elbow"].windows.recording) == {0}


def test_a_whole_number_of_windows_is_how_many(path: Path, run: jid.RobotRecording) -> None:
    found = jid.identify_robot(run, jid.Robot.from_urdf(path), windows=150)
    assert found.settings["window_duration"] == pytest.approx(12.0 / 150, rel=1e-3)
    assert found.joints["elbow"].residuals.windows <= 150


def test_swapped_joints_are_named(path: Path) -> None:
    swapped = recording(path, names=("elbow", "shoulder"))
    found = jid.identify_robot(swapped, jid.Robot.from_urdf(path))
    named = next(each for each in found.warnings if each.code == "swapped_joints")
    assert "shoulder and elbow" in named.cause


def test_a_wrong_mass_is_named(path: Path, run: jid.RobotRecording, tmp_path: Path) -> None:
    wrong = urdf(tmp_path, URDF.replace('mass value="3"', 'mass value="2"'))
    robot = jid.Robot.from_urdf(wrong, rotor_inertias=list(ROTOR))
    codes = {each.code for each in jid.identify_robot(run, robot).warnings}
    assert codes & {"wrong_inertia"}


def test_a_joint_that_stands_still_is_reported(path: Path, run: jid.RobotRecording) -> None:
    fields = run.fields()
    position = fields["position"].copy()
    position[:, 1] = 0.3
    still = jid.RobotRecording(**{**fields, "position": position})
    found = jid.identify_robot(still, jid.Robot.from_urdf(path))
    standing = [each for each in found.warnings if each.code == "standing"]
    assert any("elbow" in each.cause for each in standing)
    undetermined = {name for each in found.warnings for name in each.parameters}
    assert {"elbow.coulomb", "elbow.viscous"} <= undetermined


def test_the_urdf_gets_damping_and_friction(
    path: Path, run: jid.RobotRecording, tmp_path: Path
) -> None:
    found = jid.identify_robot(run, jid.Robot.from_urdf(path), model="coulomb_viscous")
    target = jid.export(found, tmp_path / "out.urdf", into=path)
    model = pytest.importorskip("pinocchio").buildModelFromUrdf(str(target))
    np.testing.assert_allclose(model.damping, values(found, "viscous"), rtol=1e-12)
    np.testing.assert_allclose(model.friction, values(found, "coulomb"), rtol=1e-12)
    assert "identified with all joints" in target.read_text(encoding="utf-8")
    with pytest.raises(jid.InputError, match=r"^into: .*; export with into=\.\.\.$"):
        jid.export(found, tmp_path / "alone.urdf")
    other = tmp_path / "out.xml"
    for into in (None, path):  # the file to write is wrong, whatever is edited
        with pytest.raises(jid.InputError, match=r"ends in \.urdf") as caught:
            jid.export(found, other, into=into)
        assert (caught.value.argument, caught.value.value) == ("path", str(other))
    rich = jid.identify_robot(recording(path, static=0.5), jid.Robot.from_urdf(path))
    with pytest.raises(jid.InputError, match="static friction"):
        jid.export(rich, tmp_path / "lost.urdf", into=path)
    assert jid.export(rich, tmp_path / "lost.urdf", into=path, approximate=True).is_file()


@pytest.mark.parametrize(
    ("options", "argument"),
    [
        ({"joints": ["wrist"]}, "joints"),
        ({"gear_ratios": [1.0]}, "gear_ratios"),
        ({"gear_ratios": [1.0, 0.0]}, "gear_ratios"),
        ({"couplings": [[1.0, 0.0], [1.0, 0.0]]}, "couplings"),
        ({"couplings": {"elbow": {"wrist": 1.0}}}, "couplings"),
        ({"rotor_inertias": [0.1, -0.1]}, "rotor_inertias"),
        ({"zero_offsets": [0.0]}, "zero_offsets"),
        ({"side": "link"}, "side"),
    ],
)
def test_what_does_not_fit_the_urdf_is_refused(
    path: Path, options: dict[str, object], argument: str
) -> None:
    with pytest.raises(jid.InputError) as caught:
        jid.Robot.from_urdf(path, **options)  # type: ignore[arg-type]
    assert caught.value.argument.split(".")[0] == argument


def test_options_that_nobody_knows_are_refused(path: Path, run: jid.RobotRecording) -> None:
    robot = jid.Robot.from_urdf(path)
    for options, argument in (
        ({"inertia": "all"}, "inertia"),
        ({"windows": 0.0}, "windows"),
        ({"windows": "cumulative"}, "windows"),
        ({"min_speed": -1.0}, "min_speed"),
        ({"min_speed": {"wrist": 1.0}}, "min_speed"),
    ):
        with pytest.raises(jid.InputError) as caught:
            jid.identify_robot(run, robot, **options)
        assert caught.value.argument == argument
    with pytest.raises(jid.InputError, match="RobotRecording"):
        jid.identify_robot([], robot)
    bare = jid.RobotRecording(time=run.time, position=run.position, names=run.names)
    with pytest.raises(jid.InputError, match="no torque"):
        jid.identify_robot(bare, robot)


def test_a_file_that_is_no_urdf_is_refused(tmp_path: Path) -> None:
    with pytest.raises(jid.InputError):
        jid.Robot.from_urdf(urdf(tmp_path, "<robot/>"))
    with pytest.raises((jid.InputError, OSError)):
        jid.Robot.from_urdf(tmp_path / "none.urdf")
