"""The choice of a model that nobody named: candidates, held-out scores, the parsimonious winner."""
