"""Whole arms: the classical way to identify one, TX40's log, and how both ways predict what they have not seen."""
