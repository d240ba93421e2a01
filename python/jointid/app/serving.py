"""The program: a server on this machine alone, whose address holds a token."""

from __future__ import annotations

import socket
import threading
import time
from collections.abc import Callable
from contextlib import closing

from jointid.app.call import Call
from jointid.base.errors import InputError

LARGEST = 200_000_000
"""Bytes of an upload, unless stated."""
_GONE = 3.0  # [s] without its page after which a page's work ends
_STARTS = 60.0  # [s] within which the server listens, also on a loaded machine
_POLL = 0.02  # [s]


def serve(
    opened: Callable[[str], object], *, example: Call, port: int = 0, largest: int = LARGEST
) -> None:
    """Serve the page until Ctrl-C.

    Parameters
    ----------
    opened : callable
        Called with the page's address when it can be opened.
    example : Call
        What "Try an example" identifies.
    port : int
        0 (default): a free one.
    largest : int
        Bytes of an upload. Default 200 MB.

    Raises
    ------
    InputError
        NiceGUI is not installed, or the port is taken.
    """
    try:
        from nicegui import app, ui
    except ModuleNotFoundError as error:
        if (error.name or "").partition(".")[0] != "nicegui":
            raise
        raise InputError(
            "the page needs nicegui, which is not installed", remedy="pip install nicegui"
        ) from None
    from jointid.app.guard import Guard, new_token
    from jointid.app.page import build

    port = _free(port)
    token = new_token()
    address = f"http://127.0.0.1:{port}/?token={token}"

    # The server calls `on_startup` before it listens.
    threading.Thread(target=_when_open, args=(port, lambda: opened(address)), daemon=True).start()

    def root() -> None:
        build(largest, example)

    # The last one that is added is the first one that is asked.
    app.add_middleware(Guard, port=port, token=token, largest=largest + 1_000_000)
    ui.run(
        root,
        host="127.0.0.1",
        port=port,
        title="jointid",
        dark=None,
        language="en-US",
        reconnect_timeout=_GONE,
        gzip_middleware_factory=None,
        reload=False,
        show=False,
        show_welcome_message=False,
    )


def _when_open(port: int, tell: Callable[[], object]) -> None:
    """Tell as soon as the port accepts a connection."""
    end = time.monotonic() + _STARTS
    while time.monotonic() < end:
        try:
            socket.create_connection(("127.0.0.1", port), timeout=1.0).close()
        except OSError:
            time.sleep(_POLL)
        else:
            tell()
            return


def _free(port: int) -> int:
    with closing(socket.socket(socket.AF_INET, socket.SOCK_STREAM)) as tried:
        tried.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        try:
            tried.bind(("127.0.0.1", port))
        except OSError as error:
            raise InputError(
                f"cannot be used: {error.strerror}", argument="port", value=port
            ) from None
        return int(tried.getsockname()[1])
