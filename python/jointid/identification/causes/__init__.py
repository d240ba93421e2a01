"""Named causes of a structured residual, tested on held-out data and at several time scales."""
