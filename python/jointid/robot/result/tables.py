"""Tables of a robot's estimate, as text."""

from __future__ import annotations

from collections.abc import Callable, Mapping

from jointid.base.advice import Action
from jointid.base.error_text import printable
from jointid.base.text_table import aligned
from jointid.estimate.wording import number, percent, two_digits
from jointid.joints.tables import value_with_error
from jointid.robot.links.parameters import PARAMETERS
from jointid.robot.motion.shifts import FILTER
from jointid.robot.result.record import RobotEstimateRecord
from jointid.robot.result.verdict import judged_robot


def shown_parameters(estimate: RobotEstimateRecord) -> list[str]:
    """Return the names of the parameters that any joint has, in the order of the table."""
    present = {name for joint in estimate.joints.values() for name in joint.parameters}
    return [name for name in PARAMETERS if name in present]


def head(estimate: RobotEstimateRecord) -> list[str]:
    """Return the table's head."""
    units: dict[str, str] = {}
    for joint in estimate.joints.values():
        for name, parameter in joint.parameters.items():
            units.setdefault(name, parameter.unit)
    shown = [
        f"{name} [{units[name]}]" if units[name] not in ("", "1") else name
        for name in shown_parameters(estimate)
    ]
    return ["joint", *shown, "residual", "left out", "model", "warnings"]


def rows(estimate: RobotEstimateRecord) -> list[list[str]]:
    """Return one row for each joint, in the order of the head."""
    names = shown_parameters(estimate)
    return [
        [
            joint.name,
            *(value_with_error(joint.parameters.get(name)) for name in names),
            f"{100.0 * joint.relative_residual:.1f} %",
            percent(joint.residuals.left_out),
            joint.model,
            _codes(estimate, joint.name),
        ]
        for joint in estimate.joints.values()
    ]


def _codes(estimate: RobotEstimateRecord, name: str) -> str:
    mine = [
        found.code
        for found in estimate.warnings
        if f"{name} " in f"{found.cause} "
        or any(p.startswith(f"{name}.") for p in found.parameters)
    ]
    return ", ".join(dict.fromkeys(mine)) or "none"


def quality(estimate: RobotEstimateRecord) -> list[tuple[str, str]]:
    """Return the quality of the fit and its inputs, as pairs of label and text."""
    inertia = {
        "urdf": "taken from the URDF",
        "scaled": "inertia of the URDF, with one identified factor per link",
        "free": f"identified: {len(estimate.base_parameters)} base parameters",
    }[estimate.inertia]
    if estimate.inertia == "free" and estimate.consistent:
        inertia += ", physically consistent"
        if estimate.impossible_by:
            inertia += f" within {two_digits(estimate.impossible_by)} standard errors"
    elif estimate.consistent is False:
        inertia += ", not physically consistent"
    windows = sum(joint.residuals.windows for joint in estimate.joints.values())
    duration = 1e3 * float(estimate.settings.get("window_duration", 0.0))
    return [
        ("inertia", inertia),
        *_turning(estimate),
        (
            "fit",
            f"relative residual {100.0 * estimate.relative_residual:.2f} % of all joints' torque",
        ),
        ("windows", f"{windows} of {duration:.4g} ms, all joints"),
        *([] if estimate.cross_check is None else [("cross-check", str(estimate.cross_check))]),
        ("condition", f"{estimate.condition:.3g}"),
        ("time", f"{estimate.seconds:.2f} s"),
    ]


def _turning(estimate: RobotEstimateRecord) -> list[tuple[str, str]]:
    """Return which motors turn with several joints, and the zeros, delays and filters that were removed."""
    robot, found = estimate.robot, []
    for motor in map(int, robot.coupled.nonzero()[0]):
        row = robot.couplings[motor]
        shares = [f"{row[joint]:.4g} {robot.names[joint]}" for joint in map(int, row.nonzero()[0])]
        found.append(("coupling", f"motor {robot.names[motor]} turns with {' + '.join(shares)}"))
    shift = estimate.settings.get("shift", {})
    for key, what in (("torque", "delay removed"), (FILTER, "low-pass filter undone")):
        given = shift.get(key)
        if given:
            each = given.items() if isinstance(given, Mapping) else [("all joints", given)]
            sizes = ", ".join(f"{1e3 * value:.3g} ms of {name}" for name, value in each)
            found.append(("delay", f"torques' {what}: {sizes}"))
    return found


def base_rows(estimate: RobotEstimateRecord) -> list[list[str]]:
    """Return the table of base parameters: value, error, unit, combination."""
    return [
        [
            number(p.value),
            "–" if p.stderr is None else two_digits(p.stderr),
            p.unit,
            p.name,
        ]
        for p in estimate.base_parameters.values()
    ]


def text_summary(estimate: RobotEstimateRecord) -> str:
    """Return the table of the joints."""
    return printable("\n".join(aligned([head(estimate), *rows(estimate)])))


def text_report(estimate: RobotEstimateRecord, action: Callable[[Action], str] = str) -> str:
    """Return the estimate as text; `action` gives the text of an advice."""
    lines = [f"jointid robot estimate — {estimate.robot.name}; value ± standard error", ""]
    lines += [*judged_robot(estimate).lines(), ""]
    lines += [*aligned([head(estimate), *rows(estimate)]), ""]
    width = max(len(label) for label, _ in quality(estimate))
    lines += [f"{label.ljust(width)}  {text}" for label, text in quality(estimate)]
    if estimate.base_parameters:
        table = [["value", "± std. error", "unit", "base parameter"], *base_rows(estimate)]
        lines += ["", *aligned(table)]
    lines += [
        "",
        *(f"{each.severity} ({each.code}): {each.worded(action)}" for each in estimate.findings),
    ]
    return printable("\n".join(lines).rstrip())
