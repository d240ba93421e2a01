"""Comparison of models by how well they predict held-out motion."""
