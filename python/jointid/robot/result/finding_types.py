"""The table of a robot's findings: each code with its severity, its meaning, and what to do in general."""

from __future__ import annotations

from collections.abc import Sequence

from jointid.estimate.types_of_findings import FindingType

_LONGEST = 90  # characters of a title
_COLUMNS = "check the order and the names of the columns"

# In the order of docs/robot_reference.md: what spoils everything first.
TYPES = {
    each.code: each
    for each in (
        FindingType(
            code="scaled_torques",
            severity="blocking",
            meaning="all torques differ from the weight of the URDF's links by nearly the same factor, above 1.6: "
            "they are currents, or of the motor's side of a gear. Below a factor of 2.5, named only if no "
            "change of a single link explains it nearly as well",
            advice="state the unit, the gear ratios, `torque_scales`, or a drive's `kp` and `kd`",
        ),
        FindingType(
            code="different_factors",
            severity="blocking",
            meaning="the torques of several joints differ from the weight of the URDF's links, each by another factor: "
            "one gear ratio, torque constant or gain was taken for all joints. Named only if no change of a single "
            "link explains it nearly as well",
            advice="state `gear_ratios`, `torque_scales`, or a drive's `kp` and `kd`",
        ),
        FindingType(
            code="joint_order",
            severity="blocking",
            meaning="the columns of three or more joints, of their torques, or of a drive's wanted positions, are in "
            "another order than the robot's",
            advice=_COLUMNS,
        ),
        FindingType(
            code="reversed_torques",
            severity="blocking",
            meaning="all torques have the opposite sign of what the URDF's links weigh",
            advice="state `torque_scales`",
        ),
        FindingType(
            code="reversed_positions",
            severity="blocking",
            meaning="all positions have the opposite sign of the URDF's axes, with or without the torques. The motion "
            "of an arm that is its own mirror image does not show it",
            advice="state `directions`",
        ),
        FindingType(
            code="unsigned_torque",
            severity="blocking",
            meaning="a torque is never negative although the joint moves both ways; its magnitude fits the URDF, its "
            "value does not",
            advice="log the driver's signed value",
        ),
        FindingType(
            code="implausible_unit",
            meaning="a position or velocity is probably in degrees: the two differ by 57 times; blocking where most "
            "joints move over twice the URDF's range, or where the links weigh what was measured in degrees only",
            advice="state the unit of the signal",
        ),
        FindingType(
            code="cross_check",
            severity="blocking",
            meaning="the second look has other values, or explains far more of the torque",
            advice="check the time stamps and the logger, or leave slow motion out",
        ),
        FindingType(
            code="swapped_joints",
            severity="blocking",
            meaning="the columns of two joints are probably exchanged. It is looked for where a joint's balance "
            "leaves more than 5 %, or where friction would be negative",
            advice=_COLUMNS,
        ),
        FindingType(
            code="swapped_torques",
            severity="blocking",
            meaning="the torque columns of two joints are probably exchanged; looked for where `swapped_joints` is",
            advice=_COLUMNS,
        ),
        FindingType(
            code="wrong_sign",
            severity="blocking",
            meaning="all signals of a joint have the wrong sign; looked for where `swapped_joints` is. The mirror "
            "image of an arm that moves in one plane fits as well: both joints that may turn the other way "
            "are then named",
            advice="state `directions`",
        ),
        FindingType(
            code="wrong_torque_sign",
            severity="blocking",
            meaning="the torque of a joint has the wrong sign; looked for where `swapped_joints` is",
            advice="state `torque_scales`",
        ),
        FindingType(
            code="wrong_motion_sign",
            severity="blocking",
            meaning="the position of a joint has the wrong sign, its torque the right one; looked for where "
            "`swapped_joints` is",
            advice="state `directions` and `torque_scales`",
        ),
        FindingType(
            code="wrong_coupling",
            meaning="a coupling of motors is missing or has another factor; looked for where `swapped_joints` is. "
            "Neighbouring joints with factors 0 and ±1, and exchanged rows and columns, are tried with free "
            "inertias. A factor that makes friction negative counts only where the balance is much better "
            "with it",
            advice="state `couplings`",
        ),
        FindingType(
            code="tilted_base",
            meaning="gravity is not where the facts say; the tilt is given with its error",
            advice="state `gravity`",
        ),
        FindingType(
            code="wrong_zero",
            meaning="the zero of a joint is off by some degrees",
            advice="state `zero_offsets`",
        ),
        FindingType(
            code="wrong_torque_scale",
            meaning="the torque of one joint is too high or too low compared with the links' weight and the other "
            'joints, as a wrong torque constant makes it. With `inertia="free"` only joints that carry each other show '
            "it, so nothing is said of the first joint. All torques too high by a small factor look like heavier links",
            advice="state `torque_scales`",
        ),
        FindingType(
            code="payload",
            meaning='the last link carries a body that the URDF does not know; looked for unless `inertia="free"`',
            advice='put it in the URDF, or identify with `inertia="free"`',
        ),
        FindingType(
            code="wrong_centre",
            meaning="the centre of mass of a link is not where the URDF has it; looked for unless "
            "`inertia=\"free\"`. A centre along the next axis may be that link's or the next one's: both are named",
            advice='correct the URDF, or identify with `inertia="free"`',
        ),
        FindingType(
            code="wrong_inertia",
            meaning='a link is heavier or lighter than in the URDF; looked for unless `inertia="free"`',
            advice='correct the URDF, or identify with `inertia="scaled"`',
        ),
        FindingType(
            code="more_wrong_facts",
            meaning="joints fit badly even with the named facts corrected: more is wrong than was found",
            advice="correct what is named, then identify again",
        ),
        FindingType(
            code="several_wrong_facts",
            severity="info",
            meaning="several facts are wrong. Up to three are found, one after the other; the call corrects them all",
            advice="state all of them",
        ),
        FindingType(
            code="consequences",
            severity="info",
            meaning="warnings that are gone once the named facts are corrected; they are not listed one by one",
            advice="nothing",
        ),
        FindingType(
            code="turned_zero",
            meaning="the log counts joints from another zero than the URDF, by a multiple of 90 degrees. The URDF's "
            "inertias fit at least twice as well with it, and it is taken into account. Gravity does not "
            "show the zero of a joint with a vertical axis",
            advice="state `zero_offsets`",
        ),
        FindingType(
            code="signal_lag",
            meaning="the torque is late or early against the position, and was not shifted; of a robot with a drive, "
            "what its wanted positions make of it",
            advice="state `shift`, or check filters and clocks",
        ),
        FindingType(
            code="delay_removed",
            severity="info",
            meaning="the torque was late or early against the position, and shifted back before the identification; "
            "of a robot with a drive, how long after its row a wanted position acts",
            advice="nothing, or state `shift`",
        ),
        FindingType(
            code="recorded_velocity",
            severity="info",
            meaning="the recorded velocity of a joint is used, not that of its positions: with it the balance predicts "
            "held-out torque better, by three standard errors and a tenth of the squared residual. A warning where "
            "noise of the other one hides all motion, so that nothing is compared",
            advice="nothing, or check the time stamps and the positions' resolution",
        ),
        FindingType(
            code="gravity_found",
            severity="info",
            meaning='the direction of gravity in the base\'s frame, of a robot with `gravity = "free"`',
            advice="nothing, or state `gravity`",
        ),
        FindingType(
            code="torque_filtered",
            severity="info",
            meaning="a low-pass filter of first order on the torque explains held-out motion better than a delay, and "
            "was undone before the identification",
            advice="nothing, or state `shift` with `torque_filter`",
        ),
        FindingType(
            code="unexamined_causes",
            meaning="the rest of the torque is not noise: neighbouring windows are alike, and no known cause explains "
            "most of it. The finding lists causes that are not examined for a robot, and makes the verdict "
            '"usable with care". Info: the named facts explain it',
            advice="identify the joint by itself, which examines these causes",
        ),
        FindingType(
            code="asymmetric_friction",
            meaning="viscous friction differs between the directions; looked for where nothing else is wrong",
            advice='identify with `model="auto:asymmetric"`',
        ),
        FindingType(
            code="poor_fit",
            meaning="the balance of a joint leaves more than 15 % of its torque unexplained",
            advice='identify with `inertia="free"`; check units, signs and gear ratio of the joint',
        ),
        FindingType(
            code="undetermined",
            meaning="the standard error of a friction parameter exceeds a quarter of its value",
            advice="record more and faster motion of the joint",
        ),
        FindingType(
            code="at_bound",
            meaning="friction would be negative and is held at 0. Info: it is at most a tenth of the joint's "
            "friction",
            advice="check the model and the given facts",
        ),
        FindingType(
            code="standing",
            meaning="joints stand still, stick or are too slow; these parts are left out. A warning above 35 % of "
            "the time",
            advice="record more motion",
        ),
        FindingType(
            code="locked_joint_moves",
            meaning="a joint that `joints` leaves out moves in the recording",
            advice="add it to `joints`",
        ),
        FindingType(
            code="impossible_inertia",
            meaning="no bodies can have these inertial parameters; for information with "
            '`inertia="free"`, which says by how many standard errors',
            advice='identify with `inertia="free"`',
        ),
        FindingType(
            code="scaled_inertia",
            severity="info",
            meaning="a link's scale differs from 1",
            advice="nothing, or correct the URDF",
        ),
        FindingType(
            code="merged_inertia",
            severity="info",
            meaning="no motion separates a rotor's inertia or a link's scale from other inertias",
            advice="nothing, or state `rotor_inertias`",
        ),
        FindingType(
            code="joints_in_order",
            severity="info",
            meaning="the recording does not name the URDF's joints; they are taken in order",
            advice="check the order",
        ),
        FindingType(
            code="joints_left_out",
            severity="info",
            meaning="joints of the log are on another clock than those with torques, as a gripper's, and are not read",
            advice="nothing, or name the joints with `joints`",
        ),
        FindingType(
            code="no_gravity",
            severity="info",
            meaning="no gravity acts on the robot, as given",
            advice="nothing, or state `gravity`",
        ),
    )
}


def listed(names: Sequence[str], most: int = 3) -> str:
    """Names as a title has them: the first, and how many more."""
    if len(names) <= most:
        return " and ".join(filter(None, (", ".join(names[:-1]), names[-1]))) if names else ""
    return f"{', '.join(names[:most])} and {len(names) - most} more"


def titled(what: str, numbers: str) -> str:
    """A title with its numbers; without them where names are too long for both (the details have them)."""
    whole = f"{what} ({numbers})"
    return whole if len(whole) <= _LONGEST else what
