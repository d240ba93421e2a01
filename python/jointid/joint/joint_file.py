"""Joint files: a joint as TOML; errors name file, table and key, and writing keeps comments."""

import os
import re
import tomllib
from collections.abc import Mapping
from dataclasses import fields
from pathlib import Path
from typing import Any, NoReturn, TypeVar

from jointid import _core
from jointid.base.argument_checks import require_path
from jointid.base.errors import InputError
from jointid.base.files import write_whole
from jointid.base.schema import read_bytes
from jointid.base.toml_file import check_length
from jointid.joint.checks import check_flag, check_parameter_name, suggestion
from jointid.joint.file_angles import keep_angles, with_angles
from jointid.joint.joint_fields import JointFields
from jointid.joint.link import Limits, Link
from jointid.joint.model import FIELDS, Model
from jointid.joint.parameters import Parameter, parameter_table
from jointid.joint.tolerances import Tolerances
from jointid.joint.toml_edit import update_table
from jointid.joint.voltage_drive import KEYS, drive_keys, voltage_of

J = TypeVar("J", bound=JointFields)

SCHEMA = 2
"""Version of the format; increased if a reader of the earlier format would misread the new one."""

_TOP = ("schema", "name", "kind")
_DRIVE = ("inertia", "rotor_inertia", "gear_ratio", "torque_constant", "torque_hold")
# Fields of a model; its name has the key of older files.
_NAME = "friction"
_MODEL = (_NAME, *FIELDS, "torque_offset")
_KEYS: dict[str, tuple[str, ...]] = {
    "drive": (*_DRIVE, *KEYS),
    "model": _MODEL,
    "sensor": ("present",),
    "link": tuple(field.name for field in fields(Link)),
    "parameters": (),  # the core defines the names
    "limits": tuple(field.name for field in fields(Limits)),
    "tolerances": tuple(field.name for field in fields(Tolerances)),
}
# Tables that are kept but are not fields of the joint: `estimate` is the origin of values, `session` holds
# settings of the joint's test bench, `user` is free.
_KEPT = ("estimate", "session", "user")


def read_document(path: str | os.PathLike[str]) -> dict[str, Any]:
    """Return the tables and keys of a joint file, unchecked.

    Raises
    ------
    InputError
        The file does not exist, or is not TOML.
    """
    place = require_path("path", path)
    return _parsed(_text(place), place)


def save_joint(joint: JointFields, path: str | os.PathLike[str]) -> None:
    """Write a joint file: see `Joint.save`."""
    place = require_path("path", path)
    if place.suffix != ".toml" and not place.is_dir():
        raise InputError("a joint is saved as .toml", argument="path", value=place.name)
    before = _text(place) if place.exists() else ""
    if before.strip():
        # An existing file is overwritten only if it is a joint file.
        joint_from_document(_parsed(before, place), str(place), type(joint))
    write_whole(place, _edited(before, joint, place).encode())


def joint_text(joint: JointFields) -> str:
    """Return the text of a new joint file."""
    return _edited("", joint, Path("joint.toml"))


def joint_document(joint: JointFields) -> dict[str, Any]:
    """Return a joint as the tables and keys of its file, in JSON's types and without None."""
    document: dict[str, Any] = {
        "schema": SCHEMA,
        "name": joint.name,
        "kind": joint.kind,
        "drive": _known(joint, _DRIVE) | drive_keys(joint.voltage),
        "model": _model_table(joint),
    }
    if joint.sensor:
        document["sensor"] = {"present": True}
    if joint.link is not None:
        document["link"] = _known(joint.link, _KEYS["link"])
    if joint.parameters:
        document["parameters"] = {
            name: _known(parameter, ("value", "min", "max", "vary"))
            for name, parameter in joint.parameters.items()
        }
    if joint.tolerances.given:
        document["tolerances"] = joint.tolerances.given
    if joint.limits != Limits():
        document["limits"] = _known(joint.limits, _KEYS["limits"])
    return document


def joint_from_document(document: Mapping[str, Any], source: str, kind: type[J]) -> J:
    """Return the joint from tables and keys; inverse of `joint_document`.

    Parameters
    ----------
    document : mapping
        Tables and keys; `estimate`, `session` and `user` are ignored.
    source : str
        Name of the file, for messages.
    kind : type
        `Joint`.

    Raises
    ------
    InputError
        A table or key is invalid; the error names source, table and key.
    """
    _check_schema(document, source)
    for key in document:
        if key not in (*_TOP, *_KEYS, *_KEPT):
            _refuse_key(source, "", key, (*_TOP, *_KEYS, *_KEPT))
    tables = {name: _table(document, name, source) for name in _KEYS}
    try:
        voltage = voltage_of(tables["drive"])
    except InputError as error:
        _refuse(source, error.place or "drive", error)
    arguments = {
        "voltage": voltage,
        **{key: document[key] for key in _TOP[1:] if key in document},
        **tables["drive"],
        **_model(tables["model"], source),
        "sensor": _sensor(document, tables["sensor"], source),
        "link": _link(document, tables["link"], source),
        "parameters": _parameters(tables["parameters"], source),
    }
    try:
        arguments["limits"] = Limits(**tables["limits"])
    except InputError as error:
        _refuse(source, "limits", error)
    try:
        arguments["tolerances"] = Tolerances(**tables["tolerances"])
    except InputError as error:
        _refuse(source, "tolerances", error)
    try:
        return kind(**arguments)
    except InputError as error:
        tables_of = {key: table for table in ("drive", "model") for key in _KEYS[table]}
        own = error.argument in _TOP  # a model also has a name
        if error.place is not None and error.place.endswith(": tolerances"):  # named like the facts
            tables_of[error.argument] = "tolerances"
        _refuse(source, "" if own else tables_of.get(error.argument, ""), error)


def _model_table(joint: JointFields) -> dict[str, Any]:
    """Return the table [model] of the stated fields."""
    stated = joint.model.stated()
    table = {_NAME: stated.pop("name")} if "name" in stated else {}
    return table | _listed(stated) | _known(joint, ("torque_offset",))


def _model(table: dict[str, Any], source: str) -> dict[str, Any]:
    """Return the arguments of a joint from the table [model]."""
    arguments = {"torque_offset": table.pop("torque_offset", None)}
    name = table.pop(_NAME, None)
    if name is not None and table.setdefault("name", name) != name:
        raise InputError(
            f"the model's name is given twice, as name and as {_NAME}",
            argument="name",
            value=table["name"],
            place=f"{source}: [model]",
        )
    try:
        return arguments | {"model": Model.of(table)}
    except InputError as error:
        _refuse(source, "model", error)


def _known(source: object, names: tuple[str, ...]) -> dict[str, Any]:
    """Return the attributes that are not None; tuples become lists, as in TOML and JSON."""
    return _listed({name: getattr(source, name) for name in names})


def _listed(values: Mapping[str, Any]) -> dict[str, Any]:
    return {
        name: list(value)
        if isinstance(value, tuple)
        else dict(value)
        if isinstance(value, Mapping)
        else value
        for name, value in values.items()
        if value is not None
    }


def _check_schema(document: Mapping[str, Any], source: str) -> None:
    if "schema" not in document:
        raise InputError(
            "it is missing",
            argument="schema",
            place=source,
            remedy=f"write schema = {SCHEMA} at the top",
        )
    schema = document["schema"]
    if isinstance(schema, bool) or not isinstance(schema, int) or schema < 1:
        raise InputError(f"{SCHEMA} is expected", argument="schema", value=schema, place=source)
    if schema > SCHEMA:
        raise InputError(
            f"this version of jointid reads schemas up to {SCHEMA}",
            argument="schema",
            value=schema,
            place=source,
            remedy="update jointid",
        )


def _table(document: Mapping[str, Any], name: str, source: str) -> dict[str, Any]:
    table = document.get(name, {})
    if not isinstance(table, Mapping):
        raise InputError(f"a table [{name}] is expected", argument=name, value=table, place=source)
    for key in table:
        if name != "parameters" and key not in _KEYS[name]:
            _refuse_key(source, name, key, _KEYS[name])
    return with_angles(dict(table), name, document, source)


def _sensor(document: Mapping[str, Any], table: dict[str, Any], source: str) -> bool:
    present = table.get("present", "sensor" in document)
    try:
        check_flag("sensor", "present", present)
    except InputError as error:
        _refuse(source, "sensor", error)
    return bool(present)


def _link(document: Mapping[str, Any], table: dict[str, Any], source: str) -> Link | None:
    if "link" not in document:
        return None
    for needed in ("mass", "centre_of_mass"):
        if needed not in table:
            raise InputError(
                "it is missing",
                argument=needed,
                place=f"{source}: [link]",
                remedy="state this value, or leave [link] out",
            )
    try:
        return Link(**table)
    except InputError as error:
        _refuse(source, "link", error)


def _parameters(table: dict[str, Any], source: str) -> dict[str, Parameter]:
    parameters: dict[str, Parameter] = {}
    for name, entry in table.items():
        place = "parameters"
        try:
            check_parameter_name(name)
            place += f".{name}" if isinstance(entry, Mapping) else ""
            parameters |= parameter_table({name: entry})
        except InputError as error:
            _refuse(source, place, error)
    return parameters


def _refuse(source: str, table: str, error: InputError) -> NoReturn:
    """Raise a constructor's error with the place in the file instead of that of the object."""
    raise InputError(
        error.reason,
        argument=error.argument,
        value=error.value,
        place=f"{source}: [{table}]" if table else source,
        remedy=error.remedy,
    ) from error


def _refuse_key(source: str, table: str, key: str, known: tuple[str, ...]) -> NoReturn:
    place = f"{source}: [{table}]" if table else source
    for other, keys in _KEYS.items():
        if key in keys:
            raise InputError(f"this key belongs in [{other}], not here", argument=key, place=place)
    raise InputError(f"there is no such key; {suggestion(key, known)}", argument=key, place=place)


# --- Text ---


def _text(path: Path) -> str:
    try:
        content = read_bytes(path)
    except FileNotFoundError:
        raise InputError(
            "there is no such file", place=str(path), remedy="check the path"
        ) from None
    except IsADirectoryError:
        raise InputError(
            "this is a folder; the name of a joint file is expected", place=str(path)
        ) from None
    except OSError as error:
        raise InputError(f"the file cannot be read: {error.strerror}", place=str(path)) from error
    try:
        return content.decode("utf-8-sig")  # some Windows editors write a byte order mark
    except UnicodeDecodeError as error:
        line = content.count(b"\n", 0, error.start) + 1
        raise InputError(
            "this is not text in UTF-8",
            place=f"{path}, line {line}",
            remedy="save the file as UTF-8",
        ) from None


def _parsed(text: str, path: Path) -> dict[str, Any]:
    check_length(text, path)
    try:
        return tomllib.loads(text)
    except RecursionError:
        raise InputError("not a joint file: it is nested too deeply", place=str(path)) from None
    except ValueError as error:  # a TOMLDecodeError, or a number with too many digits
        reason, _, position = str(error).partition(" (at ")
        found = re.match(r"line (\d+)", position)
        line = int(found[1]) if found else text.rstrip().count("\n") + 1
        raise InputError(
            f"not TOML: {reason}"
            if path.suffix.lower() == ".toml"
            else "a joint file (.toml) or an estimate (.json) is expected here, but this is not TOML",
            place=f"{path}, line {line}",
            remedy="write lines like gear_ratio = 101 or present = true"
            if path.suffix.lower() == ".toml"
            else (),
        ) from None


def _edited(before: str, joint: JointFields, path: Path) -> str:
    """Return the text of a joint file, edited to describe another joint."""
    import tomlkit

    windows = "\r\n" in before
    for inline in (False, True):
        editable = tomlkit.parse(before.replace("\r\n", "\n"))
        wanted = joint_document(joint)
        # Tables that may be empty stay, with their comments.
        if "sensor" in editable:
            bare = "present" not in editable["sensor"]
            wanted["sensor"] = {} if bare and joint.sensor else {"present": joint.sensor}
        for table in {"parameters", "limits", "tolerances"} & set(editable):
            wanted.setdefault(table, {})
        keep_angles(tomllib.loads(before), wanted)
        usual = {} if inline else _defaults(type(joint)(), new=not before.strip())
        update_table([editable], wanted, usual, kept=_KEPT, inline=inline)
        text = tomlkit.dumps(editable)
        # The result is verified, because in some layouts of TOML a new table cannot have its own lines, or
        # cannot be empty.
        try:
            if joint_from_document(tomllib.loads(text), str(path), type(joint)) == joint:
                return text.replace("\n", "\r\n") if windows else text
        except ValueError:  # from the parser, or an InputError
            continue
    raise InputError(
        "the layout of this file cannot be kept",
        place=str(path),
        remedy="save the joint as a new file",
    )


def _defaults(empty: JointFields, *, new: bool) -> dict[str, Any]:
    """Return the tables and keys that are not written because they equal their defaults."""
    # NOTE: the value is included, so that a table with a value is always written.
    usual = {name: {"value": None, "vary": True} for name in _core.parameter_names()}
    if new:  # a new file shows all other fields, so that the user can change them
        return {"parameters": usual}
    link = {field.name: field.default for field in fields(Link)}
    return {**joint_document(empty), "link": link, "parameters": usual}
