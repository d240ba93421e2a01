"""What the command line answers: its exit code, Python in its sentences, the options that they advise."""

import argparse
import re

import pytest

from jointid.cli.command_line import main
from jointid.cli.options import FILES, FLAGS, PLACEHOLDERS
from jointid.cli.parser import command_parser

PYTHON = re.compile(
    r"\{'|=\(|=\{|\['|\(\)|\b(?:True|False|None|argument|arguments|positional|keyword)\b"
    r"|\b(?:jid|jointid|_core)\.[A-Za-z]|<class|\bobject at 0x|\b[A-Z][a-z]+(?:[A-Z][a-z]+)+\b"
    r"|(?<![-\w=,:{} ])['\"]\w+['\"]=|Error\b|\bNOT_GIVEN\b"
)
# name=value that is no option's: a Python keyword. Options, and paths of a grid, stand behind `--…`.
KEYWORD = re.compile(r"(?:^|[\s(])([a-z_]+)=(?=[\w'\"({\[.,;)]|$)")
OPTION = re.compile(r"(--[a-z][a-z-]+)((?: (?!--|or\b|and\b|with\b)(?:[^\s;,:)(]|[:,](?=\S))+)?)")
# In these options values of the form name=value stand.
NAMED = re.compile(r"--(?:column|unit|scale|where|set|gain|sensor|grid|trajectory|model|prior) \S+")


def answer(line: list[str], capsys: pytest.CaptureFixture[str]) -> tuple[int, str]:
    """Exit code and standard error."""
    try:
        code = main(line)
    except SystemExit as ended:  # the grammar's own refusals
        code = int(str(ended.code))
    return code, capsys.readouterr().err


def python_in(sentence: str) -> str:
    """What in a sentence is Python's, or nothing."""
    found = PYTHON.search(sentence) or KEYWORD.search(NAMED.sub("", sentence))
    return found[0] if found else ""


def commands() -> dict[str, argparse.ArgumentParser]:
    """The parsers by command."""
    (action,) = (
        each for each in command_parser()._actions if isinstance(each, argparse._SubParsersAction)
    )
    for parser in action.choices.values():
        parser.complete()
    return dict(action.choices)


def obeyed(line: list[str], options: list[str]) -> list[str]:
    """A command line with the advice followed: a NAME=VALUE replaces the one of the same name."""
    given = {word.partition("=")[0] for word in options if "=" in word}
    kept: list[str] = []
    for word in line:
        if "=" in word and word.partition("=")[0] in given and kept[-1] in PLACEHOLDERS:
            kept.pop()
        else:
            kept.append(word)
    return [*kept, *options]


def advised(sentence: str, line: list[str], fill: dict[str, str]) -> list[list[str]]:
    """The alternatives that a sentence advises, each as the options to add."""
    alternatives = []
    for part in re.split(r" or |; |, ", sentence):
        if "designed by jointid" in part:  # a command of its own
            continue
        options: list[str] = []
        for option, text in OPTION.findall(part):
            value = text.strip()
            typed = any(option == word for word in line) and (not value or value in line)
            if typed:  # the sentence repeats what was typed
                continue
            if not value and option not in FLAGS:
                value = fill.get(option, "")
            elif option in fill and value.isupper():
                value = fill[option]
            for placeholder in {*PLACEHOLDERS.values(), *FILES.values(), "NAME"}:
                value = re.sub(rf"\b{placeholder}\b", fill.get(placeholder, placeholder), value)
            options += [option, *([value.strip("'")] if value else [])]
        if options:
            alternatives.append(options)
    return alternatives
