"""Headers: which signal and which unit they name."""

import re

from jointid.recording.units import Unit, find_unit

ALIASES: dict[str, str] = {
    alias: signal
    for signal, aliases in {
        "time": "time t",
        "position": "position pos angle q",
        "velocity": "velocity vel speed",
        "torque": "torque tau effort force motor_force motor_torque_output output_torque",
        "sensor": "sensor sensor_raw torque_sensor",
        "reference": "reference position_ref position_reference goal_position",
        "link_position": "link_position",
        "temperature": "temperature",
        "motor_torque": "motor_torque",
        "current": "current motor_current",
        "late": "late late_cycles",
    }.items()
    for alias in aliases.split()
}


def parsed(header: str) -> tuple[str, Unit | None, str]:
    """Return a header's plain name, its unit, and the text in the unit's place that is no unit."""
    if re.search(r"\((\d+,:|:,\d+)\)$", header):  # a part of a matrix: no unit in the brackets
        return plain(header), None, ""
    bracketed = re.fullmatch(r"(.*?)\s*[\[(]([^\[\]()]*)[\])]\s*", header)
    if bracketed and bracketed[2].strip():
        unit = find_unit(bracketed[2])
        return plain(bracketed[1]), unit, "" if unit else bracketed[2].strip()
    parts = re.split(r"[_\s,]+", (bracketed[1] if bracketed else header).strip())
    for first in range(1, len(parts)):  # the longest unit: rad_s before s
        suffix = "_".join(parts[first:])
        unit = find_unit(suffix) if suffix and not suffix[0].isdigit() else None
        if unit:
            return plain("_".join(parts[:first])), unit, ""
    return plain("_".join(parts)), None, ""


def plain(name: str) -> str:
    """Return a name in lower case, its words joined by single underscores."""
    return re.sub(r"[\s_.-]+", "_", name.strip().casefold())
