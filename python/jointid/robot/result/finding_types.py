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
            meaning="all torques differ from the weight of the URDF's links by about the same factor, above 1.6. "
            "They are probably currents or motor-side torques. A factor below 2.5 is reported only if no "
            "change of a single link explains the torques nearly as well",
            advice="state the unit, the gear ratios, `torque_scales`, or a drive's `kp` and `kd`",
        ),
        FindingType(
            code="different_factors",
            severity="blocking",
            meaning="the torques of several joints differ from the weight of the URDF's links, by a different factor "
            "for each joint. Probably one gear ratio, torque constant or gain was used for all joints. Reported only "
            "if no change of a single link explains the torques nearly as well",
            advice="state `gear_ratios`, `torque_scales`, or a drive's `kp` and `kd`",
        ),
        FindingType(
            code="joint_order",
            severity="blocking",
            meaning="three or more joints are in a different order in the log than in the robot. This concerns "
            "all columns, only the torques, or a drive's wanted positions",
            advice=_COLUMNS,
        ),
        FindingType(
            code="reversed_torques",
            severity="blocking",
            meaning="all torques have the opposite sign to the weight of the URDF's links",
            advice="state `torque_scales`",
        ),
        FindingType(
            code="reversed_positions",
            severity="blocking",
            meaning="all positions, with or without the torques, have the opposite sign to the URDF's axes. An "
            "arm that is its own mirror image does not show this error",
            advice="state `directions`",
        ),
        FindingType(
            code="unsigned_torque",
            severity="blocking",
            meaning="a torque is never negative although the joint moves both ways. The torque fits the URDF only "
            "as a magnitude",
            advice="log the driver's signed value",
        ),
        FindingType(
            code="implausible_unit",
            meaning="a position or velocity is probably in degrees: the velocity and the position's derivative "
            "differ by a factor of 57. Blocking if most joints move over twice the URDF's range, or if the measured "
            "torques fit the links only in degrees",
            advice="state the unit of the signal",
        ),
        FindingType(
            code="cross_check",
            severity="blocking",
            meaning="an independent second fit gives other values, or explains much more of the torque",
            advice="check the time stamps and the logger, or leave slow motion out",
        ),
        FindingType(
            code="swapped_joints",
            severity="blocking",
            meaning="the columns of two joints are probably exchanged. Checked if a joint's residual is "
            "above 5 %, or if its friction would be negative",
            advice=_COLUMNS,
        ),
        FindingType(
            code="swapped_torques",
            severity="blocking",
            meaning="the torque columns of two joints are probably exchanged. Checked like `swapped_joints`",
            advice=_COLUMNS,
        ),
        FindingType(
            code="wrong_sign",
            severity="blocking",
            meaning="all signals of a joint have the wrong sign. Checked like `swapped_joints`. If the arm moves "
            "in one plane, its mirror image fits as well; both possible joints are then named",
            advice="state `directions`",
        ),
        FindingType(
            code="wrong_torque_sign",
            severity="blocking",
            meaning="the torque of a joint has the wrong sign. Checked like `swapped_joints`",
            advice="state `torque_scales`",
        ),
        FindingType(
            code="wrong_motion_sign",
            severity="blocking",
            meaning="the position of a joint has the wrong sign; its torque has the right sign. Checked like "
            "`swapped_joints`",
            advice="state `directions` and `torque_scales`",
        ),
        FindingType(
            code="wrong_coupling",
            meaning="a motor coupling is missing or has a wrong factor. Checked like `swapped_joints`, with free "
            "inertias. Factors 0 and ±1 of neighbouring joints are tried, and exchanged rows and columns. A factor "
            "that makes friction negative is named only if the fit is much better with this factor",
            advice="state `couplings`",
        ),
        FindingType(
            code="tilted_base",
            meaning="the direction of gravity differs from the facts. The finding states the tilt and its error",
            advice="state `gravity`",
        ),
        FindingType(
            code="wrong_zero",
            meaning="the zero of a joint is off by some degrees",
            advice="state `zero_offsets`",
        ),
        FindingType(
            code="wrong_torque_scale",
            meaning="the torque of one joint is too high or too low, compared with the weight of the links and "
            'the other joints. A wrong torque constant causes this. With `inertia="free"`, only joints '
            "that carry each other show this error, so the first joint is not checked. A small factor on all "
            "torques looks like heavier links",
            advice="state `torque_scales`",
        ),
        FindingType(
            code="payload",
            meaning='the last link carries a body that is not in the URDF. Not checked with `inertia="free"`',
            advice='add it to the URDF, or identify with `inertia="free"`',
        ),
        FindingType(
            code="wrong_centre",
            meaning="the centre of mass of a link is not where the URDF has it. Not checked with "
            '`inertia="free"`. A shift along the next joint\'s axis may belong to either of two links: both '
            "are named",
            advice='correct the URDF, or identify with `inertia="free"`',
        ),
        FindingType(
            code="wrong_inertia",
            meaning='a link is heavier or lighter than in the URDF. Not checked with `inertia="free"`',
            advice='correct the URDF, or identify with `inertia="scaled"`',
        ),
        FindingType(
            code="more_wrong_facts",
            meaning="joints still fit badly after the named facts are corrected: another fact is wrong, too",
            advice="correct the named facts, then identify again",
        ),
        FindingType(
            code="several_wrong_facts",
            severity="info",
            meaning="several facts are wrong. Up to three wrong facts are found, one after the other; the printed "
            "call corrects all of them",
            advice="state all corrected facts",
        ),
        FindingType(
            code="consequences",
            severity="info",
            meaning="warnings that disappear when the named facts are corrected; these warnings are not listed",
            advice="nothing",
        ),
        FindingType(
            code="turned_zero",
            meaning="the log and the URDF count joints from different zeros, a multiple of 90 degrees apart. The "
            "URDF's inertias fit at least twice as well with these offsets, so they are applied. Gravity "
            "does not show the zero of a joint with a vertical axis",
            advice="state `zero_offsets`",
        ),
        FindingType(
            code="signal_lag",
            meaning="the torque is late or early relative to the position, and was not shifted. With a position "
            "drive, this is the torque that the wanted positions cause",
            advice="state `shift`, or check filters and clocks",
        ),
        FindingType(
            code="delay_removed",
            severity="info",
            meaning="the torque was late or early relative to the position, and was shifted before the "
            "identification. With a position drive, the delay is from a row to the effect of its wanted position",
            advice="nothing, or state `shift`",
        ),
        FindingType(
            code="recorded_velocity",
            severity="info",
            meaning="the recorded velocity of a joint is used, not the velocity derived from its positions. The "
            "recorded velocity predicts held-out torque better, by three standard errors and a tenth of the squared "
            "residual. Warning if noise hides all motion in the derived velocity, so that the two cannot "
            "be compared",
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
            meaning="the residual of a joint is not noise: neighbouring windows are alike, and no known cause "
            "explains most of it. The finding lists the causes that are not examined for a robot. The "
            'verdict becomes "usable with care". Info if the named facts explain it',
            advice="identify the joint alone, which examines these causes",
        ),
        FindingType(
            code="asymmetric_friction",
            meaning="viscous friction differs between the directions. Checked only if nothing else is wrong",
            advice='identify with `model="auto:asymmetric"`',
        ),
        FindingType(
            code="poor_fit",
            meaning="the model leaves more than 15 % of a joint's torque unexplained",
            advice='identify with `inertia="free"`; check units, signs and gear ratio of the joint',
        ),
        FindingType(
            code="undetermined",
            meaning="the standard error of a friction parameter exceeds a quarter of its value",
            advice="record more and faster motion of the joint",
        ),
        FindingType(
            code="at_bound",
            meaning="friction would be negative and is held at 0. Info if the friction held at 0 is at most a tenth of "
            "the joint's friction",
            advice="check the model and the stated facts",
        ),
        FindingType(
            code="standing",
            meaning="joints stand still, stick or are too slow; these parts of the log are left out. Info up to 35 % "
            "of the time",
            advice="record more motion",
        ),
        FindingType(
            code="locked_joint_moves",
            meaning="a joint that `joints` leaves out moves in the recording",
            advice="add it to `joints`",
        ),
        FindingType(
            code="impossible_inertia",
            meaning='no physical body can have these inertial parameters. Info with `inertia="free"`; the finding '
            "states the distance in standard errors",
            advice='identify with `inertia="free"`',
        ),
        FindingType(
            code="scaled_inertia",
            severity="info",
            meaning="a link's factor (`inertia_scale`) differs from 1",
            advice="nothing, or correct the URDF",
        ),
        FindingType(
            code="merged_inertia",
            severity="info",
            meaning="the motion does not separate a rotor's inertia or a link's factor from other inertias",
            advice="nothing, or state `rotor_inertias`",
        ),
        FindingType(
            code="joints_in_order",
            severity="info",
            meaning="the recording does not name the URDF's joints, so columns are assigned to joints in order",
            advice="check the order",
        ),
        FindingType(
            code="joints_left_out",
            severity="info",
            meaning="joints of the log, such as a gripper's, are not read, because their clock differs from that of "
            "the joints with torques",
            advice="nothing, or name the joints with `joints`",
        ),
        FindingType(
            code="no_gravity",
            severity="info",
            meaning="no gravity acts on the robot, as the facts say",
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
