"""The self-test: known parameters in the user's own motion, identified again."""
