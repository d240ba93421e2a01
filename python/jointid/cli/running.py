"""Run of one command, up to its exit code, whatever ends it."""

from __future__ import annotations

import argparse
import errno
import select
import sys
from importlib import import_module

from jointid.base.errors import InputError
from jointid.base.interruption import INTERRUPTED, raise_on_interruption
from jointid.cli.command_table import runner_of
from jointid.cli.exit_codes import BAD_INPUT, BUG, DONE

# Errors of a disk. They name no file if a write raises them.
_DISK = {errno.ENOSPC, errno.EIO, errno.EROFS, errno.EFBIG, getattr(errno, "EDQUOT", -1)}


def run_command(arguments: argparse.Namespace) -> int:
    """Run the command of a parsed command line.

    Returns
    -------
    int
        Exit code.
    """
    try:
        from jointid.cli.outputs import check_distinct

        run = runner_of(arguments.command)
        import_module("numpy")  # every command needs it; its import hides Ctrl-C in another error
        raise_on_interruption()
        check_distinct(arguments)
        code = run(arguments)
    except KeyboardInterrupt as stop:
        reason = f": {stop}" if str(stop) else ""
        print(f"jointid: interrupted{reason}", file=sys.stderr)
        return INTERRUPTED
    except InputError as error:
        from jointid.cli.wording import Wording

        sentence = Wording.of(arguments).of_error(error)
        print(f"jointid {arguments.command}: {sentence}", file=sys.stderr)
        return BAD_INPUT
    except Exception as error:
        if isinstance(error, BrokenPipeError) and _reader_left():
            sys.stderr.close()  # the reader of the output has ended; this is no failure
            return DONE
        if isinstance(error, OSError) and (error.filename is not None or error.errno in _DISK):
            reason = error.strerror or str(error)
            place = "the output" if error.filename is None else str(error.filename)
            print(f"jointid {arguments.command}: {place}: {reason}", file=sys.stderr)
            return BAD_INPUT
        import traceback

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
    """Return whether the reader of our own output has ended, and not that of another pipe."""
    try:
        pipe = select.poll()
        pipe.register(sys.stdout.fileno(), select.POLLERR)
        return any(event & select.POLLERR for _, event in pipe.poll(0))
    except (AttributeError, OSError, ValueError):  # no poll on this system, or stdout is no file
        return True
