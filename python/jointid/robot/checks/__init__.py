"""Checks of an identification: sign and size of torques, a second regression, slow motion."""
