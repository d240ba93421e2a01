"""The table of a servo's findings: each code with its severity, meaning, and general advice."""

from jointid.estimate.types_of_findings import FindingType

TYPES = {
    each.code: each
    for each in (
        FindingType(
            code="no_known_load",
            severity="blocking",
            meaning="no load is known, so the scale of the motor's torque is unknown: all values are known "
            "only up to a common factor",
            advice="state mass and centre of mass of the load in `[link]`",
        ),
        FindingType(
            code="inseparable_back_emf",
            meaning="the motor is driven throughout. Back-EMF and viscous friction then have the same effect: only "
            "their sum is known. Of k_t and R, only k_t / R is known",
            advice="record runs in which the torque is switched off while the load swings, or state the resistance",
        ),
        FindingType(
            code="at_bound",
            meaning="a value ended at its bound 0: the runs show none of this effect. Info unless the value is torque "
            "per voltage or inertia",
            advice="record runs with other gains and motions",
        ),
        FindingType(
            code="undetermined",
            meaning="the 95 % interval is wider than ±25 % of the value. Info for viscous friction",
            advice="record more runs, with other gains and motions",
        ),
        FindingType(
            code="poor_fit",
            meaning="the model leaves more than 35 % of the load's torque unexplained",
            advice="check scale and sign of the duty, the position's unit, the load, and the link's angle",
        ),
    )
}
