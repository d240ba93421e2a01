"""The table of a servo's findings: each code with its severity, meaning, and general advice."""

from jointid.estimate.types_of_findings import FindingType

TYPES = {
    each.code: each
    for each in (
        FindingType(
            code="no_known_load",
            severity="blocking",
            meaning="no load is known, so the scale of the motor's torque is unknown: all values have an unknown "
            "factor",
            advice="state mass and centre of mass of the load in `[link]`",
        ),
        FindingType(
            code="inseparable_back_emf",
            meaning="the motor is driven throughout. Back-EMF and viscous friction then brake alike: only their sum "
            "is known, and only k_t / R, not k_t and R",
            advice="record runs in which the torque is switched off while the load swings, or state the resistance",
        ),
        FindingType(
            code="at_bound",
            meaning="a value ended at its bound 0: the runs show none. Info unless it is torque per voltage or inertia",
            advice="record runs with other gains and motions",
        ),
        FindingType(
            code="undetermined",
            meaning="half of a value's 95 % interval exceeds a quarter of the value. Info for viscous friction",
            advice="record more runs, with other gains and motions",
        ),
        FindingType(
            code="poor_fit",
            meaning="more than 35 % of the load's torque stays unexplained",
            advice="check scale and sign of the duty, the position's unit, the load, and the link's angle",
        ),
    )
}
