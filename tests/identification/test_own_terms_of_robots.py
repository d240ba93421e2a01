"""Own terms on the logs of real robots, against what their authors publish."""

from pathlib import Path
from typing import Any

import pytest

import jointid as jid
from jointid.cli.demonstration import PUBLISHED, data_folder


def kr300(path: Path, number: int) -> jid.Recording:
    motor, columns = "motor_encoder_{}_" + f"{number}_linkside_rad", f"_{number}_"
    return jid.load(
        path,
        columns={
            "position": motor.format("pos"),
            "velocity": motor.format("vel") + "_s",
            "motor_torque": f"motor_torque{columns}Nm",
            "link_position": None,
        },
        extra={
            "gravity": f"model_gravity_torque{columns}Nm",
            "coriolis": f"model_coriolis_torque{columns}Nm",
            "arm": f"model_inertia{columns}kgm2",
        },
    )


KNOWN = {"gravity": "known", "coriolis": "known", "arm": "inertia"}


def test_kr300_joint_1_with_its_model_as_known_signals(shared_data: Path) -> None:
    recording = kr300(shared_data / "kr300/kr300_A.csv.gz", 1)
    joint = jid.Joint.load(data_folder() / "kr300_joint1.toml")
    found = jid.identify(recording, joint, terms=KNOWN)
    for name, nominal in PUBLISHED.items():
        parameter = found.parameters[name]
        assert parameter.interval is not None
        assert parameter.stderr is not None
        assert parameter.interval[0] < nominal < parameter.interval[1], name
        assert parameter.stderr < 0.1 * parameter.value, name
    assert "structured_residual" not in {finding.code for finding in found.findings}


def test_kr300_joint_3_is_not_surer_than_it_is(shared_data: Path) -> None:
    """Its one slow motion tells little: the intervals are wide, and hold the authors' values."""
    recording = kr300(shared_data / "kr300/kr300_A.csv.gz", 3)
    joint = jid.Joint(gear_ratio=252.33, torque_hold="linear")
    found = jid.identify(recording, joint, model="coulomb_viscous", terms=KNOWN)
    for name, nominal in {"viscous": 2024.0, "coulomb": 294.0}.items():
        interval = found.parameters[name].interval
        assert interval is not None
        assert interval[0] < nominal < interval[1], name
    assert "undetermined" in {finding.code for finding in found.findings}


def test_tx40_joint_5_with_the_motor_of_joint_6(shared_data: Path) -> None:
    """The wrist is coupled: motor 6 turns with both joints, and its torque acts on both."""
    recording = jid.load(
        shared_data / "tx40/tx40.csv.gz",
        columns={"position": "motor_position_5_rad", "motor_torque": "motor_torque_5_Nm"},
        extra={"motor_6": "motor_position_6_rad", "torque_6": "motor_torque_6_Nm"},
        scale={"position": 1 / 45, "motor_6": 1 / 32, "torque_6": -32.0},
    )
    # The published viscous friction counts against the rate of joint 6, the dry one against motor 6's.
    recording = recording.with_signals(
        extra={"q6": recording.extra["motor_6"] - recording.position}
    )
    terms = {"q6": "viscous@rate", "motor_6": "coulomb@rate", "torque_6": "known"}
    options: dict[str, Any] = {"windows": 0.1, "min_speed": 0.056}
    found = jid.identify(
        recording, jid.Joint(gear_ratio=45.0), model="coulomb_viscous", terms=terms, **options
    )
    published = {
        "viscous": 1.86,
        "coulomb": 3.03,
        "viscous_of_q6_rate": 0.616,
        "coulomb_of_motor_6_rate": 1.95,
    }
    for name, value in published.items():
        assert found.parameters[name].value == pytest.approx(value, rel=0.1), name


def test_the_demonstration_warns_of_what_its_log_lacks_and_of_nothing_else() -> None:
    found = jid.identify(jid.demo().recording, jid.demo().joint)
    warnings = [each.code for each in found.findings if each.severity != "info"]
    assert warnings == ["undetermined"]
    for name, nominal in PUBLISHED.items():
        parameter = found.parameters[name]
        assert parameter.interval is not None
        assert parameter.stderr is not None
        assert parameter.interval[0] < nominal < parameter.interval[1]
        assert parameter.stderr < 0.06 * parameter.value
