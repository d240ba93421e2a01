"""Self-test: simulate known parameters in the user's motion and identify them again."""
