"""Checks of data and fit, each in a file of its own; `registry.py` lists them."""
