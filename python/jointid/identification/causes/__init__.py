"""Causes of a structured residual, by name: what the model lacks, out of sample and at several scales."""
