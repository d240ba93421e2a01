"""How a joint should move, so that its parameters can be identified best."""
