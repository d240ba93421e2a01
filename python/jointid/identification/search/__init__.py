"""Where a search may look, and the searches."""
