"""Choice of a model when the caller names none: candidates, held-out scores, and the most parsimonious good model."""
