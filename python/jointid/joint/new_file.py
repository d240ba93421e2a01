"""The text of a new joint file: known facts as lines, unknown facts as commented lines with an example."""

from __future__ import annotations

from collections.abc import Sequence

from jointid.base.errors import InputError
from jointid.base.values import dataclass
from jointid.joint.joint import Joint
from jointid.joint.joint_file import SCHEMA, joint_document


@dataclass(frozen=True, slots=True)
class Fact:
    """A key of a joint file.

    Parameters
    ----------
    table, key : str
    example : str
        Example value in the file's form, for a commented line.
    meaning : str
        Meaning of the key, with its unit.
    """

    table: str
    key: str
    example: str
    meaning: str


FACTS: tuple[Fact, ...] = (
    Fact("drive", "gear_ratio", "101", "motor angle per joint angle, negative if they turn in opposite directions"),
    Fact("drive", "torque_constant", "0.2", "N·m/A of the motor; needed if only the current is recorded"),
    Fact("drive", "rotor_inertia", "2.5e-4", "kg·m² of the motor and the parts that turn with it, motor side"),
    Fact("drive", "torque_hold", '"zoh"', '"zoh": a command held between samples, "linear": a measured torque'),
    Fact("model", "friction", '"stribeck"', "or coulomb_viscous, ...; without a name, identify chooses the model"),
    Fact("model", "gravity", '"free"', '"free": identified; "known": from [link]; "none": the axis is vertical'),
    Fact("link", "mass", "3.0", "kg"),
    Fact("link", "centre_of_mass", "0.25", "m from the joint's axis"),
    Fact("link", "angle", '"-90deg"', "centre of mass above the horizontal at position 0; rad, or deg as text"),
    Fact("link", "inertia", "0.25", "kg·m² about the joint's axis; without it, the link is a point mass"),
    Fact("limits", "position", '["-60deg", "60deg"]', "lowest and highest position; rad, or deg as text"),
    Fact("limits", "velocity", "3.0", "rad/s, largest"),
    Fact("limits", "torque", "100.0", "N·m at the output, largest"),
    Fact("limits", "current", "5.0", "A in the motor, largest"),
)  # fmt: skip
"""Usual facts of a joint file, in order; docs/guide.md has all keys."""

_SLIDING = {"rad/s": "m/s", "rad, or deg as text": "m", "N·m at": "N at", "kg·m²": "kg"}


def new_joint_text(joint: Joint, notes: Sequence[str] = ()) -> str:
    """Return the text of a joint file that describes a joint, with the unknown facts as comments.

    Parameters
    ----------
    joint : Joint
        Joint to describe; facts equal to their defaults count as unknown.
    notes : sequence of str
        Comment lines at the top. Default: none.

    Raises
    ------
    InputError
        The joint has parameters or tolerances; use `Joint.save` for such a joint.

    Examples
    --------
    >>> print(new_joint_text(Joint(name="elbow", gear_ratio=50.0)))  # doctest: +ELLIPSIS
    # ...
    schema = 2
    name = "elbow"
    kind = "revolute"
    <BLANKLINE>
    [drive]
    gear_ratio = 50.0  # motor angle per joint angle, negative if they turn in opposite directions
    # torque_constant = 0.2  # N·m/A of the motor; needed if only the current is recorded
    ...
    """
    if joint.parameters or joint.tolerances.given:
        raise InputError(
            "a new file cannot hold parameters and tolerances",
            argument="joint",
            remedy="save the joint",
        )
    document = joint_document(joint)
    if joint.gear_ratio == 1.0:
        document["drive"].pop("gear_ratio", None)
    lines = [f"# {' '.join(note.split())}" for note in notes]  # a line break would end the comment
    lines += ["# To state a value, remove the # of its line and write the value there."]
    lines += [
        f"schema = {SCHEMA}",
        f"name = {_written(joint.name)}",
        f"kind = {_written(joint.kind)}",
    ]
    for table in dict.fromkeys(fact.table for fact in FACTS):
        lines += ["", *_table(table, document.get(table, {}), joint.kind)]
        if table == "model":
            lines += ["", *_sensor(present=joint.sensor)]
    return "\n".join([*lines, ""])


def _table(table: str, known: dict[str, object], kind: str) -> list[str]:
    facts = [fact for fact in FACTS if fact.table == table]
    # A link needs its mass; without it the table is also a comment.
    lines = [f"[{table}]" if known or table != "link" else f"# [{table}]"]
    others = [key for key in known if key not in {fact.key for fact in facts}]
    lines += [f"{key} = {_written(known[key])}" for key in others]
    for fact in facts:
        meaning, example = fact.meaning, fact.example
        if kind == "prismatic":
            for turning, sliding in _SLIDING.items():
                meaning = meaning.replace(turning, sliding)
            example = (
                "[-0.5, 0.5]" if fact.table == "limits" and fact.key == "position" else example
            )
        if fact.key in known:
            lines.append(f"{fact.key} = {_written(known[fact.key])}  # {meaning}")
        else:
            lines.append(f"# {fact.key} = {example}  # {meaning}")
    return lines


def _sensor(*, present: bool) -> list[str]:
    meaning = "the joint has a torque sensor behind the gear; its gain and offset are identified"
    return [f"{'' if present else '# '}[sensor]  # {meaning}"]


def _written(value: object) -> str:
    """Return a value as TOML text."""
    import json

    if isinstance(value, list):
        return f"[{', '.join(map(_written, value))}]"
    # A JSON string is a TOML string, except for DEL, which TOML forbids and JSON does not escape.
    return json.dumps(value, ensure_ascii=False).replace("\x7f", "\\u007f")
