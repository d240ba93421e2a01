"""Diagnosis of wrong facts, and other causes of a large residual."""
