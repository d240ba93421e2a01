"""Mutants: lines of the program changed on purpose, one at a time, and whether a test notices."""
