"""What a session shows while it runs: a line on the console, a window."""
