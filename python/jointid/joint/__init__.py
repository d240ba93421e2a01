"""Joints: their known values, models, parameters, and joint files."""
