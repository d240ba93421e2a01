"""The command line: `jointid demo | identify | compare | simulate | sweep | run | emulate | report | info`."""

from __future__ import annotations

import sys
import traceback
from collections.abc import Sequence

from jointid.base.errors import InputError
from jointid.cli.outputs import check_distinct
from jointid.cli.parser import BAD_USAGE, command_parser
from jointid.cli.wording import Wording

DONE, BAD_INPUT, BUG, INTERRUPTED = 0, BAD_USAGE, 70, 130


def main(argv: Sequence[str] | None = None) -> int:
    """Run the command line.

    Parameters
    ----------
    argv : sequence of str, optional
        Default: those of the process.

    Returns
    -------
    int
        The exit code: 0 done, 2 bad input, 3 a session stopped or refused, 70 a bug of jointid,
        130 interrupted by Ctrl-C.
    """
    _show_every_character()
    grammar = command_parser()
    arguments = grammar.parse_args(argv)
    if arguments.version:
        from jointid import __version__

        print(f"jointid {__version__}")
        return DONE
    if arguments.command is None:
        grammar.print_help()
        return DONE
    from jointid.cli.commands import COMMANDS

    try:
        check_distinct(arguments)
        code = COMMANDS[arguments.command](arguments)
    except KeyboardInterrupt as stop:
        reason = f": {stop}" if str(stop) else ""
        print(f"jointid: interrupted{reason}", file=sys.stderr)
        return INTERRUPTED
    except BrokenPipeError:  # the reader of our output left: not our failure
        sys.stderr.close()
        return DONE
    except InputError as error:
        sentence = Wording.of(arguments).of_error(error)
        print(f"jointid {arguments.command}: {sentence}", file=sys.stderr)
        return BAD_INPUT
    except Exception as error:
        if isinstance(error, OSError) and error.filename is not None:  # a file of the user's
            reason = error.strerror or str(error)
            print(f"jointid {arguments.command}: {error.filename}: {reason}", file=sys.stderr)
            return BAD_INPUT
        traceback.print_exception(error)
        print(
            f"jointid {arguments.command}: this is a bug in jointid, not bad input; please report it "
            "with the lines above",
            file=sys.stderr,
        )
        return BUG
    return DONE if code is None else int(code)


def _show_every_character() -> None:
    """A terminal or pipe without √ or ± shows a question mark; it is no reason to lose a result."""
    for stream in (sys.stdout, sys.stderr):
        reconfigure = getattr(stream, "reconfigure", None)  # a stream put in its place has none
        if reconfigure is not None:
            reconfigure(errors="replace")
