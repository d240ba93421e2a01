"""Comparison of models by their prediction of held-out motion."""
