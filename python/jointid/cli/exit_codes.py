"""Exit codes of the command line."""

DONE = 0
BAD_INPUT = 2
"""The command line, or a file that it names, cannot be used."""
WORSE = 4
"""The verdict is worse than `--require` accepts."""
BUG = 70
"""An error in jointid itself."""
