"""Recordings: the signals of a joint over time, read from files and kept in SI units."""
