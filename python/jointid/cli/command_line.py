"""Command line: `jointid demo | new | identify | compare | simulate | sweep | design | run | report | info | …`.

The content of `jointid --help` is here and in the table of commands. Each command imports the rest when it runs.
"""

from __future__ import annotations

import atexit
import gc
import sys
from collections.abc import Sequence

from jointid.cli.exit_codes import DONE
from jointid.cli.parser import command_parser

_SELDOM = 50_000  # objects between two garbage collections of the youngest; Python's default is 700


def main(argv: Sequence[str] | None = None) -> int:
    """Run the command line.

    Parameters
    ----------
    argv : sequence of str, optional
        Arguments. Default: those of the process.

    Returns
    -------
    int
        The exit code: 0 done, 2 bad input, 3 a session stopped or refused, 4 a verdict worse
        than `--require` asks for, 70 a bug of jointid,
        130 interrupted by Ctrl-C.
    """
    _show_every_character()
    if sys.stdout.isatty() or sys.stderr.isatty():
        from jointid.cli.terminal import fit_streams

        fit_streams()
    # Imported objects stay. To search them for garbage would take a tenth of a short command's time.
    gc.set_threshold(_SELDOM, *gc.get_threshold()[1:])
    atexit.register(gc.freeze)
    words = sys.argv[1:] if argv is None else argv
    grammar = command_parser(words[0] if words else "")
    arguments = grammar.parse_args(words)
    if arguments.version:
        from jointid import __version__

        print(f"jointid {__version__}")
        return DONE
    if arguments.command is None:
        grammar.print_help()
        return DONE
    from jointid.cli.running import run_command

    arguments.typed = tuple(words)
    return run_command(arguments)


def _show_every_character() -> None:
    """Show a question mark if the terminal or pipe has no √ or ±, so that a missing character loses no result."""
    for stream in (sys.stdout, sys.stderr):
        reconfigure = getattr(stream, "reconfigure", None)  # a substituted stream has none
        if reconfigure is not None:
            reconfigure(errors="replace")
