"""Command `app`."""

from __future__ import annotations

import argparse
from typing import TYPE_CHECKING

from jointid.base.errors import InputError

if TYPE_CHECKING:
    from jointid.cli.parser import CommandParser

_LARGEST_PORT = 65535


def add_app(command: CommandParser) -> None:
    """Add the command's grammar."""
    command.epilog = (
        "Only this machine can open the page. Its address contains a token that changes at each start. The command "
        "needs NiceGUI: pip install nicegui."
    )
    command.add_argument(
        "--port", type=int, default=0, help="port of the page (default: a free one)"
    )
    command.add_argument("--no-browser", action="store_true", help="print the address only")
    command.add_argument(
        "--largest", type=float, default=200.0, help="largest upload in megabytes (default 200)"
    )


def serve_page(arguments: argparse.Namespace) -> None:
    """Serve the page until Ctrl-C."""
    import webbrowser

    from jointid.app.call import Call
    from jointid.app.serving import serve
    from jointid.cli.demonstration import COLUMNS, known_joint, log_file

    if not 0 <= arguments.port <= _LARGEST_PORT:
        raise InputError(
            f"an integer from 0 to {_LARGEST_PORT} is expected",
            argument="port",
            value=arguments.port,
        )
    if not 0.0 < arguments.largest < float("inf"):
        raise InputError(
            "a number of megabytes above 0 is expected", argument="largest", value=arguments.largest
        )

    def opened(address: str) -> None:
        print(
            f"the page of jointid is open to this machine at\n{address}\nCtrl-C ends the command.",
            flush=True,
        )
        if not arguments.no_browser:
            webbrowser.open(address)

    example = Call(
        file=log_file(), name=log_file().name, load={"extra": COLUMNS}, joint=known_joint()
    )
    serve(
        opened,
        example=example,
        port=arguments.port,
        largest=int(1e6 * arguments.largest),
    )
