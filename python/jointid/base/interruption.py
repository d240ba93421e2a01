"""Ctrl-C during the import of the command line: one line and exit code 130, no traceback.

An exception would end in a traceback of the package that is being imported, and some packages convert it to another
error. No work has begun that must be finished.
"""

import os
import signal
import sys

INTERRUPTED = 130
_NAME = "jointid"


def exit_on_interruption() -> None:
    """Let Ctrl-C end the process of the command line; programs that import the package are not affected."""
    if not _is_command_line() or signal.getsignal(signal.SIGINT) is not signal.default_int_handler:
        return
    try:
        signal.signal(signal.SIGINT, _exit)
    except ValueError:  # not the main thread
        return


def raise_on_interruption() -> None:
    """Let Ctrl-C raise a KeyboardInterrupt again, once a command can handle it."""
    if signal.getsignal(signal.SIGINT) is _exit:
        signal.signal(signal.SIGINT, signal.default_int_handler)


def _is_command_line() -> bool:
    """Whether this process is `jointid` or `python -m jointid`."""
    if (
        "--multiprocessing-fork" in sys.orig_argv
    ):  # a child process with the arguments of its parent
        return False
    started = sys.argv[0] if sys.argv else ""
    if started == "-m":  # the module is still being searched
        return any(each in (_NAME, f"-m{_NAME}") for each in sys.orig_argv)
    name, _ = os.path.splitext(os.path.basename(started))  # noqa: PTH119, PTH122 (pathlib takes long)
    return name == _NAME


def _exit(*_: object) -> None:
    """Exit at once, without an exception that an import could swallow."""
    os.write(2, b"jointid: interrupted\n")
    os._exit(INTERRUPTED)
