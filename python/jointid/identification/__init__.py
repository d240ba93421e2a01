"""Identification: from recordings and a joint to an estimate."""
