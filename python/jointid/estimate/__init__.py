"""Estimates: identified values, their uncertainty, findings, tables and files."""
