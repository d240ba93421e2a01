"""The command line: `jointid demo | identify | compare | simulate | sweep | design | run | emulate | report | info`."""

from __future__ import annotations

import errno
import select
import sys
import traceback
from collections.abc import Sequence

from jointid.base.errors import InputError
from jointid.base.interruption import INTERRUPTED, raise_on_interruption
from jointid.cli.outputs import check_distinct
from jointid.cli.parser import BAD_USAGE, command_parser
from jointid.cli.wording import Wording

# Errors of a disk, which name no file when they are raised by a write.
_DISK = {errno.ENOSPC, errno.EIO, errno.EROFS, errno.EFBIG, getattr(errno, "EDQUOT", -1)}
DONE, BAD_INPUT, BUG = 0, BAD_USAGE, 70


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
    try:
        from jointid.cli.commands import COMMANDS

        raise_on_interruption()
        check_distinct(arguments)
        code = COMMANDS[arguments.command](arguments)
    except KeyboardInterrupt as stop:
        reason = f": {stop}" if str(stop) else ""
        print(f"jointid: interrupted{reason}", file=sys.stderr)
        return INTERRUPTED
    except InputError as error:
        sentence = Wording.of(arguments).of_error(error)
        print(f"jointid {arguments.command}: {sentence}", file=sys.stderr)
        return BAD_INPUT
    except Exception as error:
        if isinstance(error, BrokenPipeError) and _reader_left():
            sys.stderr.close()  # the reader of our output left: not our failure
            return DONE
        if isinstance(error, OSError) and (error.filename is not None or error.errno in _DISK):
            reason = error.strerror or str(error)
            place = "the output" if error.filename is None else str(error.filename)
            print(f"jointid {arguments.command}: {place}: {reason}", file=sys.stderr)
            return BAD_INPUT
        traceback.print_exception(error)
        notes = "; ".join(getattr(error, "__notes__", ()))
        print(
            f"jointid {arguments.command}: this is an error in the program, not bad input; please "
            f"report it with the lines above{f' ({notes})' if notes else ''}",
            file=sys.stderr,
        )
        return BUG
    return DONE if code is None else int(code)


def _reader_left() -> bool:
    """Whether it is our own output that nobody reads any more, not another pipe."""
    try:
        pipe = select.poll()
        pipe.register(sys.stdout.fileno(), select.POLLERR)
        return any(event & select.POLLERR for _, event in pipe.poll(0))
    except (AttributeError, OSError, ValueError):  # no poll on this system; no file behind stdout
        return True


def _show_every_character() -> None:
    """A terminal or pipe without √ or ± shows a question mark; it is no reason to lose a result."""
    for stream in (sys.stdout, sys.stderr):
        reconfigure = getattr(stream, "reconfigure", None)  # a stream put in its place has none
        if reconfigure is not None:
            reconfigure(errors="replace")
