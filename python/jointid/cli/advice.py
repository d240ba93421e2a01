"""Advice in the words of a command: options instead of arguments, or entries for the joint file."""

from __future__ import annotations

import shlex
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import fields, is_dataclass
from typing import Any

from jointid.base.advice import Action
from jointid.cli.arguments import number_or_text, text_by_joint
from jointid.cli.options import FILES, FLAGS, NUMBERS, OPTIONS, PLACEHOLDERS, option_of
from jointid.cli.values import behind_option, in_joint_file

MODEL_FIELDS = frozenset(
    {"name", "friction", "gravity", "asymmetric", "ripple", "harmonics", "load_friction"}
    | {"per_recording", "terms"}
)
_FACTS = frozenset({"gear_ratio", "torque_constant", "rotor_inertia", "inertia"})
_TABLES = {
    **dict.fromkeys((*MODEL_FIELDS, "torque_offset"), "model"),
    **dict.fromkeys(
        ("inertia", "rotor_inertia", "gear_ratio", "torque_constant", "torque_hold"), "drive"
    ),
    "sensor": "sensor",
}
_VERBS = {
    "load": "load",
    "identify": "identify",
    "identify_robot": "identify",
    "compare_models": "compare",
    "compare_robot_models": "compare",
    "sweep": "sweep",
}
_VERBS |= {"simulate": "simulate", "export": "export", "design_excitation": "design"}
_UNKNOWN = {*PLACEHOLDERS.values(), *FILES.values(), *NUMBERS.values(), "VALUE", "NAME"}
"""Words in place of values that only the user knows."""
_WRITTEN = {"--report", "--save", "--model"}
"""Options that are not copied to another command that reads the same files."""


def words_of_action(action: Action, command: str, model: str = "", *, file: bool = False) -> str:
    """Return the advice in the words of a command; empty if the command line cannot follow it.

    Parameters
    ----------
    action : Action
    command : str
        Command that gives the advice.
    model : str
        Text of the command's ``--model``, to extend it. Default: not known.
    file : bool
        Whether the command has a joint file. A fact of the joint then belongs there. Default False.
    """
    if action.kind != "call":
        return str(action)
    if action.function in ("load", "load_robot", "identify_joints"):
        several = action.arguments.get("joints") == "all" and command != "identify"
        action = _of_reading(action, "identify" if several else "load")
    verb, options, joint_file = _parts(action, command, model, file=file)
    parts = [f"{verb} with {' '.join(options)}"] * bool(options)
    parts += [_in_joint_file(joint_file)] * bool(joint_file)
    purpose = f" ({action.text})" if action.text and parts else ""
    return " and ".join(parts) + purpose


def command_of_action(
    action: Action, command: str, typed: Sequence[str], model: str = "", *, file: bool = False
) -> str:
    """Return the typed command with the changes of the action; empty if no command can do it.

    Parameters
    ----------
    action : Action
    command : str
        Command that gives the advice.
    typed : sequence of str
        Words as they were typed, the command first.
    model, file
        As in `words_of_action`.
    """
    if action.kind != "call" or action.function == "Robot.from_urdf" or not typed:
        return ""
    if action.function in ("load", "load_robot", "identify_joints"):
        action = _of_reading(action, "load")
    verb, options, joint_file = _parts(action, command, model, file=file)
    words = [word for option in options for word in shlex.split(option)]
    if not words or joint_file:
        return ""
    if any(word in _UNKNOWN or word.partition("=")[2] in _UNKNOWN for word in words):
        return f"add {' '.join(words)}"
    if verb not in ("load", command):
        typed = _for_another(typed, command, verb)
    return f"jointid {shlex.join(with_options(typed, words))}" if typed else ""


def _for_another(typed: Sequence[str], command: str, verb: str) -> list[str]:
    """Return the words for another command that reads the same files; none if it reads nothing."""
    if verb not in ("identify", "compare") or command not in ("identify", "compare"):
        return []
    taken = set(OPTIONS[verb].values()) - _WRITTEN
    pairs = _pairs(typed[1:])
    kept = [
        words
        for words in pairs
        if not words[0].startswith("-") or words[0].partition("=")[0] in taken
    ]
    return [verb, *(word for pair in kept for word in pair if word is not None)]


def with_options(typed: Sequence[str], options: Sequence[str]) -> list[str]:
    """Return the words of a command with options added. They replace those with the same name and key."""
    added = _pairs(options)
    kept = [words for words in _pairs(typed) if not any(_same(words, *each) for each in added)]
    return [word for pair in (*kept, *added) for word in pair if word is not None]


def without_options(typed: Sequence[str], options: Sequence[str]) -> list[str]:
    """Return the words of a command without some options and their values."""
    kept = (pair for pair in _pairs(typed) if pair[0].partition("=")[0] not in options)
    return [word for pair in kept for word in pair if word is not None]


def _pairs(words: Sequence[str]) -> list[tuple[str, str | None]]:
    """Return each option with its value, if it has one, and each other word alone."""
    found: list[tuple[str, str | None]] = []
    rest = list(words)
    while rest:
        word = rest.pop(0)
        takes = word.startswith("--") and "=" not in word and word not in FLAGS
        found.append((word, rest.pop(0) if takes and rest else None))
    return found


def _same(words: tuple[str, str | None], option: str, value: str | None) -> bool:
    """Return whether these words are the same option, with the same key if it has keys."""
    name, _, behind = words[0].partition("=")
    stated = behind or words[1] or ""
    if name != option:
        return False
    return option not in PLACEHOLDERS or stated.partition("=")[0] == (value or "").partition("=")[0]


def _parts(
    action: Action, command: str, model: str, *, file: bool
) -> tuple[str, list[str], list[tuple[str, str, Any]]]:
    """Return the verb, the options, and joint file entries for arguments without an option."""
    by_option = not file and all(option_of(command, name)[0] for name in action.arguments)
    if action.function == "Joint" and not (by_option and action.arguments.keys() <= _FACTS):
        return "", [], list(_joint_fields(action.arguments))
    if action.function == "Joint":
        return "identify", *_arguments(action.arguments, command, model)
    if action.function not in _VERBS:
        return "", [], []
    other = {"load": "identify"} | {f"compare_{each}models": "compare" for each in ("", "robot_")}
    speaker = command
    if not _has_options(command, action.arguments):
        if command in ("simulate", "emulate", "report"):
            speaker = ""
        elif not all(name in (*_TABLES, "model", "parameters") for name in action.arguments):
            speaker = other.get(action.function, action.function)
    return _VERBS[action.function], *_arguments(action.arguments, speaker, model)


def _of_reading(action: Action, function: str) -> Action:
    """Return the action with `joint` as `--joints`, because `--joint` is a joint file."""
    names = {"joint": "joints"}
    arguments = {names.get(name, name): value for name, value in action.arguments.items()}
    return Action("call", arguments, action.text, function)


def option_with_value(option: str, key: str, value: Any) -> str:
    """Return an option with its value as it is typed, e.g. `--column velocity=none`."""
    placeholder = {**FILES, **NUMBERS, **PLACEHOLDERS}.get(option, "VALUE")
    if option == "--windows" and isinstance(value, float):
        value = f"{behind_option(value)}s"
    if option == "--rate" and isinstance(value, float):
        value = f"{1.0 / value:.6g}"
    if value is ... or value == "...":
        text = placeholder
    elif option in FLAGS and isinstance(value, bool):
        return option
    else:
        text = behind_option(value)
    return f"{option} {key}={text}" if key else f"{option} {text}"


def model_text(current: str, changes: Mapping[str, Any]) -> str:
    """Return the text of a model with some of its options changed; NAME if no name is known.

    Parameters
    ----------
    current : str
        Text of the model; may be empty.
    changes : mapping
        Fields of a model; false, empty and None remove an option.
    """
    name, *options = current.split(":")
    parts: dict[str, str] = {part.partition("=")[0]: part for part in options}
    for key, value in changes.items():
        if key in ("name", "friction"):
            name = str(value)
        elif value is None or value is False or value == ():
            parts.pop(key, None)
        else:
            parts[key] = key if value is True else f"{key}={behind_option(value)}"
    return ":".join([name or "NAME", *parts.values()])


def _has_options(command: str, arguments: Mapping[str, Any]) -> bool:
    return all(
        option_of(command, "model" if name in MODEL_FIELDS else name)[0]
        for name, _ in _flat(arguments)
    )


def _flat(arguments: Mapping[str, Any]) -> Iterator[tuple[str, Any]]:
    """Yield the arguments by name. Options of a search are split into their fields."""
    for name, value in arguments.items():
        if name not in ("search", "ga") or isinstance(value, str):
            yield "method" if name == "search" else name, value
            continue
        for key, entry in _changed(value).items():
            if key == "ga" and not isinstance(entry, str):
                yield from ((f"ga.{inner}", each) for inner, each in _changed(entry).items())
            else:
                yield f"ga.{key}" if name == "ga" else key, entry


def _changed(value: Any) -> dict[str, Any]:
    """Return the fields of a value that differ from its defaults."""
    if isinstance(value, Mapping):
        return dict(value)
    if is_dataclass(value) and not isinstance(value, type):
        usual = type(value)()
        pairs = ((f.name, getattr(value, f.name)) for f in fields(value))
        return {name: entry for name, entry in pairs if entry != getattr(usual, name)}
    usual = type(value)().asdict()
    return {name: entry for name, entry in value.asdict().items() if entry != usual[name]}


def _arguments(
    arguments: Mapping[str, Any], command: str, model: str
) -> tuple[list[str], list[tuple[str, str, Any]]]:
    """Return the options, and entries of the joint file (table, key, value) for arguments without an option."""
    options: list[str] = []
    joint_file: list[tuple[str, str, Any]] = []
    changes: dict[str, Any] = {}
    for name, value in _flat(arguments):
        if name in MODEL_FIELDS:
            changes[name] = value
        elif name == "model" and isinstance(value, Mapping) and not set(value) <= MODEL_FIELDS:
            options.append(shlex.join([option_of(command, name)[0], text_by_joint(value)]))
        elif name == "model" and isinstance(value, Mapping):
            changes |= value
        elif name == "model":
            changes |= _read_model(str(value))
        elif name == "parameters":
            for key, entry in value.items():
                _parameter(key, entry, option_of(command, name)[0], options, joint_file)
        elif option := option_of(command, name)[0]:
            if isinstance(value, Mapping):
                options += [  # a delay for each joint has no option
                    option_with_value(option, key, entry)
                    for key, entry in value.items()
                    if not isinstance(entry, Mapping)
                ]
            elif name == "models" and not isinstance(value, str):
                options += [f"{option} {model}" for model in value]
            else:
                options.append(option_with_value(option, "", value))
        else:
            joint_file += [(table, name, value) for table in _TABLES.get(name, "").split()]
    if changes and (option := option_of(command, "model")[0]):
        options.insert(0, f"{option} {model_text(model, changes)}")
    else:
        joint_file += list(_joint_fields(changes))
    return options, joint_file


def _read_model(text: str) -> dict[str, Any]:
    name, *options = text.split(":")
    read: dict[str, Any] = {"name": name} if name else {}
    for option in options:
        key, separator, value = option.partition("=")
        numbers = tuple(number_or_text(part) for part in value.split(","))
        plain = any(isinstance(number, str) for number in numbers)
        read[key] = (value if plain else numbers) if separator else True
    return read


def _parameter(
    name: str, entry: Any, option: str, options: list[str], joint_file: list[tuple[str, str, Any]]
) -> None:
    """Add --set for a value; use the joint file for bounds, or if the command has no --set."""
    if not isinstance(entry, Mapping):
        entry = {"value": entry}
    if option and entry.keys() == {"value"}:
        options.append(option_with_value(option, name, entry["value"]))
    else:
        joint_file += [(f"parameters.{name}", key, value) for key, value in entry.items()]


def _joint_fields(arguments: Mapping[str, Any]) -> Iterator[tuple[str, str, Any]]:
    for name, value in arguments.items():
        if name == "model" and isinstance(value, str):
            yield from _joint_fields(_read_model(value))
        elif name == "parameters":
            for parameter, entry in value.items():
                pairs = entry.items() if isinstance(entry, Mapping) else [("value", entry)]
                yield from ((f"parameters.{parameter}", key, each) for key, each in pairs)
        elif isinstance(value, Mapping):  # a separate table, e.g. link
            yield from ((name, key, entry) for key, entry in value.items())
        else:
            key = {"name": "friction", "sensor": "present"}.get(name, name)
            yield _TABLES.get(name, ""), key, _of_file(name, value)


def _of_file(name: str, value: Any) -> Any:
    """Return a field of a model as words, as in the model's text."""
    if name in ("asymmetric", "load_friction") and value in ("true", "false"):
        return value == "true"
    return () if name in ("ripple", "harmonics") and value == "none" else value


def _in_joint_file(entries: list[tuple[str, str, Any]]) -> str:
    """Return the changes of the joint file as text: entries to write, table by table, and entries to remove."""
    if entries == [("sensor", "present", False)]:  # an empty table only states that there is one
        return "delete [sensor] from the joint file"
    tables: dict[tuple[bool, str], list[str]] = {}
    for table, key, value in entries:
        text = "VALUE" if value is ... or value == "..." else in_joint_file(value)
        line = key if value is None else f"{key} = {text}"
        tables.setdefault((value is None, table), []).append(line)
    parts = [
        f"{'remove' if removed else 'set'} {' and '.join(lines)}{f' under [{table}]' if table else ''}"
        for (removed, table), lines in tables.items()
    ]
    return f"{' and '.join(parts)} in the joint file"
