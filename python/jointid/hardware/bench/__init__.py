"""Bench in a file: joint, drive, motion, controller, limits."""
