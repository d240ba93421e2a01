"""Command line: `jointid COMMAND`."""

from jointid.cli.command_line import main

__all__ = ["main"]
