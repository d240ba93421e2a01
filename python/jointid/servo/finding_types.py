"""The table of a servo's findings: each code with its severity, its meaning, and what to do in general."""

from jointid.estimate.types_of_findings import FindingType

TYPES = {
    each.code: each
    for each in (
        FindingType(
            code="no_known_load",
            severity="blocking",
            meaning="no load is known, so nothing says how large the motor's torque is: all values have an unknown "
            "factor",
            advice="state mass and centre of mass of the load in `[link]`",
        ),
        FindingType(
            code="inseparable_back_emf",
            meaning="the motor is driven throughout, so back-EMF and viscous friction brake alike and only their sum "
            "is known; k_t and R are not identifiable, only k_t / R",
            advice="record runs in which the torque is switched off while the load swings, or state the resistance",
        ),
        FindingType(
            code="at_bound",
            meaning="a value ended on its bound 0: the runs show none. Info: a value other than torque per voltage "
            "and inertia",
            advice="record runs with other gains and motions",
        ),
        FindingType(
            code="undetermined",
            meaning="half of a value's 95 % interval exceeds a quarter of the value. Info: viscous friction",
            advice="record more runs, with other gains and motions",
        ),
        FindingType(
            code="poor_fit",
            meaning="the model leaves more than 35 % of the load's torque",
            advice="check scale and sign of the duty, the position's unit, the load, and the link's angle",
        ),
    )
}
