"""Comparing models by what they predict of motion that they have not seen."""
