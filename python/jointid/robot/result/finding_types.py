"""The table of a robot's findings: each code with its severity, its meaning, and what to do in general."""

from __future__ import annotations

from collections.abc import Sequence

from jointid.estimate.types_of_findings import FindingType

_LONGEST = 90  # longest title, in characters
_COLUMNS = "check the order and the names of the columns"

# Order of docs/robot_reference.md: findings that spoil everything come first.
TYPES = {
    each.code: each
    for each in (
        FindingType(
            code="scaled_torques",
            severity="blocking",
            meaning="all torques differ from the gravity torques of the URDF's links by about the same factor. This "
            "factor is above 1.6. The torques are probably currents or motor-side torques. A factor below 2.5 is "
            "reported only if no change of a single link explains the torques nearly as well",
            advice="state the unit, the gear ratios, `torque_scales`, or a drive's `kp` and `kd`",
        ),
        FindingType(
            code="different_factors",
            severity="blocking",
            meaning="the torques of several joints differ from the gravity torques of the URDF's links, by a "
            "different factor for each joint. Probably one gear ratio, torque constant or gain was used for all "
            "joints. The finding appears only if no change of a single link explains the torques nearly as well",
            advice="state `gear_ratios`, `torque_scales`, or a drive's `kp` and `kd`",
        ),
        FindingType(
            code="joint_order",
            severity="blocking",
            meaning="three or more joints are in a different order in the log than in the robot. The order is wrong "
            "in all columns, only in the torques, or only in a drive's wanted positions",
            advice=_COLUMNS,
        ),
        FindingType(
            code="reversed_torques",
            severity="blocking",
            meaning="all torques have the opposite sign to the gravity torques of the URDF's links",
            advice="state `torque_scales`",
        ),
        FindingType(
            code="reversed_positions",
            severity="blocking",
            meaning="all positions have the opposite sign to the URDF's axes; the sign of the torques may also be "
            "wrong. The log of a mirror-symmetric arm does not show this error",
            advice="state `directions`",
        ),
        FindingType(
            code="unsigned_torque",
            severity="blocking",
            meaning="the torque of a joint is never negative although the joint moves both ways. Only the magnitude "
            "of this torque fits the URDF",
            advice="log the signed torque of the driver",
        ),
        FindingType(
            code="implausible_unit",
            meaning="a position or velocity is probably in degrees: the velocity and the position's derivative differ "
            "by a factor of 57. Blocking if most joints move more than twice the URDF's range, or if the torques fit "
            "the links only with positions in degrees",
            advice="state the unit of the signal",
        ),
        FindingType(
            code="cross_check",
            severity="blocking",
            meaning="an independent second fit gives other values than the main fit, or has a much smaller residual",
            advice="check the time stamps and the logger, or leave slow motion out",
        ),
        FindingType(
            code="swapped_joints",
            severity="blocking",
            meaning="the columns of two joints are probably exchanged. Checked if the residual of a joint is above 5 "
            "% of its torque, or if its friction would be negative",
            advice=_COLUMNS,
        ),
        FindingType(
            code="swapped_torques",
            severity="blocking",
            meaning="the torque columns of two joints are probably exchanged. Checked under the conditions of "
            "`swapped_joints`",
            advice=_COLUMNS,
        ),
        FindingType(
            code="wrong_sign",
            severity="blocking",
            meaning="all signals of a joint have the wrong sign. Checked under the conditions of `swapped_joints`. If "
            "the arm moves in one plane, its mirror image fits as well. The finding then names both joints that may "
            "be wrong",
            advice="state `directions`",
        ),
        FindingType(
            code="wrong_torque_sign",
            severity="blocking",
            meaning="the torque of a joint has the wrong sign. Checked under the conditions of `swapped_joints`",
            advice="state `torque_scales`",
        ),
        FindingType(
            code="wrong_motion_sign",
            severity="blocking",
            meaning="the position of a joint has the wrong sign; its torque has the right sign. Checked under the "
            "conditions of `swapped_joints`",
            advice="state `directions` and `torque_scales`",
        ),
        FindingType(
            code="wrong_coupling",
            meaning="a motor coupling is missing or has a wrong factor. Checked under the conditions of "
            "`swapped_joints`, with free inertias. The program tries factors 0 and ±1 of neighbouring joints, and "
            "exchanged rows and columns. A factor that makes friction negative is reported only if the fit becomes "
            "much better with it",
            advice="state `couplings`",
        ),
        FindingType(
            code="tilted_base",
            meaning="the direction of gravity differs from the stated direction. The finding states the tilt and its "
            "error",
            advice="state `gravity`",
        ),
        FindingType(
            code="wrong_zero",
            meaning="the zero positions of a joint in log and URDF differ by some degrees",
            advice="state `zero_offsets`",
        ),
        FindingType(
            code="wrong_torque_scale",
            meaning="the torque of one joint is too high or too low, compared with the weight of the links and the "
            'other joints. The usual cause is a wrong torque constant. With `inertia="free"`, the first joint does '
            "not show this error, because its inertia affects no other joint. If all torques are too high by the same "
            "small factor, the links seem heavier",
            advice="state `torque_scales`",
        ),
        FindingType(
            code="payload",
            meaning='the last link carries a body that is not in the URDF. Not checked with `inertia="free"`',
            advice='add the body to the URDF, or identify with `inertia="free"`',
        ),
        FindingType(
            code="wrong_centre",
            meaning="the centre of mass of a link differs from its position in the URDF. Not checked with "
            '`inertia="free"`. A shift along the next joint\'s axis may belong to either of two links. The finding '
            "then names both links",
            advice='correct the URDF, or identify with `inertia="free"`',
        ),
        FindingType(
            code="wrong_inertia",
            meaning='a link is heavier or lighter than in the URDF. Not checked with `inertia="free"`',
            advice='correct the URDF, or identify with `inertia="scaled"`',
        ),
        FindingType(
            code="more_wrong_facts",
            meaning="some joints still fit poorly after all reported facts are corrected: another fact is wrong, too",
            advice="correct the reported facts, then identify again",
        ),
        FindingType(
            code="several_wrong_facts",
            severity="info",
            meaning="several facts are wrong. The program finds up to three wrong facts, one after the other. The "
            "printed call corrects all of them",
            advice="state all corrected facts",
        ),
        FindingType(
            code="consequences",
            severity="info",
            meaning="some warnings are not listed, because they disappear when the reported facts are corrected",
            advice="nothing",
        ),
        FindingType(
            code="turned_zero",
            meaning="the zero positions of a joint in log and URDF differ by a multiple of 90 degrees. With this "
            "offset, the residual of the fit with the URDF's inertias is at most half as large, so the program "
            "applies the offset. Gravity does not show the zero of a joint with a vertical axis",
            advice="state `zero_offsets`",
        ),
        FindingType(
            code="signal_lag",
            meaning="the torque is late or early relative to the position, and was not shifted. With a position "
            "drive, this torque is computed from the wanted positions",
            advice="state `shift`, or check filters and clocks",
        ),
        FindingType(
            code="delay_removed",
            severity="info",
            meaning="the torque was late or early relative to the position, and was shifted before the "
            "identification. With a position drive, the delay is the time from a row to the effect of its wanted "
            "position",
            advice="nothing, or state `shift`",
        ),
        FindingType(
            code="recorded_velocity",
            severity="info",
            meaning="the fit uses the recorded velocity of a joint, not the velocity derived from its positions. With "
            "the recorded velocity, the squared residual of held-out torque is smaller by more than 10 % and three "
            "standard errors. Warning if noise hides all motion in the derived velocity, because the two velocities "
            "are then not compared",
            advice="nothing, or check the time stamps and the positions' resolution",
        ),
        FindingType(
            code="gravity_found",
            severity="info",
            meaning='the direction of gravity in the base\'s frame was identified, because of `gravity = "free"`',
            advice="nothing, or state `gravity`",
        ),
        FindingType(
            code="torque_filtered",
            severity="info",
            meaning="a first-order low-pass filter on the torque explains held-out motion better than a delay "
            "does. The filter was undone before the identification",
            advice="nothing, or state `shift` with `torque_filter`",
        ),
        FindingType(
            code="unexamined_causes",
            meaning="the residual of a joint is not noise: neighbouring windows have similar residuals, and no known "
            "cause explains most of the residual. The finding lists the causes that are not examined for a robot. The "
            'verdict becomes "usable with care". Info if reported wrong facts explain the residual',
            advice="identify the joint alone, to examine these causes",
        ),
        FindingType(
            code="asymmetric_friction",
            meaning="viscous friction differs between the two directions of motion. Checked only if no other error is "
            "found",
            advice='identify with `model="auto:asymmetric"`',
        ),
        FindingType(
            code="poor_fit",
            meaning="the residual of a joint is larger than 15 % of its torque",
            advice='identify with `inertia="free"`; check units, signs and gear ratio of the joint',
        ),
        FindingType(
            code="undetermined",
            meaning="the standard error of a friction parameter exceeds a quarter of its value",
            advice="record more and faster motion of the joint",
        ),
        FindingType(
            code="at_bound",
            meaning="a friction parameter would be negative, so the fit holds it at 0. Info if the true parameter "
            "causes at most a tenth of the joint's friction torque",
            advice="check the model and the stated facts",
        ),
        FindingType(
            code="standing",
            meaning="joints stand still, stick or move too slowly for the fit; these parts of the log are left out. "
            "Info if these parts are at most 35 % of the time",
            advice="record more motion",
        ),
        FindingType(
            code="locked_joint_moves",
            meaning="a joint moves in the recording, but `joints` does not list it",
            advice="add the joint to `joints`",
        ),
        FindingType(
            code="impossible_inertia",
            meaning='no physical body can have the identified inertial parameters. Info with `inertia="free"`. The '
            "finding then states the distance of the identified parameters from physically possible ones, in standard "
            "errors",
            advice='identify with `inertia="free"`',
        ),
        FindingType(
            code="scaled_inertia",
            severity="info",
            meaning="the factor on a link's inertia (`inertia_scale`) differs from 1",
            advice="nothing, or correct the URDF",
        ),
        FindingType(
            code="merged_inertia",
            severity="info",
            meaning="the motion does not separate a rotor's inertia, or the factor on a link's inertia, from other "
            "inertias",
            advice="nothing, or state `rotor_inertias`",
        ),
        FindingType(
            code="joints_in_order",
            severity="info",
            meaning="the recording does not name the URDF's joints, so its columns are assigned to these joints in "
            "order",
            advice="check the order",
        ),
        FindingType(
            code="joints_left_out",
            severity="info",
            meaning="some joints of the log, such as a gripper, are not read. Their clock differs from the clock of "
            "the joints with torques",
            advice="nothing, or name the joints with `joints`",
        ),
        FindingType(
            code="no_gravity",
            severity="info",
            meaning="the facts state that no gravity acts on the robot",
            advice="nothing, or state `gravity`",
        ),
    )
}


def listed(names: Sequence[str], most: int = 3) -> str:
    """Return names for a title: the first ones, and the number of the others."""
    if len(names) <= most:
        return " and ".join(filter(None, (", ".join(names[:-1]), names[-1]))) if names else ""
    return f"{', '.join(names[:most])} and {len(names) - most} more"


def titled(what: str, numbers: str) -> str:
    """Return a title with numbers; without them if both are too long. The details contain the numbers."""
    whole = f"{what} ({numbers})"
    return whole if len(whole) <= _LONGEST else what
