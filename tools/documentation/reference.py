"""Reference pages written from the code: the commands' options, the files, the public names."""

from __future__ import annotations

import argparse
import re
from collections.abc import Iterator, Mapping

import jointid as jid
from documentation.bench_file import bench_file_page
from documentation.numpydoc import Described, described
from documentation.public_names import GROUPS
from documentation.staging import Stage
from documentation.wording import definition, escaped, kind_in_toml, markdown, sentence
from jointid.cli.command_table import HELP
from jointid.cli.parser import command_parser
from jointid.joint import joint_file
from jointid.joint.tolerances import Tolerances
from jointid.joint.voltage_drive import INPUTS, VoltageDrive


def write_reference(stage: Stage) -> None:
    """Write all reference pages."""
    stage.write("reference/options.md", options_page())
    stage.write("reference/joint_file.md", joint_file_page())
    stage.write("reference/bench_file.md", bench_file_page())
    stage.write("reference/api/index.md", _names_page())
    for group in GROUPS:
        stage.write(f"reference/api/{group.file}.md", group.page())


# --- The command line ---


def options_page() -> str:
    """Return every option of every command, from the parser."""
    lines = [
        "# Options of each command",
        "",
        "Written from the parser: what `jointid COMMAND --help` says. What the commands do together, and examples: "
        "[command line](../command_line.md).",
        "",
    ]
    for name, parser in _parsers().items():
        lines += [f"## jointid {name}", "", f"{sentence(HELP[name])}", ""]
        parser.format_help()  # some help is only computed when it is requested
        for group in parser._action_groups:
            lines += [line for action in group._group_actions for line in _option(action)]
        if parser.epilog:
            examples, rest = _epilog(parser.epilog)
            lines += ["```sh", *examples, "```", "", *([sentence(rest), ""] if rest else [])]
    return "\n".join(lines)


def _parsers() -> Mapping[str, argparse.ArgumentParser]:
    (commands,) = (
        action
        for action in command_parser()._actions
        if isinstance(action, argparse._SubParsersAction)
    )
    for parser in commands.choices.values():
        parser.complete()
    return dict(commands.choices)


def _option(action: argparse.Action) -> Iterator[str]:
    """Return a definition: the option, and its meaning."""
    if action.dest == "help":
        return
    value = action.metavar or (action.dest.upper() if action.nargs != 0 else "")
    typed = value if isinstance(value, str) else " ".join(value)
    names = ", ".join(action.option_strings)
    help_ = (action.help or "").replace("%%", "%")
    help_ = re.sub(r"%\((\w+)\)s", lambda found: str(getattr(action, found[1], "")), help_)
    yield f"`{f'{names} {typed}'.strip()}`"
    yield f": {escaped(sentence(help_))}"
    yield ""


def _epilog(text: str) -> tuple[list[str], str]:
    """Return the example lines, and the text after them."""
    lines = [line.strip() for line in text.splitlines()]
    examples = [line for line in lines if line.startswith("jointid ")]
    rest = [
        line
        for line in lines
        if line and line not in examples and not re.match(r"examples?:$", line)
    ]
    return examples, " ".join(rest)


# --- The joint file ---

_TABLES = {
    "": "At the top of the file.",
    "drive": "What is known of motor and gear.",
    "model": "The terms of the torque balance. A table that is missing leaves the choice to `identify`.",
    "sensor": "The joint has a torque sensor.",
    "link": "The link that the joint moves.",
    "parameters": "A table for each parameter, `[parameters.coulomb]`, or a number: its value.",
    "limits": "What the joint must not exceed.",
    "tolerances": 'How well the given facts are known: a share such as `"5 %"`, or a number in the fact\'s unit.',
}
_KEPT = {
    "estimate": "Where the values come from; `estimate.save` writes it.",
    "session": "The settings of the joint's bench: [bench file](bench_file.md).",
    "user": "Yours: nothing reads it, and it is kept.",
}
_OWN = {
    ("", "schema"): Described(
        "int", f"Version of the format: {joint_file.SCHEMA}; required. Older ones are read."
    ),
    ("drive", "input"): Described(
        "str",
        f"{' or '.join(INPUTS)}: what the log has of the drive. Default torque. The keys below are of a voltage.",
    ),
    ("sensor", "present"): Described("bool", "Default true, where the table is there."),
}


def joint_file_page() -> str:
    """Return every key of a joint file, from the reader and the docstrings of its classes."""
    joint = described(jid.Joint)
    model = described(jid.Model)
    texts: dict[str, Mapping[str, Described]] = {
        "": joint,
        "drive": described(VoltageDrive) | dict(joint),
        "model": model | {"friction": model["name"], "torque_offset": joint["torque_offset"]},
        "sensor": {},
        "link": described(jid.Link),
        "parameters": {
            name: each for name, each in described(jid.Parameter).items() if name != "name"
        },
        "limits": described(jid.Limits),
        "tolerances": described(Tolerances),
    }
    keys = {"": joint_file._TOP} | dict(joint_file._KEYS)
    keys["parameters"] = tuple(texts["parameters"])
    lines = [
        "# Joint file",
        "",
        "A joint file is TOML. Everything but `schema` is optional; a key that is not known is an error that says what "
        'is near. Angles may be texts: `"60deg"`. Written from the code that reads it. An example with comments: '
        "[the joint, in the guide](../guide.md#the-joint).",
        "",
    ]
    for table, names in keys.items():
        title = f"`[{table}]`" if table else "Top"
        lines += [f"## {title}", "", _TABLES[table], ""]
        for name in names:
            entry = _OWN.get((table, name)) or texts[table][name]
            text = markdown(entry.text) or "See the guide."
            lines += definition(name, kind_in_toml(entry.kind), text)
    lines += ["## Other tables", ""]
    for name in joint_file._KEPT:
        lines += [f"`[{name}]`", f": {_KEPT[name]}", ""]
    return "\n".join(lines)


# --- Public names ---


def _names_page() -> str:
    lines = ["# Python", "", "`import jointid as jid`. Names by what they are for.", ""]
    for group in GROUPS:
        names = ", ".join(f"`{name.removeprefix('jointid.')}`" for name in group.first)
        lines += [
            f"[{group.title}]({group.file}.md)",
            f": {names or 'what they take and return'}",
            "",
        ]
    lines += ["```{toctree}", ":hidden:", "", *(group.file for group in GROUPS), "```", ""]
    return "\n".join(lines)
