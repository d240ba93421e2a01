"""Estimates: what was found, and how far it can be believed."""
