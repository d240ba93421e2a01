"""Checks of data and fit, one file for each; `registry.py` lists them."""
