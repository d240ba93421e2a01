"""Which given facts are wrong, and what else a misfit tells."""
