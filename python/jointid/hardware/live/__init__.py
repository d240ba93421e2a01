"""Display of a session while it runs: a line on the console, a window."""
