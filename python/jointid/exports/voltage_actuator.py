"""MuJoCo: the motor of a servo, controlled by the duty."""

from __future__ import annotations

from jointid.base.errors import InputError
from jointid.exports.xml_patch import attribute
from jointid.joint.joint import Joint
from jointid.joint.voltage_drive import VoltageDrive

GROUP = 1
"""Actuator group of the motor. With the group disabled, the motor turns freely."""

VOLTAGE_NOTES = (
    "the control is the duty of the servo, from -1 to 1; the position loop is not included. While the motor is not "
    f"driven, disable actuator group {GROUP}; otherwise back-EMF still brakes the joint",
)


def voltage_motor(joint: Joint, drive: VoltageDrive, name: str) -> str:
    """Return the element of a motor with voltage input: force = (k_t / R) supply duty - (k_t² / R) velocity."""
    for argument, value in (
        ("torque_constant", joint.torque_constant),
        ("resistance", drive.resistance),
        ("supply", drive.supply),
    ):
        if value is None:
            raise InputError(
                "a model of a voltage-driven motor needs this value",
                argument=argument,
                place=joint.owner,
                remedy="give this value in the joint file's [drive]",
            )
    assert joint.torque_constant is not None
    assert drive.resistance is not None
    assert drive.supply is not None
    k_t = abs(joint.torque_constant * joint.gear_ratio)
    gain, brake = k_t / drive.resistance * drive.supply, k_t * k_t / drive.resistance
    limit = 1.0 if drive.position_loop is None else drive.position_loop.saturation
    return (
        f'<general name={attribute(f"{name}_motor")} joint={attribute(name)} group="{GROUP}" ctrllimited="true" '
        f'ctrlrange="{-limit!r} {limit!r}" gaintype="fixed" gainprm="{gain!r}" biastype="affine" '
        f'biasprm="0 0 {-brake!r}"/>'
    )
