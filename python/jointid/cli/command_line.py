"""The command line: `jointid demo | identify | compare | simulate | sweep | run | emulate | report | info`."""

from __future__ import annotations

import sys
from collections.abc import Sequence

from jointid.cli.arguments import BAD_USAGE, check_distinct, parser

DONE, BAD_INPUT, INTERRUPTED = 0, BAD_USAGE, 130


def main(argv: Sequence[str] | None = None) -> int:
    """Run the command line; returns the exit code (0 done, 2 bad input, 3 stopped, 130 on Ctrl-C)."""
    grammar = parser()
    arguments = grammar.parse_args(argv)
    if arguments.version:
        from jointid import __version__

        print(f"jointid {__version__}")
        return DONE
    if arguments.command is None:
        grammar.print_help()
        return DONE
    from jointid.cli import commands as cli_commands

    try:
        check_distinct(arguments)
        code = getattr(cli_commands, arguments.command)(arguments)
    except KeyboardInterrupt as stop:
        told = f": {stop}" if str(stop) else ""
        print(f"jointid: interrupted{told}", file=sys.stderr)
        return INTERRUPTED
    except BrokenPipeError:  # the reader of our output left: not our failure
        sys.stderr.close()
        return DONE
    except (ValueError, TypeError, OSError) as error:
        print(f"jointid {arguments.command}: {_one_line(error)}", file=sys.stderr)
        return BAD_INPUT
    return DONE if code is None else int(code)


def _one_line(error: Exception) -> str:
    if isinstance(error, OSError) and error.filename is not None:
        return f"{error.filename}: {error.strerror}"
    from jointid.cli.words import spoken

    return spoken(" ".join(str(error).split()))
