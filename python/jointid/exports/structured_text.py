"""IEC 61131-3 Structured Text: a function block with the joint's torques, and a block that checks it."""

from __future__ import annotations

from jointid.exports.expressions import (
    Language,
    centred,
    constants,
    fading,
    growing,
    origin,
    periodic,
    total,
    upper,
)
from jointid.exports.identifiers import identifier
from jointid.exports.law import Over
from jointid.exports.provenance import plain, statements, value_line
from jointid.exports.subject import Subject
from jointid.exports.tables import reference_values, smooth_width, torque_scale
from jointid.exports.target import Order, Target

_TOLERANCE = 1e-9


def _write(subject: Subject, order: Order) -> bytes:
    name = identifier(order.name)
    notes = [
        "friction is 0 at velocity 0, but friction of a real joint at rest has any value up to breakaway: connect "
        "the reference velocity, not the measured velocity",
        "only elements of the second edition of IEC 61131-3 are used, so that older systems can read this file",
    ]
    if subject.law.inertia is None:
        notes.append("inertia: unknown, taken as 0")
    if loads := subject.law.loaded_by:
        notes.append(f"load is the torque {loads}; its sign does not matter")
    lines = [
        *_comment(statements(subject, notes=notes)),
        *_block(subject, name),
        "",
        *_check(subject, name),
        "",
    ]
    return "\n".join(lines).encode("ascii")


def literal(value: float) -> str:
    """Return a number in the notation of IEC 61131-3: with a decimal point, also before an exponent.

    Examples
    --------
    >>> literal(1e-05)
    '1.0e-05'
    """
    text = repr(float(value))
    digits, exponent, power = text.partition("e")
    return f"{digits}.0{exponent}{power}" if exponent and "." not in digits else text


def _constant(name: str) -> str:
    """Return a constant's name. The prefix avoids keywords such as STATIC, because some systems ignore case."""
    return f"P_{upper(name)}"


def _safe(text: str) -> str:
    """Return text that neither ends a comment nor begins another."""
    return plain(text).replace("*)", "* )").replace("(*", "( *").replace("$", "")


def _comment(lines: list[str]) -> list[str]:
    return ["(*", *(f"  {_safe(line)}".rstrip() for line in lines), "*)"]


def _block(subject: Subject, name: str) -> list[str]:
    law = subject.law
    position, torque = subject.position_unit, plain(subject.torque_unit)
    language = Language(name=_constant, number=literal, exp="EXP", log="LN", sin="SIN", cos="COS")
    turned: dict[Over, str] = {
        "gravity": "position",
        "harmonics": "position",
        "ripple": "motor_angle",
    }
    periods = {
        kind: total(
            periodic(law, kind, angle, language)
            + (centred(law, "torque", language) if kind == "harmonics" else []),
            "0.0",
        )
        for kind, angle in turned.items()
    }
    inertia = total(["P_INERTIA", "P_LINK_INERTIA", *centred(law, "inertia", language)], "0.0")
    slope = total(centred(law, "inertia", language, slope=True), "0.0")
    sensor = "0.0" if law.sensor is None else "P_SENSOR_GAIN * reading + P_SENSOR_OFFSET"
    sides = {
        side: (
            total(fading(law, side, language), "0.0"),
            total(growing(law, side, language), "0.0"),
        )
        for side in (1, -1)
    }
    return [
        f"FUNCTION_BLOCK FB_{name}_Friction",
        "VAR_INPUT",
        f"    position : LREAL; (* {position} *)",
        f"    velocity : LREAL; (* {position}/s *)",
        f"    acceleration : LREAL; (* {position}/s^2 *)",
        f"    load : LREAL; (* {torque}, for load friction *)",
        "    reading : LREAL; (* raw reading of the torque sensor *)",
        f"    width : LREAL; (* {position}/s; above 0: smooth sign, tanh(velocity / width) *)",
        "END_VAR",
        "VAR_OUTPUT",
        f"    friction : LREAL; (* {torque}, with the sign of the velocity *)",
        f"    gravity : LREAL; (* {torque} *)",
        f"    harmonics : LREAL; (* {torque}, over the joint's angle *)",
        f"    ripple : LREAL; (* {torque}, over the motor's angle *)",
        f"    torque : LREAL; (* {torque}, of the drive at the output, for this motion *)",
        f"    motor_torque : LREAL; (* {torque} *)",
        f"    sensor_torque : LREAL; (* {torque}, behind the sensor, from its reading *)",
        "END_VAR",
        "VAR CONSTANT",
        *_constants(subject),
        "END_VAR",
        "VAR",
        "    speed : LREAL;",
        "    load_size : LREAL;",
        "    fade : LREAL;",
        "    motor_angle : LREAL;",
        "    inertia : LREAL; (* of drive and link, at this position *)",
        "    inertia_slope : LREAL; (* of the inertia over the position *)",
        "END_VAR",
        "",
        "speed := ABS(velocity);",
        "load_size := ABS(load);",
        "motor_angle := P_GEAR_RATIO * position;",
        "fade := 1.0;",
        "IF width > 0.0 THEN",
        "    fade := EXP(-2.0 * speed / width);",
        "    fade := (1.0 - fade) / (1.0 + fade);",
        "END_IF",
        "IF velocity > 0.0 THEN",
        f"    friction := fade * ({sides[1][0]}) + ({sides[1][1]});",
        "ELSIF velocity < 0.0 THEN",
        f"    friction := -(fade * ({sides[-1][0]}) + ({sides[-1][1]}));",
        "ELSE",
        "    friction := 0.0;",
        "END_IF",
        f"gravity := {periods['gravity']};",
        f"harmonics := {periods['harmonics']};",
        f"ripple := {periods['ripple']};",
        f"inertia := {inertia};",
        f"inertia_slope := {slope};",
        "torque := inertia * acceleration + 0.5 * inertia_slope * velocity * velocity + P_TORQUE_OFFSET",
        "    + friction + gravity + harmonics + ripple;",
        "motor_torque := torque / P_GEAR_RATIO;",
        f"sensor_torque := {sensor};",
        "END_FUNCTION_BLOCK",
    ]


def _constants(subject: Subject) -> list[str]:
    law = subject.law
    known = {each.name: each for each in subject.values}
    lines = []

    def add(key: str, value: float, usual: str) -> None:
        found = known.get(key)
        says = usual if found is None else value_line(found)
        lines.append(f"    {_constant(key)} : LREAL := {literal(value)}; (* {_safe(says)} *)")

    for parameter, value in constants(law).items():
        add(parameter, value, origin(parameter))
    add("inertia", law.inertia or 0.0, "not known")
    add("LINK_INERTIA", law.link_inertia, "behind the torque sensor, from the link")
    add("torque_offset", law.offset, "none")
    add("GEAR_RATIO", law.gear_ratio, "motor angle per joint position")
    for parameter, value in zip(("sensor_gain", "sensor_offset"), law.sensor or (), strict=False):
        add(parameter, value, "")
    if subject.joint.torque_constant is not None:
        add("TORQUE_CONSTANT", subject.joint.torque_constant, "motor torque per current [N*m/A]")
    add("SMOOTH_WIDTH", smooth_width(subject), "a value for width: 1 % of the largest known speed")
    return lines


def _check(subject: Subject, name: str) -> list[str]:
    rows = reference_values(subject)[::3]  # some systems are slow with long arrays
    inputs = ("position", "velocity", "acceleration", "load", "width", "reading")
    outputs = ("friction", "torque", "sensor_torque")
    columns = [
        f"    {column}_at : ARRAY [0..{len(rows) - 1}] OF LREAL := "
        f"[{', '.join(literal(getattr(row, column)) for row in rows)}];"
        for column in (*inputs, *outputs)
    ]
    given = ", ".join(f"{column} := {column}_at[number]" for column in inputs)
    compared = [
        line
        for column in outputs
        for line in (
            f"    IF ABS(joint.{column} - {column}_at[number]) > ALLOWED THEN",
            "        wrong := wrong + 1;",
            "    END_IF",
        )
    ]
    return [
        "(* Compares the block with values of jointid: wrong is the number of different values, 0 if all agree. *)",
        f"FUNCTION_BLOCK FB_{name}_SelfCheck",
        "VAR_OUTPUT",
        "    wrong : INT;",
        "END_VAR",
        "VAR CONSTANT",
        f"    ALLOWED : LREAL := {literal(_TOLERANCE * torque_scale(subject))};",
        "END_VAR",
        "VAR",
        f"    joint : FB_{name}_Friction;",
        "    number : INT;",
        *columns,
        "END_VAR",
        "",
        "wrong := 0;",
        f"FOR number := 0 TO {len(rows) - 1} DO",
        f"    joint({given});",
        *compared,
        "END_FOR",
        "END_FUNCTION_BLOCK",
    ]


TARGET = Target(name="st", endings=(".st",), meaning="IEC 61131-3 Structured Text", write=_write)
