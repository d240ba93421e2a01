"""Estimates told to people: as text, for notebooks, as a page."""
