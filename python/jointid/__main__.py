"""`python -m jointid` is the command line."""

import sys

from jointid.cli.command_line import main

if __name__ == "__main__":
    sys.exit(main())
