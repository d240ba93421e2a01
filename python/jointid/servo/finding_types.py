"""The table of a servo's findings: each code with its severity, meaning, and general advice."""

from jointid.estimate.types_of_findings import FindingType

TYPES = {
    each.code: each
    for each in (
        FindingType(
            code="no_known_load",
            severity="blocking",
            meaning="no load is known, so the scale of the motor's torque is unknown. All values are known only up to "
            "one common factor",
            advice="state mass and centre of mass of the load in `[link]`",
        ),
        FindingType(
            code="inseparable_back_emf",
            meaning="the motor is driven throughout, so back-EMF and viscous friction have the same effect. Only the "
            "sum of the two and the ratio k_t / R are known",
            advice="record runs in which the torque is switched off while the load swings, or state the resistance",
        ),
        FindingType(
            code="at_bound",
            meaning="a value ended at its bound, 0, because the runs do not show its effect. Info for all values "
            "except torque per voltage and inertia",
            advice="record runs with other gains and motions",
        ),
        FindingType(
            code="undetermined",
            meaning="the 95 % interval of a value is wider than ±25 % of the value. Info for viscous friction",
            advice="record more runs, with other gains and motions",
        ),
        FindingType(
            code="poor_fit",
            meaning="the residual is larger than 35 % of the load's torque",
            advice="check scale and sign of the duty, the position's unit, the load, and the link's angle",
        ),
    )
}
