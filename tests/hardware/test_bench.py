"""Bench files: what is read, and how errors are worded."""

import math
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

import jointid as jid
from jointid.hardware.bench.bench import Bench
from jointid.hardware.bench.emulated_joints import true_joint
from jointid.hardware.bench.opened_drive import emulated_devices
from jointid.hardware.elmo.drive import ElmoDrive
from jointid.hardware.elmo.torque_source import AnalogInput, SyncedConverter
from jointid.hardware.emulated.bus import EmulatedBus
from jointid.hardware.session.options import SessionOptions
from jointid.simulation.peaks import Peaks

EXAMPLE = Path(__file__).parents[2] / "examples" / "hardware" / "joint.toml"
TEXT = EXAMPLE.read_text(encoding="utf-8")


def written(folder: Path, before: str, after: str) -> Path:
    """The example with one text for another."""
    assert TEXT.count(before) >= 1, before
    path = folder / "joint.toml"
    path.write_text(TEXT.replace(before, after, 1), encoding="utf-8")
    return path


def test_the_example_is_the_thesis_bench() -> None:
    bench = Bench.load(EXAMPLE)
    thesis = jid.thesis_joint()
    assert bench.joint.gear_ratio == thesis.gear_ratio
    assert bench.joint.reflected_inertia == thesis.reflected_inertia
    assert bench.joint.limits.current == thesis.limits.current
    assert bench.joint.parameters["stribeck"].max == thesis.parameters["stribeck"].max
    assert isinstance(bench.controller, jid.AdaptiveRobust)
    ripple = {"ripple_sin_2", "ripple_cos_2"}  # which no controller compensates
    believed = {name: p.value for name, p in bench.joint.parameters.items() if name not in ripple}
    assert {name: getattr(bench.controller, name) for name in believed} == believed
    assert bench.trajectory == jid.Trajectory.thesis(math.radians(60), cycle=3.0, duration=12.0)
    assert isinstance(bench.drive.torque, SyncedConverter)
    assert bench.limits.torque == pytest.approx(8.0 * 0.198 * 101.0)
    assert bench.options.resolution is None
    assert bench.drive.resolution(bench.joint) == 2.0 * math.pi / 808_000
    assert bench.emulation is not None
    assert bench.emulation.truth["sensor_gain"] == 2.4


def test_a_joint_file_still_reads_it() -> None:
    joint = jid.Joint.load(EXAMPLE)
    assert joint == Bench.load(EXAMPLE).joint


def test_saving_an_estimate_keeps_the_session(tmp_path: Path) -> None:
    path = tmp_path / "joint.toml"
    path.write_text(TEXT, encoding="utf-8")
    jid.Joint.load(path).with_parameters({"coulomb": 25.0}).save(path)
    kept = Bench.load(path)
    assert kept.joint.parameters["coulomb"].value == 25.0
    assert kept.drive == Bench.load(EXAMPLE).drive
    assert "the drive's PL[1] must not be larger" in path.read_text(encoding="utf-8")


def test_the_drives_analog_input_is_a_source(tmp_path: Path) -> None:
    begin = TEXT.index("[session.torque]")
    end = TEXT.index("[session.trajectory]")
    path = tmp_path / "joint.toml"
    table = '[session.torque]\nsource = "analog"\nnumber = 2\nevery = 5\nfull_scale = 300.0\n\n'
    path.write_text(TEXT[:begin] + table + TEXT[end:], encoding="utf-8")
    source = Bench.load(path).drive.torque
    assert isinstance(source, AnalogInput)
    assert (source.number, source.every, source.scaling.full_scale) == (2, 5, 300.0)
    table = '[session.torque]\nsource = "none"\n\n'
    path.write_text(TEXT[:begin] + table + TEXT[end:], encoding="utf-8")
    assert Bench.load(path).drive.torque is None


def driven(path: Path) -> ElmoDrive:
    """The drive of a bench file."""
    bench = Bench.load(path)
    return ElmoDrive(EmulatedBus(), bench.joint, bench.drive)


@pytest.mark.parametrize(
    ("before", "after", "wording"),
    [
        (
            "period = 0.002",
            "periode = 0.002",
            r"\[session\]: periode: unknown key; did you mean 'period'",
        ),
        ("period = 0.002", "period = 0.0", r"\[session\]: period is 0.0: more than 0"),
        ("period = 0.002", 'period = "fast"', r"\[session\]: period is 'fast': a number"),
        ("node = 127", "node = 12.5", r"\[session.drive\]: node is 12.5: a whole number"),
        ("node = 127", "node = 128", r"\[session.drive\]: node is 128: 1 to 127"),
        ("heartbeat = 0.05", "heartbeat = 60", r"\[session.drive\]: heartbeat is 60"),
        (
            'source = "converter"',
            'source = "convertor"',
            r"\[session.torque\]: source is 'convertor'",
        ),
        ('form = "thesis"', 'form = "cosine"', r"\[session.trajectory\]: form is 'cosine'"),
        ("cycle = 3.0", "cyle = 3.0", r"\[session.trajectory\]: cyle: unknown key; did you mean"),
        ("amplitude =", "form2 =", r"\[session.trajectory\]: form2: unknown key"),
        (
            'form = "thesis"',
            'form = "sigmoid"\nrise = 1.0',
            r"\[session.trajectory\]: amplitude: unknown key",
        ),
        (
            'form = "thesis"\namplitude = "60deg"\ncycle = 3.0 ',
            'form = "sigmoid"\ndistance = 1.0 ',
            r"\[session.trajectory\]: rise: missing; the form 'sigmoid' needs it",
        ),
        (
            'amplitude = "60deg"',
            'amplitude = "60 dge"',
            r"\[session.trajectory\]: amplitude is '60 dge': an angle is expected, in rad or as",
        ),
        ("cycle = 3.0", "cycle = 0.0", r"\[session.trajectory\]: .*cycle is 0.0"),
        ('law = "adaptive_robust"', 'law = "magic"', r"\[session.controller\]: law is 'magic'"),
        (
            "friction_velocity =",
            "friction_speed =",
            r"\[session.controller\]: friction_speed: unknown key",
        ),
        ("tracking_error = 0.1 ", "tracking_error = -1.0 ", r"\[session.limits\]: tracking_error"),
        ("tracking_error = 0.1 ", "tracking = 0.1 ", r"\[session.limits\]: tracking: unknown key"),
        ("period = 0.002", "period = 1e-9", r"\[session\]: period is 1e-09: at least 1e-05 s"),
        (
            "settle = 0.5",
            "settle = 1e12",
            r"\[session\]: settle is 1000000000000.0: at most 10000 s",
        ),
        (
            "approach_velocity = 0.3",
            "approach_velocity = 1e-12",
            r"\[session\]: approach_velocity is 1e-12: at least 0.0001 rad/s",
        ),
        (
            "duration = 12.0",
            "duration = 1e12",
            r"\[session.trajectory\]: duration is 1000000000000.0: at most 10000 s \(5000000 cycles\) is expected",
        ),
        (
            "identifier = 0x1C0",
            "identifier = 0xFFFFFF",
            r"\[session.torque\]: identifier: 0xFFFFFF is not a valid identifier",
        ),
        (
            "coulomb = 25.0",
            "coulomb = -25",
            r"\[session.emulated.truth\]: coulomb is -25: must be",
        ),
        ("bitrate = 500000", "bitrate = 5", r"\[session.bus\]: bitrate is 5"),
        ("mantissa_bits = 24", "mantissa_bits = 40", r"\[session.drive\]: mantissa_bits is 40"),
        ("idle_loop = 0.0003", "idle_loop = 1.0", r"\[session.emulated\]: idle_loop is 1.0"),
        ("priority = 75", "priority = 750", r"\[session.real_time\]: priority is 750"),
        ("lock_memory = true", "lock_memory = 1", r"lock_memory is 1: true or false"),
        (
            "ripple = 2.6 ",
            "encoder_counts = 8000 ",
            r"\[session.emulated.sensors\]: encoder_counts: unk",
        ),
        ("viscous = 20.0\nsensor", 'viscous = "x"\nsensor', r"\[session.emulated.truth\]: viscous"),
        (
            "viscous = 20.0\nsensor",
            "viscos = 20.0\nsensor",
            r"\[session.emulated.truth\]: .*viscos",
        ),
        (
            "[session.emulated.truth]",
            "[session.emulator.truth]",
            r"\[session\]: emulator: unknown table; did you",
        ),
        ("[session.trajectory]", "[session.limits.x]", r"no table \[session.trajectory\]"),
        ("gear_ratio = 101", "", r"\[drive\]: gear_ratio: missing"),
        ("coulomb = { value = 10.0, min", "coulomb = { min", "coulomb"),
        ("torque_constant = 0.198", "", "torque_constant"),
    ],
)
def test_an_error_names_its_place(tmp_path: Path, before: str, after: str, wording: str) -> None:
    path = written(tmp_path, before, after)
    with pytest.raises(jid.InputError, match=wording) as caught:
        driven(path)
    assert "\n" not in str(caught.value)


def test_a_joint_without_a_session_is_no_bench(tmp_path: Path) -> None:
    path = tmp_path / "joint.toml"
    jid.thesis_joint().save(path)
    with pytest.raises(jid.InputError, match=r"no table \[session\]"):
        Bench.load(path)


def test_the_emulated_gear_ripples_when_the_truth_says_so(tmp_path: Path) -> None:
    plain = true_joint(Bench.load(EXAMPLE))
    assert plain.model.resolved.ripple == ()
    truth = "sensor_offset = 15.0\nripple_sin_2 = 2.6\nripple_cos_2 = 0.5"
    rippled = true_joint(Bench.load(written(tmp_path, "sensor_offset = 15.0", truth)))
    assert rippled.model.ripple == (2.0,)
    assert rippled.parameters["ripple_sin_2"].value == 2.6
    assert rippled.parameters["ripple_cos_2"].value == 0.5


@pytest.mark.parametrize("bench", [None, 3])
def test_only_a_bench_has_a_drive(bench: Any) -> None:
    for opened in (jid.hardware.open_drive, emulated_devices):
        with pytest.raises(jid.InputError, match=f"^bench is {bench}: a Bench is expected$"):
            opened(bench)


def test_an_hour_at_a_kilohertz_is_a_session(tmp_path: Path) -> None:
    path = written(tmp_path, "duration = 12.0", "duration = 3600.0")
    path.write_text(path.read_text("utf-8").replace("period = 0.002", "period = 0.001"), "utf-8")
    assert Bench.load(path).trajectory.duration == 3600.0


@pytest.mark.parametrize(
    ("changes", "wording"),
    [
        ({"trajectory": jid.Trajectory.thesis(duration=1e12)}, "^trajectory.duration is 1000000"),
        (
            {"options": SessionOptions(approach_velocity=1e-4)},
            "^approach_velocity is 0.0001: at least 0.000204 rad/s is expected, because the start is 1.3 rad",
        ),
    ],
)
def test_too_many_cycles_are_refused_before_the_motor_is_on(
    changes: dict[str, Any], wording: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    bench = replace(Bench.load(EXAMPLE), **changes)
    assert bench.emulation is not None
    bench = replace(bench, emulation=replace(bench.emulation, position=1.3))
    enabled: list[str] = []
    monkeypatch.setattr(ElmoDrive, "enable", lambda _: enabled.append("on"))
    with jid.hardware.open_drive(bench, emulate=True) as drive:
        session = jid.hardware.Session(
            drive, bench.controller, bench.trajectory, bench.limits, options=bench.options
        )
        with pytest.raises(jid.InputError, match=wording):
            session.run()
    assert not enabled


MOTION = """[trajectory]
form = "sines"
amplitude = [0.5, 0.1]
frequency = [1.0, 2.5]
phase = [0.0, 0.7]
fade = 1.0
duration = 8.0
"""
PEAKS = "[peaks]\nposition = [-0.6, 0.6]\nvelocity = 1.0\nacceleration = 2.0\ntorque = 90.0\n"
OWN = TEXT[TEXT.index('form = "thesis"') : TEXT.index("[session.controller]")]


def with_motion(folder: Path, motion: str, more: str = "") -> Path:
    """The example, whose session takes its motion from a file beside it."""
    (folder / "motions").mkdir(exist_ok=True)
    (folder / "motions" / "motion.toml").write_text(motion, encoding="utf-8")
    return written(folder, OWN, f'file = "motions/motion.toml"\n{more}\n')


def test_a_session_takes_its_motion_from_a_file_beside_the_bench(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    path = with_motion(tmp_path, MOTION + PEAKS)
    monkeypatch.chdir("/")  # the name is that of the bench's folder, not of the program's
    assert Bench.load(path).trajectory == jid.Trajectory.sines(
        amplitude=(0.5, 0.1), frequency=(1.0, 2.5), phase=(0.0, 0.7), fade=1.0, duration=8.0
    )


@pytest.mark.parametrize(
    ("motion", "more", "wording"),
    [
        (MOTION, "duration = 3.0", "duration: the motion file already defines the whole motion"),
        ("", "", r"motion\.toml: trajectory: this is missing"),
        (
            MOTION.replace("duration = 8.0", "duration = 1e5"),
            "",
            "at most 10000 s \\(5000000 cycles\\) is expected",
        ),
        (
            MOTION + PEAKS.replace("[-0.6, 0.6]", "[-0.6, 1.5]"),
            "",
            r"joints go from -0\.6000 to 1\.5000 rad, outside the session's -1\.4000 to 1\.4000 rad",
        ),
        (
            MOTION + PEAKS.replace("velocity = 1.0", "velocity = 4.1"),
            "",
            r"go up to 4\.1 rad/s, more than the session's velocity of 4 rad/s$",
        ),
        (
            MOTION + PEAKS.replace("torque = 90.0", "torque = 170.0"),
            "",
            r"go up to 170 N·m, more than the session's torque of 160 N·m$",
        ),
    ],
)
def test_a_motion_that_the_session_cannot_take_is_refused_in_one_sentence(
    tmp_path: Path, motion: str, more: str, wording: str
) -> None:
    path = with_motion(tmp_path, motion, more)
    with pytest.raises(jid.InputError, match=rf"joint\.toml: \[session\.trajectory\]: .*{wording}"):
        Bench.load(path)


def test_a_motions_file_is_a_name(tmp_path: Path) -> None:
    path = written(tmp_path, OWN, "file = 3\n")
    with pytest.raises(jid.InputError, match="file is 3: the name of a motion file is expected"):
        Bench.load(path)


def test_a_motions_torque_at_the_limit_is_allowed() -> None:
    peaks = Peaks(position=(-1.4, 1.4), velocity=4.0, acceleration=9.0, torque=160.0 + 1e-9)
    limits = replace(Bench.load(EXAMPLE).limits, torque=160.0)
    assert limits.passed_by(peaks) == ""
    assert limits.passed_by(replace(peaks, torque=160.1)) != ""
