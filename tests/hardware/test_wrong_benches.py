"""The keys of [session.emulated] by which a wrong bench is emulated."""

from pathlib import Path

import pytest

import jointid as jid
from jointid.base.errors import InputError
from jointid.hardware.session.drive import DriveSample

EXAMPLE = Path(__file__).resolve().parents[2] / "examples" / "hardware" / "joint.toml"
TEXT = EXAMPLE.read_text(encoding="utf-8")
TORQUE = 60.0  # [N·m], above the joint's breakaway of 45 N·m


def moved_by(folder: Path, keys: str, torque: float = TORQUE) -> tuple[DriveSample, DriveSample]:
    """The first sample, and that of the joint after 30 ms of a torque."""
    path = folder / "joint.toml"
    path.write_text(TEXT.replace("[session.emulated]", f"[session.emulated]\n{keys}", 1))
    bench = jid.hardware.Bench.load(path)
    with jid.hardware.open_drive(bench, emulate=True) as drive:
        drive.connect(0.002)
        drive.enable()
        first = last = drive.read(0.0015)
        for k in range(15):
            drive.command(torque)
            drive.clock.sleep_until(first.time + (k + 1) * 0.002)
            last = drive.read(0.0015)
        drive.disable()
        drive.close()
    return first, last


def way(samples: tuple[DriveSample, DriveSample]) -> float:
    return samples[1].position - samples[0].position


def test_inverted_torque_and_inverted_encoder_look_the_same(tmp_path: Path) -> None:
    right = way(moved_by(tmp_path, ""))
    assert right > 1e-3
    assert way(moved_by(tmp_path, "torque_sign = -1")) == pytest.approx(-right, rel=0.05)
    assert way(moved_by(tmp_path, "encoder_sign = -1.0")) == pytest.approx(-right, rel=0.01)
    both = moved_by(tmp_path, "torque_sign = -1\nencoder_sign = -1")
    assert way(both) == pytest.approx(right, rel=0.05)


def test_torque_scale_is_that_of_the_true_torque_constant(tmp_path: Path) -> None:
    assert way(moved_by(tmp_path, "torque_scale = 3", TORQUE / 3.0)) == pytest.approx(
        way(moved_by(tmp_path, "")), rel=1e-3
    )
    assert way(moved_by(tmp_path, "torque_scale = 0")) == 0.0
    # The drive limits the current: the joint file's torque limit does not hold for the true torque.
    stronger = way(moved_by(tmp_path, "torque_scale = 3", 150.0))
    assert stronger > 3.0 * way(moved_by(tmp_path, "", 150.0)) > 0.0


def test_a_wrong_gear_ratio_is_in_torque_inertia_and_counts(tmp_path: Path) -> None:
    # Rotor behind ten times the ratio: ten times the torque, a hundred times its inertia, ten times the counts.
    assert way(moved_by(tmp_path, "gear_ratio = 1010.0", 4.4)) == 0.0
    assert way(moved_by(tmp_path, "gear_ratio = 1010.0", 6.0)) > 0.0


def test_an_inverted_sensor_reads_the_negative(tmp_path: Path) -> None:
    right, wrong = (moved_by(tmp_path, keys)[0] for keys in ("", "sensor_sign = -1"))
    assert wrong.reading == pytest.approx(-right.reading, abs=1e-3)
    assert right.reading < -1.0


@pytest.mark.parametrize(
    "keys", ["torque_sign = 2", "encoder_sign = 0", "torque_scale = -1.0", "gear_ratio = 0"]
)
def test_a_value_that_no_bench_can_have_is_refused(tmp_path: Path, keys: str) -> None:
    path = tmp_path / "joint.toml"
    path.write_text(TEXT.replace("[session.emulated]", f"[session.emulated]\n{keys}", 1))
    with pytest.raises(InputError, match=keys.split()[0]):
        jid.hardware.Bench.load(path)
