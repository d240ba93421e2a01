"""C99: a header with the joint's torques as functions, reference values, and a self-check."""

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
from jointid.exports.provenance import plain, statements, value_line
from jointid.exports.subject import Subject
from jointid.exports.tables import (
    reference_values,
    smooth_width,
    torque_scale,
)
from jointid.exports.target import Order, Target


def _write(subject: Subject, order: Order) -> bytes:
    name = identifier(order.name).lower()
    law = subject.law
    big = name.upper()
    language = Language(
        name=lambda parameter: f"{big}_{upper(parameter)}",
        number=lambda value: f"(({name}_real){value!r})",
        exp=f"{big}_EXP",
        log=f"{big}_LOG",
        sin=f"{big}_SIN",
        cos=f"{big}_COS",
    )
    notes = [
        f"define {big}_USE_FLOAT before including this file to compute in single precision",
        "friction is 0 at velocity 0, but friction of a real joint at rest has any value up to breakaway: pass the "
        "reference velocity, not the measured velocity",
    ]
    if law.inertia is None:
        notes.append("inertia: unknown, taken as 0")
    if loads := subject.law.loaded_by:
        notes.append(
            f"load is the torque {loads} ({plain(subject.torque_unit)}); its sign does not matter"
        )
    zero = f"(({name}_real)0.0)"
    angle = f"{big}_GEAR_RATIO * position"
    text = [
        "/*",
        *(f" * {_comment(line)}".rstrip() for line in statements(subject, notes=notes)),
        " */",
        f"#ifndef {big}_FRICTION_H",
        f"#define {big}_FRICTION_H",
        "",
        "#include <math.h>",
        "",
        f"#ifdef {big}_USE_FLOAT",
        f"typedef float {name}_real;",
        *(f"#define {big}_{f.upper()} {f}f" for f in ("exp", "log", "sin", "cos", "tanh", "fabs")),
        f"#define {big}_TOLERANCE 1.0e-4f",
        "#else",
        f"typedef double {name}_real;",
        *(f"#define {big}_{f.upper()} {f}" for f in ("exp", "log", "sin", "cos", "tanh", "fabs")),
        f"#define {big}_TOLERANCE 1.0e-9",
        "#endif",
        "",
        *_constants(subject, name),
        "",
        f"/* Sign of the velocity; with a width above 0 [{subject.position_unit}/s], tanh(velocity / width). */",
        f"static inline {name}_real {name}_sign({name}_real velocity, {name}_real width)",
        "{",
        f"    {name}_real sign = {zero};",
        f"    if (width > {zero}) {{",
        f"        sign = {big}_TANH(velocity / width);",
        f"    }} else if (velocity > {zero}) {{",
        f"        sign = ({name}_real)1.0;",
        f"    }} else if (velocity < {zero}) {{",
        f"        sign = ({name}_real)-1.0;",
        "    } else {",
        f"        sign = {zero};",
        "    }",
        "    return sign;",
        "}",
        "",
        "/* Friction at a velocity and a load; terms that are not 0 at speed 0 are multiplied by the sign. */",
        f"static inline {name}_real {name}_friction_smooth({name}_real velocity, {name}_real load, {name}_real width)",
        "{",
        f"    const {name}_real speed = {big}_FABS(velocity);",
        f"    const {name}_real load_size = {big}_FABS(load);",
        f"    const {name}_real sign = {name}_sign(velocity, width);",
        f"    {name}_real torque = {zero};",
        f"    if (velocity > {zero}) {{",
        f"        torque = (sign * ({total(fading(law, 1, language), zero)}))",
        f"            + ({total(growing(law, 1, language), zero)});",
        f"    }} else if (velocity < {zero}) {{",
        f"        torque = (sign * ({total(fading(law, -1, language), zero)}))",
        f"            - ({total(growing(law, -1, language), zero)});",
        "    } else {",
        f"        torque = {zero};",
        "    }",
        "    (void)speed;",
        "    (void)load_size;",
        "    return torque;",
        "}",
        "",
        "/* Identified friction, with the sign of the velocity. */",
        f"static inline {name}_real {name}_friction({name}_real velocity, {name}_real load)",
        "{",
        f"    return {name}_friction_smooth(velocity, load, {zero});",
        "}",
        "",
        "/* Torque of gravity at a position: the drive torque that holds the joint there. */",
        *_function(
            f"{name}_gravity",
            name,
            "position",
            periodic(law, "gravity", "position", language),
            zero,
        ),
        "",
        "/* Torque over the joint's angle, without gravity. */",
        *_function(
            f"{name}_harmonics",
            name,
            "position",
            [
                *periodic(law, "harmonics", "position", language),
                *centred(law, "torque", language),
            ],
            zero,
        ),
        "",
        "/* Ripple over the motor's angle, which is 0 where the position is 0. */",
        *_function(
            f"{name}_ripple",
            name,
            "motor_angle",
            periodic(law, "ripple", "motor_angle", language),
            zero,
        ),
        "",
        "/* Inertia of drive and link at a position. */",
        *_function(
            f"{name}_inertia",
            name,
            "position",
            [f"{big}_INERTIA", f"{big}_LINK_INERTIA", *centred(law, "inertia", language)],
            zero,
            used=bool(law.functions("inertia")),
        ),
        "",
        "/* Slope of the inertia over the position: the torque contains slope * velocity^2 / 2. */",
        *_function(
            f"{name}_inertia_slope",
            name,
            "position",
            centred(law, "inertia", language, slope=True),
            zero,
        ),
        "",
        "/* Drive torque at the output for a motion: the sum of all terms of the model. */",
        f"static inline {name}_real {name}_torque({name}_real position, {name}_real velocity,",
        f"    {name}_real acceleration, {name}_real load, {name}_real width)",
        "{",
        f"    return ({name}_inertia(position) * acceleration)",
        f"        + (({name}_real)0.5 * {name}_inertia_slope(position) * velocity * velocity)",
        f"        + {name}_friction_smooth(velocity, load, width)",
        f"        + {name}_gravity(position) + {name}_harmonics(position)",
        f"        + {name}_ripple({angle}) + {big}_TORQUE_OFFSET;",
        "}",
        "",
        "/* Torque of the motor for a torque at the output. */",
        f"static inline {name}_real {name}_motor_torque({name}_real torque)",
        "{",
        f"    return torque / {big}_GEAR_RATIO;",
        "}",
        "",
        *_sensor(subject, name),
        *_check(subject, name),
        f"#endif /* {big}_FRICTION_H */",
        "",
    ]
    return "\n".join(text).encode("ascii")


def _comment(line: str) -> str:
    """Return text that neither ends a comment, nor begins one, nor forms a trigraph."""
    return plain(line).replace("*/", "* /").replace("/*", "/ *").replace("??", "? ?").rstrip("\\")


def _constants(subject: Subject, name: str) -> list[str]:
    big, law = name.upper(), subject.law
    known = {each.name: each for each in subject.values}
    lines = []

    def add(key: str, value: float, says: str) -> None:
        lines.append(f"/* {_comment(says)} */")
        lines.append(f"#define {big}_{key} (({name}_real){value!r})")

    for parameter, value in constants(law).items():
        found = known.get(parameter)
        says = (
            value_line(found)
            if found is not None
            else f"{parameter} = {value!r}: {origin(parameter)}"
        )
        add(upper(parameter), value, says)
    inertia = known.get("inertia")
    add("INERTIA", law.inertia or 0.0, "not known" if inertia is None else value_line(inertia))
    add("LINK_INERTIA", law.link_inertia, "inertia behind the torque sensor, from the link")
    offset = known.get("torque_offset")
    add("TORQUE_OFFSET", law.offset, "none" if offset is None else value_line(offset))
    add("GEAR_RATIO", law.gear_ratio, "motor angle per joint position")
    if subject.joint.torque_constant is not None:
        add("TORQUE_CONSTANT", subject.joint.torque_constant, "motor torque per current [N*m/A]")
    add(
        "SMOOTH_WIDTH",
        smooth_width(subject),
        f"width for the smooth sign [{subject.position_unit}/s]: 1 % of the largest known speed",
    )
    return lines


def _function(
    function: str, name: str, angle: str, summands: list[str], zero: str, used: bool = True
) -> list[str]:
    unused = [] if summands and used else [f"    (void){angle};"]
    body = "\n        + ".join(summands) if summands else zero
    return [
        f"static inline {name}_real {function}({name}_real {angle})",
        "{",
        *unused,
        f"    return {body};",
        "}",
    ]


def _sensor(subject: Subject, name: str) -> list[str]:
    sensor = subject.law.sensor
    if sensor is None:
        return []
    known = {each.name: each for each in subject.values}
    big = name.upper()
    lines = []
    for key, value in zip(("sensor_gain", "sensor_offset"), sensor, strict=True):
        lines.append(f"/* {_comment(value_line(known[key]))} */")
        lines.append(f"#define {big}_{upper(key)} (({name}_real){value!r})")
    return [
        *lines,
        "/* Torque behind the sensor from its raw reading. */",
        f"static inline {name}_real {name}_sensor_torque({name}_real reading)",
        "{",
        f"    return ({big}_SENSOR_GAIN * reading) + {big}_SENSOR_OFFSET;",
        "}",
        "",
    ]


def _check(subject: Subject, name: str) -> list[str]:
    big, sensor = name.upper(), subject.law.sensor is not None
    rows = reference_values(subject)
    table = [
        "        { "
        + ", ".join(
            f"({name}_real){value!r}"
            for value in (
                *(row.position, row.velocity, row.acceleration, row.load, row.width, row.reading),
                *(row.friction, row.torque, row.sensor_torque),
            )
        )
        + " },"
        for row in rows
    ]
    table[-1] = table[-1].removesuffix(",")
    checks = [
        ("friction", f"{name}_friction_smooth(row[1], row[3], row[4])", 6),
        ("torque", f"{name}_torque(row[0], row[1], row[2], row[3], row[4])", 7),
    ]
    if sensor:
        checks.append(("sensor torque", f"{name}_sensor_torque(row[5])", 8))
    lines = [
        "/* Compare the functions with jointid's own values; return the number of differences (0: all agree). */",
        f"static inline int {name}_self_check(void)",
        "{",
        "    /* 6 inputs: position, velocity, acceleration, load, width, reading;",
        "       3 results: friction, torque, sensor torque */",
        f"    static const {name}_real table[{len(rows)}][9] = {{",
        *table,
        "    };",
        f"    const {name}_real allowed = ({name}_real){big}_TOLERANCE * ({name}_real){torque_scale(subject)!r};",
        "    int wrong = 0;",
        "    int number;",
        f"    for (number = 0; number < {len(rows)}; number++) {{",
        f"        const {name}_real *row = table[number];",
    ]
    for _, call, column in checks:
        lines += [
            f"        if (!({big}_FABS({call} - row[{column}]) <= allowed)) {{",
            "            wrong++;",
            "        }",
        ]
    return [*lines, "    }", "    return wrong;", "}", ""]


TARGET = Target(name="c", endings=(".h",), meaning="C99 header", write=_write)
