"""A torque that is late against the position is found, said, and taken away."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from simulated_arm import JOINTS, URDF, Run, Sensors, random_arm, random_motion, recorded, run

import jointid as jid
from jointid.estimate.findings import Finding

pytest.importorskip("pinocchio")

SEED = 2
NAMES = [f"joint_{number}" for number in range(1, JOINTS + 1)]


@pytest.fixture(name="ran", scope="module")
def _ran() -> Run:
    return run(random_arm(SEED, stribeck=False), random_motion(SEED, duration=12.0))


def late(ran: Run, delays: list[float]) -> jid.RobotRecording:
    """The recording with each joint's torque as it was so much before [s]."""
    whole = recorded(ran, Sensors(velocity_delay=None), SEED)
    fields = whole.fields()
    columns = [
        np.interp(whole.time - delay, whole.time, column)
        for delay, column in zip(delays, fields["torque"].T, strict=True)
    ]
    return jid.RobotRecording(**{**fields, "torque": np.column_stack(columns)})


def identified(recording: jid.RobotRecording, **options: Any) -> jid.RobotEstimate:
    return jid.identify_robot(
        recording, jid.Robot.from_urdf(URDF), model="coulomb_viscous", **options
    )


def worst(found: jid.RobotEstimate, ran: Run) -> float:
    far: float = max(
        abs(found.joints[name].parameters[key].value / truth - 1.0)
        for key in ("coulomb", "viscous")
        for name, truth in zip(NAMES, ran.arm.values(key), strict=True)
    )
    return far


def findings_of(found: jid.RobotEstimate, code: str) -> list[Finding]:
    return [each for each in found.findings if each.code == code]


@pytest.mark.parametrize("delay", [3e-3, pytest.param(10e-3, marks=pytest.mark.slow)])
def test_a_late_torque_is_found_and_taken_away(ran: Run, delay: float) -> None:
    found = identified(late(ran, [delay] * JOINTS))
    (said,) = findings_of(found, "delay_removed")
    assert said.severity == "info"
    assert said.evidence["lag"].value == pytest.approx(delay, abs=3e-4)
    assert found.settings["shift"]["torque"] == pytest.approx(delay, abs=3e-4)
    assert worst(found, ran) < 0.02
    assert found.warnings == ()


def test_one_late_joint_is_told_from_the_others(ran: Run) -> None:
    found = identified(late(ran, [0.0, 0.0, 0.005, 0.0, 0.0, 0.0, 0.0]))
    (shift,) = found.settings["shift"].values()
    assert list(shift) == ["joint_3"]
    assert shift["joint_3"] == pytest.approx(0.005, abs=1e-3)
    assert "joint_3" in str(findings_of(found, "delay_removed")[0])


def test_a_clean_log_has_no_delay(ran: Run) -> None:
    found = identified(late(ran, [0.0] * JOINTS))
    assert found.settings["shift"] == {}
    assert not findings_of(found, "delay_removed")


def test_a_given_delay_is_taken_away_and_no_other(ran: Run) -> None:
    recording = late(ran, [0.006] * JOINTS)
    given = identified(recording, shift={"torque": 0.006})
    assert given.settings["shift"] == {"torque": 0.006}
    assert given.warnings == ()
    assert worst(given, ran) < 0.02
    kept = identified(recording, shift={})
    (said,) = findings_of(kept, "signal_lag")
    (advice, *_) = said.advice
    assert advice.arguments["shift"]["torque"] == pytest.approx(0.006, abs=1e-3)
    assert worst(kept, ran) > worst(given, ran)
    named = identified(recording, shift={"torque": dict.fromkeys(NAMES, 0.006)})
    assert named.settings == given.settings
    assert named.relative_residual == given.relative_residual


def test_a_prediction_takes_the_same_delay_away(ran: Run) -> None:
    recording = late(ran, [0.01] * JOINTS)
    found = identified(recording)
    assert found.predict(recording).relative_residual < 1.1 * found.relative_residual


@pytest.mark.parametrize(
    ("shift", "argument"),
    [
        ({"velocity": 0.001}, "shift"),
        ({"torque": {"nobody": 0.001}}, "shift"),
        ({"torque": [0.001]}, "shift.torque"),
        ({"torque": 2.0}, "shift.torque"),
        (0.001, "shift"),
    ],
)
def test_another_shift_is_refused(ran: Run, shift: Any, argument: str) -> None:
    with pytest.raises(jid.InputError) as refused:
        identified(late(ran, [0.0] * JOINTS), shift=shift)
    assert refused.value.argument == argument


@pytest.mark.parametrize(
    ("seed", "noise", "duration"),
    [
        (102, 3e-4, 4.0),
        pytest.param(102, 3e-4, 20.0, marks=pytest.mark.slow),
        pytest.param(101, 1e-5, 20.0, marks=pytest.mark.slow),
    ],
)
def test_noise_of_the_positions_is_no_early_torque(
    seed: int, noise: float, duration: float
) -> None:
    arm = run(random_arm(seed), random_motion(seed, duration=duration))
    noisy = recorded(arm, Sensors(position_noise=noise, velocity_delay=None), seed)
    found = jid.identify_robot(noisy, jid.Robot.from_urdf(URDF))
    assert not findings_of(found, "signal_lag")
    assert not findings_of(found, "delay_removed")
