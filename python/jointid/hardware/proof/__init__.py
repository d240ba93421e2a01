"""Proof of a bench before its use: check, first motion, certificate."""
