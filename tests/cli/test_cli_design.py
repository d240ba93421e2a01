"""The command `design`: the file, the picture, JSON, Ctrl-C; what the bench file says, and the way through the bus."""

import json
import os
import shutil
import signal
import threading
import time
from pathlib import Path

import pytest
from designs import bench_text

import jointid as jid
from jointid.cli.command_line import main
from jointid.cli.progress import MotionProgress
from jointid.excitation.tables import answer
from jointid.hardware.bench.bench import Bench

Printed = pytest.CaptureFixture[str]
QUICK = ["--duration", "4", "--evaluations", "100", "--joints", "2", "--rehearsals", "10"]
WITHIN = ["--position", "-60deg,60deg", "--velocity", "3.4"]
TRUTH = {"coulomb": 25.0, "static": 20.0, "stribeck": 100.0, "viscous": 20.0}
TRUTH |= {"sensor_gain": 2.4, "sensor_offset": 15.0}


@pytest.fixture
def bench(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A bench file in a folder of its own, whose session takes the motion that is to be designed."""
    monkeypatch.chdir(tmp_path)
    path = tmp_path / "joint.toml"
    path.write_text(bench_text(), encoding="utf-8")
    return path


@pytest.fixture(scope="module")
def designed(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A motion for that bench."""
    path = tmp_path_factory.mktemp("designed") / "joint.toml"
    path.write_text(bench_text(), encoding="utf-8")
    motion = path.with_name("motion.toml")
    assert main(["design", str(path), *QUICK, *WITHIN, "--output", str(motion), "--quiet"]) == 0
    return motion


def test_it_writes_the_motion_the_picture_and_the_table(bench: Path, capsys: Printed) -> None:
    words = ["design", "joint.toml", *QUICK, *WITHIN]
    assert main([*words, "--output", "motion.toml", "--plot", "motion.png"]) == 0
    printed = capsys.readouterr()
    design = jid.load_design("motion.toml")
    assert printed.out == f"{answer(design)}\npicture: motion.png\nmotion: motion.toml\n"
    lines = printed.out.splitlines()
    assert len(lines) <= 16
    assert max(map(len, lines)) <= 100
    for name, expected in design.parameters.items():
        assert any(line.split()[0] == name and expected.unit in line for line in lines)
    assert printed.err == ""
    assert Path("motion.png").read_bytes().startswith(b"\x89PNG")
    assert design.limits.position == pytest.approx((-1.0472, 1.0472), abs=1e-4)
    assert design.duration == 4.0
    position, velocity, _ = design.trajectory.sample([i * 1e-3 for i in range(4001)])
    assert abs(position).max() <= 1.0473
    assert abs(velocity).max() <= 3.4


def test_the_bench_says_law_period_and_limits(bench: Path) -> None:
    assert main(["design", "joint.toml", *QUICK, "--output", "motion.toml", "--quiet"]) == 0
    design, own = jid.load_design("motion.toml"), Bench.load(bench)
    assert own.trajectory == design.trajectory
    assert design.controller == own.controller
    assert design.control_period == own.options.period == 2e-3
    assert design.limits.position == pytest.approx((-1.26, 1.26))  # nine tenths: it stops at ±1.4
    assert design.limits.velocity == pytest.approx(3.6)
    assert design.limits.torque == own.limits.torque
    assert design.sensors == jid.Sensors(
        torque_noise=0.003 * own.limits.torque,  # of which nothing is said
        encoder_counts=8000.0,
        velocity="counts",
        velocity_counts=own.options.velocity_counts,
        velocity_time=own.options.velocity_time,
    )


def test_the_options_say_law_period_and_sensors(bench: Path, tmp_path: Path) -> None:
    jid.thesis_joint().with_parameters(TRUTH).save(tmp_path / "true.toml")
    words = ["design", "joint.toml", *QUICK, "--output", "motion.toml", "--believe", "true.toml"]
    words += [
        "--sensor",
        "torque_noise=0.5",
        "--sensor",
        "velocity=exact",
        "--control-period",
        "0.001",
        "--gain",
        "bandwidth=60",
    ]
    words += ["--parameter", "viscous", "--parameter", "sensor_gain", "--prior", "viscous=16,24"]
    assert main([*words, "--criterion", "determinant", "--seed", "7"]) == 0
    design = jid.load_design("motion.toml")
    assert isinstance(design.controller, jid.AdaptiveRobust)
    assert (design.controller.coulomb, design.controller.bandwidth) == (25.0, 60.0)
    assert design.controller.friction_velocity == "reference"  # as the session has it
    sensors = design.sensors
    assert (sensors.torque_noise, sensors.velocity, sensors.encoder_counts) == (0.5, "exact", 8000)
    assert design.control_period == 1e-3
    assert [*design.parameters] == ["viscous", "sensor_gain"]
    assert (design.criterion, design.seed) == ("determinant", 7)


def test_a_sensor_that_is_stated_leaves_the_noise_that_is_assumed(bench: Path) -> None:
    text = bench.read_text(encoding="utf-8")
    Path("bare.toml").write_text(text[: text.index("[session]")], encoding="utf-8")
    words = ["design", "bare.toml", *QUICK, *WITHIN, "--output", "motion.toml"]
    assert main([*words, "--sensor", "encoder_counts=16000"]) == 0
    sensors = jid.load_design("motion.toml").sensors
    assert sensors.encoder_counts == 16000.0
    assert sensors.torque_noise == pytest.approx(0.48, abs=0.001)  # 0.3 % of the torque limit


def test_a_motion_that_keeps_no_limit_is_not_written(bench: Path, capsys: Printed) -> None:
    words = ["design", "joint.toml", *QUICK, *WITHIN, "--torque", "75", "--output", "motion.toml"]
    assert main(words) == 2
    printed = capsys.readouterr()
    assert printed.err.endswith("motion.toml was not written\n")
    assert printed.err.count("\n") == 1
    assert "limits exceeded" in printed.out.splitlines()[0]
    assert not Path("motion.toml").exists()


def test_json_is_what_the_file_holds(bench: Path, capsys: Printed) -> None:
    words = ["design", "joint.toml", *QUICK, *WITHIN, "--output", "motion.toml", "--json"]
    assert main(words) == 0
    assert json.loads(capsys.readouterr().out) == jid.load_design("motion.toml").to_dict()


def test_the_same_seed_is_the_same_motion(bench: Path) -> None:
    for name, threads in (("a", "1"), ("b", "2")):
        words = ["design", "joint.toml", *QUICK, *WITHIN, "--threads", threads]
        assert main([*words, "--output", f"{name}.toml", "--quiet"]) == 0
    assert Path("a.toml").read_bytes() == Path("b.toml").read_bytes()


def test_simulate_takes_the_motion(bench: Path, tmp_path: Path) -> None:
    jid.thesis_joint().with_parameters(TRUTH).save(tmp_path / "true.toml")
    assert main(["design", "joint.toml", *QUICK, *WITHIN, "--output", "motion.toml"]) == 0
    words = ["simulate", "true.toml", "--trajectory", "motion.toml", "--output", "run.csv"]
    assert main(words) == 0
    assert jid.load("run.csv").duration == pytest.approx(4.0, abs=2e-3)


def test_a_session_with_narrower_limits_refuses_the_motion(bench: Path, capsys: Printed) -> None:
    assert main(["design", "joint.toml", *QUICK, "--output", "motion.toml", "--quiet"]) == 0
    text = bench.read_text(encoding="utf-8")
    bench.write_text(text.replace("position = [-1.4, 1.4]", "position = [-0.2, 0.2]"), "utf-8")
    capsys.readouterr()
    assert main(["run", "joint.toml", "--emulate", "--output", "runs"]) == 2
    said = capsys.readouterr().err
    assert said.count("\n") == 1
    assert "joint.toml: [session.trajectory]: file is motion.toml: in this motion joints go" in said
    assert "outside the session's -0.2000 to 0.2000 rad" in said
    assert not Path("runs").exists()


def test_a_session_names_in_what_its_bench_is_another(
    bench: Path, designed: Path, capsys: Printed
) -> None:
    shutil.copy(designed, "motion.toml")
    run = ["run", "joint.toml", "--emulate", "--cycles", "0", "--quiet", "--output"]
    assert main([*run, "same"]) == 0
    assert "designed for" not in "".join(capsys.readouterr())
    assert "motion_warning" not in jid.load("same/initial.csv").metadata
    text = bench.read_text(encoding="utf-8")
    text = text.replace("coulomb = { value = 20.0,", "coulomb = { value = 12.0,", 1)
    bench.write_text(text.replace("mass = 3.0", "mass = 3.5", 1), "utf-8")
    warning = Bench.load(bench).motion_warning
    assert "motion.toml was designed for link mass 3 (here 3.5)" in warning
    assert "the controller's coulomb 20 (here 12)" in warning
    assert main([*run, "other"]) == 0
    said = capsys.readouterr()
    assert said.err == f"jointid run: warning: {warning}\n"
    assert warning in said.out
    assert jid.load("other/initial.csv").metadata["motion_warning"] == warning
    assert main(["run", "joint.toml", "--emulate", "--dry-run", "--json"]) == 0
    said = capsys.readouterr()
    assert json.loads(said.out)["motion_warning"] == warning
    assert warning in said.err


def test_a_copy_of_the_bench_is_not_parted_from_its_motion(
    bench: Path, designed: Path, capsys: Printed
) -> None:
    shutil.copy(designed, "motion.toml")
    Path("elsewhere").mkdir()
    words = ["run", "joint.toml", "--emulate", "--cycles", "1", "--quiet", "--save"]
    capsys.readouterr()
    assert main([*words, "elsewhere/joint.toml"]) == 2
    said = capsys.readouterr().err
    assert "--save elsewhere/joint.toml: the motion file motion.toml is in the folder of" in said
    assert main([*words, "known.toml"]) == 0
    assert Bench.load("known.toml").trajectory == Bench.load(bench).trajectory


@pytest.mark.parametrize("long", [["--evaluations", "1000000"], [*QUICK, "--rehearsals", "50000"]])
def test_ctrl_c_ends_it_at_once_and_writes_nothing(
    long: list[str], bench: Path, capsys: Printed
) -> None:
    asked: list[float] = []

    def ask() -> None:
        asked.append(time.monotonic())
        os.kill(os.getpid(), signal.SIGINT)

    timer = threading.Timer(0.5, ask)
    timer.start()
    try:
        words = ["design", "joint.toml", *WITHIN, "--output", "motion.toml", *long]
        assert main(words) == 130
    finally:
        timer.cancel()
    assert time.monotonic() - asked[0] < 0.5
    assert capsys.readouterr().err == "jointid: interrupted\n"
    assert not Path("motion.toml").exists()


def test_the_bar_is_drawn_on_a_terminal_only(bench: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    steps = []
    monkeypatch.setattr(MotionProgress, "__call__", lambda _, step: steps.append(step))
    assert main(["design", "joint.toml", *QUICK]) == 0
    assert steps
    assert steps[-1].number <= steps[-1].total
