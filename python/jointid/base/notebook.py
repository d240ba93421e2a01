"""What a notebook shows for a result that has no tables of its own: its report."""


class Shown:
    """A result with a `report()`, which a notebook shows."""

    __slots__ = ()

    def report(self) -> str:
        """Return the result as text."""
        raise NotImplementedError

    def _repr_html_(self) -> str:
        from html import escape

        return f"<pre>{escape(self.report())}</pre>"
