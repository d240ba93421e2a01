"""The server program, for this machine only. Its address contains a token."""

from __future__ import annotations

import socket
import threading
import time
from collections.abc import Callable
from contextlib import closing

from jointid.app.call import Call
from jointid.base.errors import InputError

LARGEST = 200_000_000
"""Default largest number of bytes of an upload."""
_GONE = 3.0  # [s] without its page after which its work ends
_STARTS = 60.0  # [s] in which the server must listen, also on a loaded machine
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
        The call that "Try an example" runs.
    port : int
        Port of the server. Default 0: a free one.
    largest : int
        Largest number of bytes of an upload. Default 200 MB.

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

    # The middleware added last handles a request first.
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
    """Call `tell` as soon as the port accepts a connection."""
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
