"""The timed libraries, one per file."""
