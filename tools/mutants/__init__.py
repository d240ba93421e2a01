"""Mutants: single changed lines of the program, and whether a test notices each."""
