"""Parser of the command line: all commands at once, the options of a command when it is called."""

from __future__ import annotations

import argparse
import os
import re

from jointid.cli.command_table import HELP, options_of
from jointid.cli.exit_codes import BAD_INPUT

TYPE_CHECKING = False  # as in typing, which `jointid --help` does not import
if TYPE_CHECKING:
    from collections.abc import Callable, Sequence
    from typing import Any, NoReturn

# Replacements for argparse's messages, which use a programmer's terms.
_PLAIN = {
    "the following arguments are required:": "missing:",
    "expected one argument": "a value is expected",
    "expected at least one argument": "a value is expected",
}


def _formatter(prog: str) -> argparse.HelpFormatter:
    """Return a formatter as wide as the terminal. argparse's own is slow, because shutil imports lzma."""
    try:
        columns = int(os.environ.get("COLUMNS", 0)) or os.get_terminal_size(1).columns
    except (OSError, ValueError):  # no terminal; no number
        columns = 0
    return argparse.RawDescriptionHelpFormatter(prog, width=(columns or 80) - 2)


# Options of another command, with a hint for this one.
_ELSEWHERE = {
    "--by": "read one run with --where COLUMN=VALUE; only identify has --by, for the runs of a servo"
}
_NEGATIVE = re.compile(
    r"-\.?\d"
)  # -1, -.5, -60deg,60deg are values, because no option begins with a digit


class CommandParser(argparse.ArgumentParser):
    """Parser that reports bad usage in one line. The options of a command are added when they are needed.

    Parameters
    ----------
    command : str
        Command; its options are added later. Default: no options to add.
    **options
        Options of `argparse.ArgumentParser`.
    """

    def __init__(self, command: str = "", **options: Any) -> None:
        # Without abbreviations: the file --joint must not be read as --joints in a command that has only this one.
        plain = {"formatter_class": _formatter, "exit_on_error": False, "allow_abbrev": False}
        super().__init__(**options | plain)
        self._negative_number_matcher = _NEGATIVE
        self._command = command
        self._later: list[tuple[argparse.Action, Callable[[], str]]] = []

    def complete(self) -> None:
        """Add the options of the command, once."""
        command, self._command = self._command, ""
        if command:
            options_of(command)(self)

    def help_later(self, option: argparse.Action, text: Callable[[], str]) -> None:
        """Set the function that returns the help of an option when it is requested."""
        self._later.append((option, text))

    def format_help(self) -> str:
        """Return the help of the command."""
        for option, text in self._later:
            option.help = text()
        return super().format_help()

    def parse_known_args(self, args: Any = None, namespace: Any = None) -> Any:
        """Read arguments. Report errors in one line."""
        self.complete()
        try:
            known, unknown = super().parse_known_args(args, namespace)
        except argparse.ArgumentError as error:
            if error.argument_name == "COMMAND":
                self.error(self._unknown_command(args))
            self.error(": ".join(filter(None, (error.argument_name, error.message))))
        if unknown:  # reported here, where the command and its options are known
            self.error(self._unknown(unknown))
        return known, unknown

    def _unknown_command(self, arguments: Sequence[str]) -> str:
        """Return the message about a word that is not a command."""
        from jointid.recording.signals import closest

        word = next((each for each in arguments if not each.startswith("-")), "")
        close = closest(word, HELP)
        known = f"did you mean {close}?" if close else f"there are {', '.join(HELP)}"
        return f"there is no command {word}; {known}"

    def _unknown(self, arguments: list[str]) -> str:
        """Return the message about arguments that no option takes; if there are options, about the first."""
        from jointid.recording.signals import closest

        for argument in arguments:
            if argument.startswith("--"):
                option = argument.partition("=")[0]
                if option in _ELSEWHERE:
                    return f"there is no option {option}; {_ELSEWHERE[option]}"
                known = self._option_string_actions
                begun = [each for each in known if each.startswith(option)]
                close = begun[0] if len(begun) == 1 else closest(option, known, cutoff=0.8)
                return f"there is no option {option}" + (
                    f"; did you mean {close}?" if close else ""
                )
        return f"unknown: {' '.join(arguments)}"

    def error(self, message: str) -> NoReturn:
        """Exit with a message of one line on bad usage."""
        sentence = " ".join(message.split())
        for phrase, plain in _PLAIN.items():
            sentence = sentence.replace(phrase, plain)
        self.exit(BAD_INPUT, f"{self.prog}: {sentence}; see {self.prog} --help\n")


def command_parser(command: str = "") -> CommandParser:
    """Return the grammar of the command line.

    Parameters
    ----------
    command : str
        The only command that will be read, if it is known. The parsers of the other commands are then left out,
        because creating them takes as long as reading this one. By default, and if it is not a command's name, all
        are created.
    """
    main_parser = CommandParser(
        prog="jointid",
        description="Identify a robot joint's friction and torque sensor from a recording of ordinary motion.",
        epilog="example:\n  jointid identify run.csv --joint joint.toml --report report.html",
    )
    main_parser.add_argument("--version", action="store_true", help="print the version and exit")
    commands = main_parser.add_subparsers(
        dest="command", metavar="COMMAND", parser_class=CommandParser
    )
    for name in (command,) if command in HELP else HELP:
        commands.add_parser(name, help=HELP[name], command=name)
    return main_parser
