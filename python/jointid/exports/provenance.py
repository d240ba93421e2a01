"""Statements in every exported file: source, units, signs, uncertainty, and missing parts."""

from __future__ import annotations

import unicodedata
from collections.abc import Sequence

from jointid.exports.subject import ExportedValue, Subject

_PLAIN = str.maketrans(
    {
        "·": "*",
        "²": "^2",
        "³": "^3",
        "±": "+-",
        "√": "sqrt ",
        "…": "...",
        "−": "-",
        "–": "-",
        "—": "-",
        "≥": ">=",
        "≤": "<=",
        "°": " deg",
        "Ω": "ohm",
        "×": "x",
        "→": "->",
        "’": "'",
    }
)


def statements(subject: Subject, *, notes: Sequence[str] = ()) -> list[str]:
    """Return the statements of a file, line by line. `notes` describe parts that the target changes or lacks."""
    joint = subject.joint
    name = f"Joint '{joint.name}'" if joint.name else "Joint"
    force = "force" if joint.kind == "prismatic" else "torque"
    lines = [
        f"{name}, exported by jointid {subject.version} on {subject.date} (UTC).",
        f"Source: {subject.source}.",
        f"Model: {subject.model}.",
        f"Units: SI ({subject.position_unit}, {subject.position_unit}/s, {subject.torque_unit}), on the output side"
        " of the gear (joint side) unless stated otherwise.",
        f"Sign: a positive {force} of the drive moves the joint towards positive position. Friction has the sign of the"
        f" velocity: the drive needs this {force} in addition.",
        f"Gear ratio {joint.gear_ratio!r} (motor angle per joint position): motor {force} = {force} / gear ratio.",
    ]
    if subject.speed is not None:
        lines.append(
            f"Speeds up to {subject.speed!r} {subject.position_unit}/s are known; friction above this speed is "
            "extrapolated."
        )
    lines.append("Parameters:")
    lines += [f"  {value_line(each)}" for each in subject.values]
    if subject.undetermined:
        names = ", ".join(subject.undetermined)
        lines.append(f"The recording determines these values poorly or not at all: {names}.")
    if subject.unknown:
        lines.append(f"Values of unknown uncertainty: {', '.join(subject.unknown)}.")
    if subject.findings:
        lines.append("Warnings of the identification:")
        lines += [f"  {each}" for each in subject.findings]
    if subject.others:
        notes = [*notes, f"this file lacks {subject.others}: add this {force} to the simulation"]
    if notes:
        lines.append("Notes:")
        lines += [f"  {each}" for each in notes]
    return lines


def value_line(value: ExportedValue) -> str:
    """Return a parameter with its unit and its uncertainty, in one line."""
    parts = [f"{value.name} = {value.value!r} {value.unit}: {value.meaning}"]
    if value.stderr is not None:
        parts.append(f"standard error {value.stderr:.3g}")
    if value.interval is not None:
        parts.append(f"95 % interval {value.interval[0]:.6g} to {value.interval[1]:.6g}")
    if value.remark:
        parts.append(value.remark)
    return ", ".join(parts)


def plain(text: str) -> str:
    """Return text in ASCII on one line, for programs that read only ASCII."""
    decomposed = unicodedata.normalize("NFKD", text.translate(_PLAIN))
    return " ".join(decomposed.encode("ascii", "ignore").decode("ascii").split(" ")).translate(
        dict.fromkeys((*range(32), 127), " ")
    )
