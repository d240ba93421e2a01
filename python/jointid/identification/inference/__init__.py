"""Uncertainty of the estimated values."""
