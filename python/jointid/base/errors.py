"""The one exception for bad input."""


class InputError(ValueError):
    """Input that cannot be used: one sentence says what is wrong, where, what would be right."""
