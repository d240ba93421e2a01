"""The libraries that are timed, one a file."""
