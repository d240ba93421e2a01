"""Identification of several joints from one recording, each alone, and couplings between their residuals."""
