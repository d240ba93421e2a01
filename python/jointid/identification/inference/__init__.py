"""How sure the values are."""
