"""Ctrl-C while the command line is being imported: one line and exit code 130, no traceback.

An exception is of no use there: it ends in a traceback of whichever package is being imported, and some packages
make another error of it. Nothing is at work yet that would have to be finished.
"""

import os
import signal
import sys

INTERRUPTED = 130
_NAME = "jointid"


def exit_on_interruption() -> None:
    """Let Ctrl-C end the process, if it is the command line; a program that imports us is left alone."""
    if not _is_command_line() or signal.getsignal(signal.SIGINT) is not signal.default_int_handler:
        return
    try:
        signal.signal(signal.SIGINT, _exit)
    except ValueError:  # not the main thread
        return


def raise_on_interruption() -> None:
    """Let Ctrl-C raise a KeyboardInterrupt again, as soon as a command can deal with it."""
    if signal.getsignal(signal.SIGINT) is _exit:
        signal.signal(signal.SIGINT, signal.default_int_handler)


def _is_command_line() -> bool:
    """Whether this process is `jointid` or `python -m jointid`."""
    if (
        "--multiprocessing-fork" in sys.orig_argv
    ):  # a process of its own, with the arguments of the first
        return False
    started = sys.argv[0] if sys.argv else ""
    if started == "-m":  # Python is still looking for the module, in the package that imports this
        return any(each in (_NAME, f"-m{_NAME}") for each in sys.orig_argv)
    name, _ = os.path.splitext(os.path.basename(started))  # noqa: PTH119, PTH122 (pathlib takes long)
    return name == _NAME


def _exit(*_: object) -> None:
    """Leave at once; no exception that an import could swallow."""
    os.write(2, b"jointid: interrupted\n")
    os._exit(INTERRUPTED)
