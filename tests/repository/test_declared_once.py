"""What `identify` takes is declared in one place; signatures, command line and app follow from it."""

import ast
import dataclasses
import inspect
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest
from documents import ROOT

import jointid as jid
from jointid.base.options import options_of
from jointid.cli.options import DECLARED, OPTIONS
from jointid.cli.parser import command_parser
from jointid.identification.options import CompareOptions, IdentifyOptions
from jointid.online.options import OnlineOptions
from jointid.problem.settings import ProblemOptions, Settings
from jointid.robot.options import RobotFitOptions, RobotOptions

PACKAGE = ROOT / "python" / "jointid"
OF_DESIGNS = {"parameters", "search"}  # a design has such options of its own
TAKERS: list[tuple[Callable[..., Any], type]] = [
    (jid.identify, IdentifyOptions),
    (jid.identify_joints, IdentifyOptions),
    (jid.sweep, IdentifyOptions),
    (jid.compare_models, CompareOptions),
    (jid.OnlineIdentifier, OnlineOptions),
    (jid.identify_robot, RobotOptions),
    (jid.compare_robot_models, RobotFitOptions),
]


def spelled(path: Path) -> Iterator[str]:
    """Functions of a file that give two of the options a default of their own."""
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.FunctionDef):
            plain = [*node.args.posonlyargs, *node.args.args]
            stated = plain[len(plain) - len(node.args.defaults) :]
            pairs = zip(node.args.kwonlyargs, node.args.kw_defaults, strict=True)
            stated += [argument for argument, default in pairs if default is not None]
            found = {each.arg for each in stated} & options_of(IdentifyOptions).keys()
            if len(found) > 1 and found != OF_DESIGNS:
                yield f"{path.relative_to(ROOT)}: {node.name}"


def test_no_other_signature_repeats_the_options() -> None:
    assert [each for path in sorted(PACKAGE.rglob("*.py")) for each in spelled(path)] == []


def test_the_settings_are_the_options() -> None:
    fields = {field.name for field in dataclasses.fields(Settings)}
    assert fields == options_of(ProblemOptions).keys() - {"terms"}  # they are in the model


@pytest.mark.parametrize(("taker", "options"), TAKERS, ids=lambda each: each.__name__)
def test_who_takes_options_shows_them(taker: Callable[..., Any], options: type) -> None:
    shown = inspect.signature(taker).parameters
    text = inspect.cleandoc(taker.__doc__ or "")
    for name, option in options_of(options).items():
        assert shown[name].default == option.default
        assert f"\n{name} : {option.kind}\n    {option.help.split()[0]} " in text


@pytest.mark.parametrize("command", ["identify", "compare", "sweep"])
def test_the_command_line_has_those_with_a_flag(command: str) -> None:
    (commands,) = command_parser(command)._subparsers._group_actions  # type: ignore[union-attr]
    parser = commands.choices[command]  # type: ignore[index]
    parser.complete()
    help_of = {action.dest: action.help for action in parser._actions}
    assert len(DECLARED) > 5
    for name, option in DECLARED.items():
        assert help_of[name] == option.phrase
        assert OPTIONS[command][name] == option.flag
