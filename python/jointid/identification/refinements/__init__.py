"""Refinements of the data before the search: delays between signals, and a minimum speed."""
